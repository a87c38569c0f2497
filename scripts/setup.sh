#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Creates .venv and installs this checkout into it, with all prerequisites:
#   scripts/setup.sh                missing system packages, then .venv
#   scripts/setup.sh system [PKG..] system packages only, including PKG
#   scripts/setup.sh extra NAME     requirements of an extra of pyproject.toml, into .venv
#   scripts/setup.sh tests          additional requirements of the tests
# The last two create .venv first where it is missing.
# Shows its progress; all output is in build/setup-*.log.
set -eu
cd "$(dirname "$0")/.."
: "${PYTHON:=python3}"
BUILD=build/install
# Makes pip build as its newer versions do; those of Debian 12 and Python 3.10 warn otherwise.
export PIP_USE_PEP517=1 PIP_DISABLE_PIP_VERSION_CHECK=1

# Prints the missing Debian packages; the names are the same on Ubuntu.
missing_packages() {
  command -v g++ >/dev/null || echo g++
  command -v make >/dev/null || echo make
  command -v python3 >/dev/null || { echo python3 python3-venv python3-dev; return; }
  "$PYTHON" -c 'import ensurepip, venv' 2>/dev/null || echo python3-venv
  "$PYTHON" -c 'import os, sysconfig as s
os.stat(os.path.join(s.get_path("include"), "Python.h"))' 2>/dev/null || echo python3-dev
}

install_packages() {
  [ $# -gt 0 ] || return 0
  if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
    echo "installing Debian packages: $*"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
  else
    echo "Missing on this machine: $*. Install with:" >&2
    echo "  sudo apt-get update && sudo apt-get install -y $*" >&2
    exit 1
  fi
}

check_python() {
  "$PYTHON" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null && return
  found=$("$PYTHON" --version 2>&1) || found="no such program"
  echo "Python 3.10 or newer is needed. $PYTHON: $found." >&2
  echo "Choose another one: PYTHON=/path/to/python3 make" >&2
  exit 1
}

# Prints the requirements in pyproject.toml, one per line. With all of them in .venv, a rebuild
# takes seconds and no network.
# requirements [EXTRA]
requirements() {
  .venv/bin/python - "$@" <<'END'
import sys
try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    from pip._vendor import tomli as tomllib
with open("pyproject.toml", "rb") as file:
    settings = tomllib.load(file)
project = settings["project"]
extras = project["optional-dependencies"]
everything = settings["build-system"]["requires"] + project["dependencies"] + extras["dev"]
print("\n".join(extras[sys.argv[1]] if len(sys.argv) > 1 else everything))
END
}

# progress NAME WHAT COMMAND.. runs a command and shows its progress.
progress() {
  log=build/setup-$1.log
  shift
  mkdir -p build
  .venv/bin/python scripts/progress.py "$log" "$@"
}

install_requirements() {
  requirements "$@" >.venv/requirements.txt
  progress "packages${1:+-$1}" "installing Python packages${1:+ for $1}" \
    .venv/bin/pip install --requirement .venv/requirements.txt
}

install_checkout() {
  if [ ! -x .venv/bin/python ]; then
    echo "creating .venv with $("$PYTHON" --version)"
    rm -rf "$BUILD"  # it may be for another python
    "$PYTHON" -m venv .venv
  fi
  install_requirements
  progress build "compiling" .venv/bin/pip install --verbose --no-deps --no-build-isolation \
    "--config-settings=build-dir=$BUILD" --editable .
  touch .venv/installed
}

install_extra() {
  install_requirements "$1"
  # Open3D's wheel needs system libraries that a machine without a display lacks.
  [ "$1" != ndt ] || .venv/bin/python -c 'import open3d' 2>/dev/null ||
    install_packages libusb-1.0-0 libgl1 libegl1 libgomp1 libx11-6
  touch ".venv/$1"
}

missing_for_tests() {
  command -v spin >/dev/null || echo spin
  command -v tcc >/dev/null || echo tcc
  command -v ip >/dev/null || echo iproute2
  command -v babeltrace2 >/dev/null || echo babeltrace2
  command -v zsh >/dev/null || echo zsh
  command -v fish >/dev/null || echo fish
  command -v chromedriver >/dev/null || echo chromium chromium-driver
  echo '#include <doctest/doctest.h>' | ${CXX:-c++} -E -x c++ - >/dev/null 2>&1 ||
    echo doctest-dev
}

install_for_tests() {
  install_packages $(missing_for_tests)
  install_extra ndt
  install_extra trace
  install_extra record
  install_extra view
  install_extra zenoh
  install_extra advise
  touch .venv/tests
}

set_up() {
  [ "$PYTHON" = python3 ] || check_python
  install_packages $(missing_packages)
  check_python
  install_checkout
}

ensure_venv() {
  [ -x .venv/bin/python ] || set_up
}

if [ "${1:-}" = system ]; then
  shift
  install_packages $(missing_packages) "$@"
elif [ "${1:-}" = extra ]; then
  ensure_venv
  install_extra "$2"
elif [ "${1:-}" = tests ]; then
  ensure_venv
  install_for_tests
else
  set_up
fi
