// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

/// Gives this process and its later children a private, empty /dev/shm if the system permits: tests
/// then see no platforms of other processes, and may damage the user directory.
void enter_private_shm();

/// True if enter_private_shm() succeeded.
bool has_private_shm() noexcept;

/// Waits until its file system has no memory in use: the kernel frees a platform's files shortly
/// after its last process has ended.
void wait_until_private_shm_is_free();
