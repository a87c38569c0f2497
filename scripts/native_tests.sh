#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Builds and runs the native tests: scripts/native_tests.sh BUILD_DIR [CMAKE_OPTION..]
# A build directory that exists keeps its options, and only the tests are compiled.
set -eu
cd "$(dirname "$0")/.."
build=$1
shift
jobs=${JOBS:-$(nproc)}
PATH="$PWD/.venv/bin:$PATH"
mkdir -p build
cmake -S . -B "$build" -G Ninja -DMANYCORE_BUILD_TESTS=ON "$@" >"$build.log" 2>&1 || {
  cat "$build.log"
  exit 1
}
python scripts/progress.py "$build.log" "compiling native tests in $build" \
  cmake --build "$build" -j "$jobs"
# Instruction by instruction, programs with sanitizers would take minutes; and a sanitizer that
# reports a crash on damaged memory may hang on that memory itself.
# Closing a descriptor that another thread uses is a race, which one test is about. The sanitizer of
# undefined behaviour needs a descriptor to look at an object, and takes one for bad without.
case "$*" in
  *SANITIZE=thread*) skipped='^(test_killed|test_damaged_running|test_closed_descriptors)$' ;;
  *SANITIZE*) skipped='^(test_killed|test_damaged_running|test_out_of_reach)$' ;;
  *) skipped='^$' ;;
esac
ctest --test-dir "$build" --output-on-failure --no-tests=error -E "$skipped" -j "$jobs"
