#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Builds and runs the native tests: scripts/native_tests.sh BUILD_DIR [CMAKE_OPTION..]
# They test platform, transport and scan matcher, so they need no ROS.
set -eu
cd "$(dirname "$0")/.."
build=$1
shift
echo '#include <doctest/doctest.h>' | ${CXX:-c++} -E -x c++ - >/dev/null 2>&1 ||
  scripts/setup.sh system doctest-dev
PATH="$PWD/.venv/bin:$PATH"
cmake -S . -B "$build" -G Ninja -DMANYCORE_BUILD_TESTS=ON -DMANYCORE_BUILD_RMW=OFF \
  -DMANYCORE_BUILD_PYTHON=OFF "$@" >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }
cmake --build "$build" -j "${JOBS:-2}"
ctest --test-dir "$build" --output-on-failure --no-tests=error
