// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

/// Gives this process and its later children a private, empty /dev/shm if the system permits: tests
/// then see no platforms of other processes, and may damage the user directory.
void enter_private_shm();

/// True if enter_private_shm() succeeded.
bool has_private_shm() noexcept;
