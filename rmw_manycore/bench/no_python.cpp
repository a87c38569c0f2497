// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// In the wheels of ROS 2 librcl is linked to the Python conversions of its messages. Those refer to
// data of the interpreter, which a program without one has to have for the loader's sake; nothing
// calls them. Linked with its symbols exported.
#define FOR_THE_LOADER extern "C" __attribute__((visibility("default")))

// NOLINTBEGIN(readability-identifier-naming): the interpreter's names
FOR_THE_LOADER void * PyExc_RuntimeError;
FOR_THE_LOADER long _Py_TrueStruct[4];

void * PyExc_RuntimeError = nullptr;
long _Py_TrueStruct[4] = {};
// NOLINTEND(readability-identifier-naming)
