# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor checks: Python, ROS 2, the library, its hook, and whether they work together."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from pathlib import Path

import rmw_manycore_hook
from rmw_manycore_distribution import NAME, RCLPY_VERSION
from rmw_manycore_program import own_program
from rmw_manycore_py.cli.doctor.built import check_built
from rmw_manycore_py.cli.doctor.finding import Finding, Verdict, advised, judged
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.parent_death import dies_with_this_process
from rmw_manycore_py.ros.ament import prefixes
from rmw_manycore_py.ros.domain import ros_domain

MIN_PYTHON = (3, 10)
ROS_PACKAGE = "ros-rclpy"
REINSTALL = "pip install --force-reinstall --no-deps rmw-manycore"
START_TIMEOUT_S = 60
FILES = {
    "library": "lib/librmw_manycore.so",
    "receive thread": "lib/rmw_manycore/manycore_receive_thread",
    "timekeeper": "lib/rmw_manycore/manycore_timekeeper",
    "virtual time": "lib/rmw_manycore/libmanycore_virtual_time.so",
    "scan matching worker": "lib/rmw_manycore/manycore_ndt_worker",
    "stand-ins": "lib/rmw_manycore/standin/librmw_fastrtps_cpp.so",
    "mapfiles": "share/rmw_manycore/mapfiles/whill.yaml",
    "ament index": "share/ament_index/resource_index/rmw_typesupport/rmw_manycore",
}


def check_install() -> Iterator[Finding]:
    """Yield findings about the installation; the last check starts rclpy."""
    yield _python()
    yield check_ros()
    yield from _files()
    yield _hook()
    yield _substitution()
    yield _selected()
    yield check_domain()
    yield from check_built()


def _python() -> Finding:
    version = ".".join(map(str, sys.version_info[:3]))
    expected = ".".join(map(str, MIN_PYTHON))
    advice = f"use python {expected} or later"
    return judged("python", sys.version_info >= MIN_PYTHON, f"{version}, {sys.prefix}", advice)


def check_ros() -> Finding:
    """Return whether ROS 2 is the distribution of this build, and one alone."""
    advice = f'pip install "ros-rclpy[fastrtps]=={RCLPY_VERSION}"'
    try:
        version = importlib.metadata.version(ROS_PACKAGE)
    except importlib.metadata.PackageNotFoundError:
        distribution = os.environ.get("ROS_DISTRO", "none")
        found = f"no wheels; sourced installation: {distribution}"
        advice = f"{advice} ros-{NAME}-common-interfaces"
        return judged("ROS 2", distribution == NAME, found, advice)
    found = f"wheels, {ROS_PACKAGE} {version}"
    if sourced := os.environ.get("ROS_DISTRO"):
        found += f", and a sourced {sourced}: programs load libraries of both"
        beside = "put rmw_manycore beside it without the wheels: docs/how-to/ros2_apt.md"
        return Finding("ROS 2", Verdict.WARNING, found, beside)
    is_own = version.split(".")[:2] == RCLPY_VERSION.split(".")[:2]
    return judged("ROS 2", is_own, found, advice)


def _files() -> Iterator[Finding]:
    for subject, name in FILES.items():
        places = [prefix / name for prefix in prefixes()]
        file = next((place for place in places if place.is_file()), None)
        found = str(file) if file else f"no {' and no '.join(map(str, places))}"
        yield judged(subject, file is not None, found, REINSTALL)
    binding = importlib.util.find_spec("rmw_manycore_py.native._transport")
    found = str(binding.origin) if binding else "no rmw_manycore_py.native._transport"
    yield judged("python binding", binding is not None, found, REINSTALL)


def _hook() -> Finding:
    subject = "start-up hook"
    if not rmw_manycore_hook.needs_stand_ins(sys.prefix):
        return Finding(
            subject, Verdict.OK, "not needed: this ROS 2 loads its middleware by RMW_IMPLEMENTATION"
        )
    file = Path(sysconfig.get_path("purelib"), "rmw_manycore.pth")
    is_there = file.is_file()
    return judged(subject, is_there, str(file) if is_there else f"no {file}", REINSTALL)


def _substitution() -> Finding:
    """Start rclpy with nothing but RMW_IMPLEMENTATION set, as a user does."""
    variables = {**os.environ, "RMW_IMPLEMENTATION": "rmw_manycore"}
    environment = rmw_manycore_hook.plain_environment(variables, sys.prefix)
    try:
        result = subprocess.run(
            own_program("rmw_manycore_py.cli.doctor.probe"),
            env=environment,
            text=True,
            timeout=START_TIMEOUT_S,
            capture_output=True,
            check=False,
            preexec_fn=dies_with_this_process(),
        )
    except subprocess.TimeoutExpired:
        return Finding("substitution", Verdict.FAILURE, f"no answer in {START_TIMEOUT_S} s")
    return judge_probe(result.returncode, result.stdout.split(), result.stderr)


def judge_probe(status: int, words: list[str], errors: str) -> Finding:
    """Judge the output of the probe: the middleware, and which libraries were loaded."""
    subject = "substitution"
    if status != 0 or len(words) != 3:
        lines = errors.strip().splitlines() or [f"exit status {status}"]
        return Finding(subject, Verdict.FAILURE, f"rclpy does not start: {lines[-1]}", REINSTALL)
    identifier, has_ours, has_theirs = words
    if identifier != "rmw_manycore" or has_ours != "True":
        advice = "see docs/design/substitution.md, 'When things go wrong'"
        return Finding(subject, Verdict.FAILURE, f"rclpy uses {identifier}", advice)
    return advised(
        subject,
        has_theirs == "False",
        "rclpy uses rmw_manycore" + (", Fast DDS is loaded too" if has_theirs == "True" else ""),
        "this costs memory only; another version of Fast DDS than expected is installed",
    )


def _selected() -> Finding:
    selected = os.environ.get("RMW_IMPLEMENTATION")
    is_ours = selected == "rmw_manycore"
    found = f"RMW_IMPLEMENTATION is {selected or 'not set'}"
    advice = 'for nodes started by hand from this shell: eval "$(manycore env)"'
    return Finding("this shell", Verdict.OK, found, "" if is_ours else advice)


def check_domain() -> Finding:
    """Return whether ROS_DOMAIN_ID is a domain."""
    try:
        return Finding("ROS domain", Verdict.OK, str(ros_domain()))
    except ManycoreError as error:
        return Finding("ROS domain", Verdict.FAILURE, str(error), "`unset ROS_DOMAIN_ID` for 0")
