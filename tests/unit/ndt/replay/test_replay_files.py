# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Output of a replay: tables, trajectories, plots, and progress."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from rmw_manycore_py.cli.ndt.replay_files import ReplayFiles
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.recordings.pose_file import read_poses
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay.tally import Played, Tally
from rmw_manycore_py.process import progress

pytestmark = pytest.mark.unit

LOST = 2
STAMPS_S = 1_700_000_000.0 + 0.1 * np.arange(5)


def at(index: int, off_m: float = 0.0) -> np.ndarray:
    return from_xyz_rpy((2.0 * index, off_m, 1.0), (0.01, 0.02, 0.3 * index))


@pytest.fixture
def tally() -> Tally:
    """Return five scans, one of which got no pose and one a late pose."""
    tally = Tally(deadline_ms=100.0)
    for index, stamp_s in enumerate(STAMPS_S):
        row = Played(index, float(stamp_s), at(index), at(index, 0.5), 0.0)
        row.reason, row.report = "OK", {"transform_probability": "4.5", "iteration_num": "6"}
        if index == LOST:
            row.reason = "Couldn't interpolate pose"
        else:
            row.result, row.latency_ms = at(index, 0.1), 50.0 * index
            row.covariance = np.arange(36.0).reshape(6, 6) + np.arange(36.0).reshape(6, 6).T
        tally.rows.append(row)
    return tally


def write(tally: Tally, **paths: Path) -> None:
    names = ("csv", "tum", "kitti", "plot", "picture")
    files = {f"{name}_path": paths.get(name) for name in names}
    drive = Recording(
        [np.ones((50, 3), np.float32)] * 5, np.array([at(i) for i in range(5)]), STAMPS_S
    )
    ReplayFiles(**files).write(tally, drive, np.random.default_rng(1).uniform(-9, 9, (500, 3)))


def test_the_table_has_a_line_per_scan_with_all_that_is_known(tally, tmp_path):
    write(tally, csv=tmp_path / "scans.csv")
    with (tmp_path / "scans.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["state"] for row in rows] == ["answered", "answered", "lost", "late", "late"]
    assert float(rows[1]["stamp_s"]) == STAMPS_S[1]
    assert [float(rows[1][axis]) for axis in "xyz"] == pytest.approx([2.0, 0.1, 1.0])
    assert float(rows[1]["error_m"]) == pytest.approx(0.1)
    assert float(rows[1]["cov_x_yaw"]) == 5.0 + 30.0
    assert (rows[1]["reason"], rows[LOST]["reason"]) == ("", "Couldn't interpolate pose")
    assert (rows[LOST]["x"], rows[LOST]["latency_ms"], rows[LOST]["cov_x_x"]) == ("", "", "")
    assert (rows[1]["transform_probability"], rows[1]["iteration_num"]) == ("4.5", "6")


def test_trajectories_are_read_back(tally, tmp_path):
    write(tally, tum=tmp_path / "poses.tum", kitti=tmp_path / "poses.txt")
    found = read_poses(tmp_path / "poses.tum")
    kept = [index for index in range(5) if index != LOST]
    np.testing.assert_allclose(found.stamps, STAMPS_S[kept], atol=1e-6)
    np.testing.assert_allclose(found.poses, [at(index, 0.1) for index in kept], atol=1e-6)
    reference = read_poses(tmp_path / "poses-reference.tum")
    np.testing.assert_allclose(reference.poses, [at(index) for index in range(5)], atol=1e-6)

    lines = np.loadtxt(tmp_path / "poses.txt")
    assert lines.shape == (5, 12)
    assert np.isnan(lines[LOST]).all()
    np.testing.assert_allclose(lines[1].reshape(3, 4), at(1, 0.1)[:3], atol=1e-6)
    reference = read_poses(tmp_path / "poses-reference.txt")
    np.testing.assert_allclose(reference.poses, [at(index) for index in range(5)], atol=1e-6)


def test_trajectories_keep_millimetres_in_utm(tally, tmp_path):
    utm_m = np.array([691_234.567, 5_334_567.891, 512.345])
    for row in tally.rows:
        row.reference[:3, 3] += utm_m
    write(tally, tum=tmp_path / "poses.tum", kitti=tmp_path / "poses.txt")
    for name in ("poses-reference.tum", "poses-reference.txt"):
        found = read_poses(tmp_path / name).poses[:, :3, 3]
        expected = [row.reference[:3, 3] for row in tally.rows]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-5)


def test_pictures_are_drawn_with_gaps_and_without_answers(tally, tmp_path):
    write(tally, plot=tmp_path / "plot.svg", picture=tmp_path / "picture.svg")
    drawn = (tmp_path / "plot.svg").read_text()
    for title in ("map and path", "error", "scores", "latency", "no pose"):
        assert f"<!-- {title} -->" in drawn
    assert "<!-- scans, where found -->" in (tmp_path / "picture.svg").read_text()
    for row in tally.rows:
        row.result = None
    write(tally, plot=tmp_path / "none.svg", picture=tmp_path / "none3.svg")


def number_pairs(text: str) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in re.findall(r"(-?[\d.]+)[ ,](-?[\d.]+)", text)]


@pytest.mark.parametrize("way", [(8.0, 0.2), (0.2, 8.0)], ids=["flat", "tall"])
def test_the_legend_of_the_map_is_above_it(tally, tmp_path, way):
    for index, row in enumerate(tally.rows):
        row.reference[:2, 3] = np.array(way) * index
    write(tally, plot=tmp_path / "plot.svg")
    drawn = (tmp_path / "plot.svg").read_text()
    corners = number_pairs(re.search(r'id="patch_2">\s*<path d="([^"]*)"', drawn).group(1))
    (left, bottom), (right, top) = corners[0], corners[2]
    place = re.search(r"<!-- ndt_pose -->\s*<g [^>]*translate\(([^)]*)\)", drawn).group(1)
    ((x, y),) = number_pairs(place)
    assert bottom > top  # as an SVG counts
    assert top - 20.0 < y < top
    assert left - 50.0 < x < right + 50.0


def test_progress_is_in_lines_where_there_is_no_terminal(monkeypatch, capsys):
    monkeypatch.setattr(progress, "LINE_PERIOD_S", 0.0)
    assert list(progress.tracked(iter("abc"), "letters", 3)) == ["a", "b", "c"]
    assert capsys.readouterr().err.splitlines() == [f"letters {n} of 3" for n in (1, 2, 3)]
    lines = progress.ProgressLines("scan", 9, Console(stderr=True))
    lines.done(4, "2 lost")
    assert capsys.readouterr().err == "scan 4 of 9: 2 lost\n"


def test_no_progress_of_short_work(capsys):
    assert len(list(progress.tracked(range(100), "letters", 100))) == 100
    assert capsys.readouterr().err == ""
