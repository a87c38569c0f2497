#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Compiles and runs the native tests: scripts/native_tests.sh BUILD_DIR [CMAKE_OPTION..]
# An existing build directory keeps its options, and only the tests are compiled. With COMPILE_ONLY
# set, none runs. NATIVE_TRIES=2 runs one that fails once more.
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
[ -z "${COMPILE_ONLY:-}" ] || exit 0
# Tests skipped under sanitizers:
# - test_killed, test_killed_crowd, test_looks and test_pinned_generations step through
#   instructions, which takes minutes.
# - test_periods counts for a minute what other tests count a few times.
# - test_damaged_running crashes on damaged memory, on which a sanitizer's report may hang.
# - test_closed_descriptors closes descriptors in use by other threads, which is a data race.
# - test_process_threads waits until all threads of a process sleep; the thread sanitizer has one of
#   its own in each process, which never does for long.
# - test_damage reads damaged files by one thread, which the address sanitizer looks at.
always='test_killed.*|test_damaged_running|test_looks|test_periods|test_pinned_generations'
case "$*" in
  *SANITIZE=thread*)
    skipped="^($always|test_closed_descriptors|test_damage|test_process_threads)$"
    ;;
  *SANITIZE*) skipped="^($always)$" ;;
  *) skipped='^$' ;;
esac
# One more than CPUs: those that step through processes wait for each step.
ctest --test-dir "$build" --output-on-failure --no-tests=error -E "$skipped" -j $((jobs + 1)) \
  --repeat "until-pass:${NATIVE_TRIES:-1}"
