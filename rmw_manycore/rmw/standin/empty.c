// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Empty on purpose: a stand-in only has to bear the name of the library it replaces.
typedef int manycore_standin_is_empty;
