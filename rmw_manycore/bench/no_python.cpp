// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// librcl in the ROS 2 wheels is linked to the Python conversions of its messages. These refer to
// data of the interpreter, which the loader must resolve in a program without Python; nothing uses
// them. Linked with exported symbols.
#define FOR_THE_LOADER extern "C" __attribute__((visibility("default")))

// NOLINTBEGIN(readability-identifier-naming): the interpreter's names
FOR_THE_LOADER void * PyExc_RuntimeError;
FOR_THE_LOADER long _Py_TrueStruct[4];

void * PyExc_RuntimeError = nullptr;
long _Py_TrueStruct[4] = {};
// NOLINTEND(readability-identifier-naming)
