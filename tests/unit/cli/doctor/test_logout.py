# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The doctor's check of what a logout does to shared memory."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.cli.doctor.finding import Verdict
from rmw_manycore_py.cli.doctor.logout import check_logout

pytestmark = pytest.mark.unit
PERSON = 64_000  # a uid without an entry in the user database


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "run/systemd/system").mkdir(parents=True)
    (tmp_path / "etc/systemd/logind.conf.d").mkdir(parents=True)
    return tmp_path


def configure(root: Path, text: str, name: str = "logind.conf") -> None:
    (root / "etc/systemd" / name).write_text(text)


def test_without_systemd_nothing_is_removed(tmp_path):
    assert check_logout(tmp_path, PERSON).verdict is Verdict.OK


def test_the_default_removes(root):
    finding = check_logout(root, PERSON)
    assert finding.verdict is Verdict.WARNING
    assert "enable-linger" in finding.advice


def test_system_users_are_spared(root):
    assert check_logout(root, 0).verdict is Verdict.OK


def test_a_lingering_user_gets_no_warning(root):
    (root / "var/lib/systemd/linger").mkdir(parents=True)
    (root / "var/lib/systemd/linger" / str(PERSON)).touch()
    assert check_logout(root, PERSON).verdict is Verdict.OK


@pytest.mark.parametrize(("value", "verdict"), [("no", Verdict.OK), ("yes", Verdict.WARNING)])
def test_what_is_configured_last_holds(root, value, verdict):
    configure(root, "[Login]\nRemoveIPC=yes\nHandleLidSwitch=ignore\n")
    configure(root, "[Login]\nRemoveIPC=no\n", "logind.conf.d/10-first.conf")
    configure(root, f"[Login]\nRemoveIPC={value}\n", "logind.conf.d/20-last.conf")
    assert check_logout(root, PERSON).verdict is verdict
