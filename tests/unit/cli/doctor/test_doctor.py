# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Verdicts of the doctor; its checks are tested on the real installation."""

import pytest

from rmw_manycore_py.cli.doctor.finding import Verdict, advised, judged
from rmw_manycore_py.cli.doctor.install import check_domain, check_ros, judge_probe

pytestmark = pytest.mark.unit


def test_advice_is_given_only_where_it_is_needed() -> None:
    assert judged("x", True, "found", "do this").advice == ""
    assert judged("x", False, "found", "do this").verdict is Verdict.FAILURE
    assert advised("x", False, "found", "do this").verdict is Verdict.WARNING
    assert advised("x", False, "found", "do this").advice == "do this"


@pytest.mark.parametrize(
    ("status", "words", "errors", "verdict", "found"),
    [
        (0, ["rmw_manycore", "True", "False"], "", Verdict.OK, "rclpy uses rmw_manycore"),
        (0, ["rmw_manycore", "True", "True"], "", Verdict.WARNING, "Fast DDS is loaded too"),
        (0, ["rmw_fastrtps_cpp", "False", "True"], "", Verdict.FAILURE, "rmw_fastrtps_cpp"),
        (1, [], "Traceback\nImportError: no rclpy", Verdict.FAILURE, "ImportError: no rclpy"),
        (-11, [], "", Verdict.FAILURE, "exit status -11"),
    ],
)
def test_the_probe(
    status: int, words: list[str], errors: str, verdict: Verdict, found: str
) -> None:
    finding = judge_probe(status, words, errors)
    assert finding.verdict is verdict
    assert found in finding.found


def test_two_installations_of_ros_are_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    assert check_ros().verdict is Verdict.OK
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    finding = check_ros()
    assert (finding.verdict, "sourced jazzy" in finding.found) == (Verdict.WARNING, True)


def test_a_domain_that_is_no_number_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert (check_domain().verdict, check_domain().found) == (Verdict.OK, "7")
    monkeypatch.setenv("ROS_DOMAIN_ID", "abc")
    finding = check_domain()
    assert (finding.verdict, "found 'abc'" in finding.found) == (Verdict.FAILURE, True)
