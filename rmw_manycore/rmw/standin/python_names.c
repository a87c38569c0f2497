// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The data of Python that libraries of messages in the wheels refer to. C++ programs load these
// libraries too (lib<package>__rosidl_generator_py.so) and never use the data, but without a
// definition the loader refuses to start them: "undefined symbol: PyExc_RuntimeError". In Python,
// and in programs linked to libpython, Python's own definitions come first in the search order.
const void * const PyExc_RuntimeError = 0;
const void * const _Py_TrueStruct = 0;
