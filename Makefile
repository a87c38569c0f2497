# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Each target first sets up what it needs in .venv; see `make help`.

VENV := .venv/bin
INSTALLED := build/install
JOBS ?= $(shell nproc)
# Tests in parallel: most wait most of the time, but each needs memory and a few ROS domains.
TEST_JOBS ?= $(shell n=$$((3 * $$(nproc))); echo $$((n < 8 ? n : 8)))
# Long tests work most of the time, and some drive in real time: with three at once some are late.
LONG_TEST_JOBS ?= $(shell nproc)
# These tests cover platform, transport and scan matcher, so they need no ROS.
TESTS_ALONE := -DMANYCORE_BUILD_RMW=OFF -DMANYCORE_BUILD_PYTHON=OFF -DMANYCORE_BUILD_FUZZ=OFF
NATIVE_SOURCES := $(shell find CMakeLists.txt cmake startup rmw_manycore \
	-type f -not -name '*.md')

.PHONY: help setup demo demo-whill wheel test test-native test-long stress soak soak-holds sanitize fuzz \
	bench lint tidy docs pictures clean

help:  ## print this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

.venv/installed: pyproject.toml scripts/setup.sh $(NATIVE_SOURCES)
	scripts/setup.sh

.venv/tests: .venv/installed
	scripts/setup.sh tests

setup: .venv/installed  ## build, and install this checkout into .venv

demo: setup  ## run talker and listener in two clusters for ten seconds
	$(VENV)/manycore demo

.venv/bench: .venv/installed
	scripts/setup.sh extra bench

demo-whill: setup .venv/bench  ## drive the wheelchair of ROS-lite2 40 m, localization and control off-loaded
	$(VENV)/manycore whill course build/demo-whill --length 40 --turn-radius 6
	$(VENV)/manycore whill drive --course build/demo-whill --run --plot build/demo-whill/drive.png

test: test-native  ## all tests except the long ones
	$(VENV)/pytest -n $(TEST_JOBS)

test-long: setup .venv/tests  ## what takes ten seconds and more: drives, benches, tutorials, wheel
	$(VENV)/pytest -n $(LONG_TEST_JOBS) -m "long and not stress"

stress: test-long  ## what takes longer still: random kills, many nodes
	$(VENV)/pytest -m stress

HOURS ?= 1
soak: setup .venv/tests  ## HOURS=1 of churn, growth and kills: resource use must stay flat
	$(VENV)/python tests/soak/soak.py --hours $(HOURS) --output build/soak

TAKES ?= 1000000
soak-holds: setup .venv/tests  ## TAKES=1000000 of held messages, kills, forks: no foreign byte
	$(VENV)/python tests/soak/holds.py --takes $(TAKES) --output build/soak-holds

test-native: setup .venv/tests  ## the C++ tests
	scripts/native_tests.sh $(INSTALLED)

sanitize: setup .venv/tests  ## the C++ tests with sanitizers: address and undefined, then threads
	scripts/native_tests.sh build/asan -DMANYCORE_SANITIZE=address,undefined $(TESTS_ALONE)
	scripts/native_tests.sh build/tsan -DMANYCORE_SANITIZE=thread $(TESTS_ALONE)

fuzz: setup  ## a million mutated messages, with the address sanitizer, compared with Fast DDS
	scripts/fuzz.sh 1000000

wheel: setup  ## a wheel in dist/, tested in an environment without a compiler
	$(VENV)/python scripts/build_wheel.py

bench: setup  ## short benches of messages, start-up, idle nodes, memory; tables, CSV in build/bench
	$(VENV)/manycore bench all --quick --output build/bench

lint: setup .venv/tests  ## style, types, spelling
	$(VENV)/ruff check
	$(VENV)/ruff format --check
	$(VENV)/mypy
	$(VENV)/mypy examples/*.py
	git ls-files '*.cpp' '*.hpp' | xargs $(VENV)/clang-format --dry-run --Werror
	! git grep -nE '^.{101,}' '*.cmake' '*CMakeLists.txt' '*.sh' .ci/run
	$(VENV)/codespell

# Without the tests, which two compilers check: parsing them would nearly double its time.
tidy: setup  ## clang-tidy with the checks of .clang-tidy
	$(VENV)/cmake -S . -B build/tidy -G Ninja -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(VENV)/ninja \
	  -DCMAKE_PREFIX_PATH=$(CURDIR)/.venv -DMANYCORE_BUILD_BENCH=ON \
	  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
	  -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >build/tidy.log 2>&1
	git ls-files 'rmw_manycore/*.cpp' ':!*/bench/ndt/peer.cpp' | \
	  xargs -P $(JOBS) -n 3 $(VENV)/clang-tidy -p build/tidy --quiet 2>build/tidy.log

docs: setup  ## documentation as HTML in build/docs, with links checked
	NO_MKDOCS_2_WARNING=1 $(VENV)/mkdocs build --quiet --strict --site-dir build/docs

pictures: setup .venv/tests  ## pictures of README and docs, each from a run of an example
	mkdir -p build docs/pictures
	PATH="$(CURDIR)/$(VENV):$$PATH" $(VENV)/python scripts/record_terminal.py docs/pictures/demo.svg \
	  manycore demo --duration 5
	$(VENV)/python scripts/plot_round_trips.py docs/pictures/round_trips.svg
	PATH="$(CURDIR)/$(VENV):$$PATH" scripts/picture.sh docs/pictures/chip.svg docs/pictures/page.png
	PATH="$(CURDIR)/$(VENV):$$PATH" scripts/scan_picture.sh docs/pictures/scan.png
	PATH="$(CURDIR)/$(VENV):$$PATH" scripts/traces_picture.sh docs/pictures/traces.png
	$(VENV)/manycore run image_pipeline --duration 10 --trace build/pictures.json >/dev/null
	$(VENV)/manycore trace draw build/pictures.json -o docs/pictures/trace_message.png
	$(VENV)/manycore trace latency build/pictures.json --plot docs/pictures/trace_chains.png

clean:  ## remove everything that was built
	rm -rf build .venv
