// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Intentionally empty: a stand-in only provides the name of the library it replaces.
typedef int manycore_standin_is_empty;
