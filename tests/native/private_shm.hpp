// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

/// Gives this process and its later children an empty /dev/shm of their own, where the system
/// allows it: tests then meet nobody else's platforms, and may damage the user directory.
void enter_private_shm();

/// True when enter_private_shm() could do so.
bool has_private_shm() noexcept;
