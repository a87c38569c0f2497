#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Builds the fuzzer with the address sanitizer and runs it: scripts/fuzz.sh SAMPLES [SEED [FIRST]]
# Fuzzes the messages of the ROS 2 in .venv. An existing build directory keeps its compiler.
set -eu
cd "$(dirname "$0")/.."
build=build/asan
PATH="$PWD/.venv/bin:$PATH"
mkdir -p build
cmake -S . -B "$build" -G Ninja -DCMAKE_PREFIX_PATH="$PWD/.venv" \
  -DMANYCORE_SANITIZE=address,undefined -DMANYCORE_BUILD_RMW=ON -DMANYCORE_BUILD_FUZZ=ON \
  >"$build.log" 2>&1 || {
  cat "$build.log"
  exit 1
}
python scripts/progress.py "$build.log" "compiling the fuzzer in $build" \
  cmake --build "$build" --target fuzz_deserialize
# Fast DDS needs the libraries that came with the wheels as well.
libraries=$(printf '%s:' "$PWD/$build/lib" "$PWD/.venv/lib" "$PWD"/.venv/lib/python*/*/*.libs)
LD_LIBRARY_PATH=$libraries MANYCORE_PLATFORM="fuzz-$$" \
  "$build/lib/rmw_manycore/tests/fuzz_deserialize" "$@"
