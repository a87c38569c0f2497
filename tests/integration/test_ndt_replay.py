# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Drives played from Fast DDS through the bridge to a matcher or a whole stack on the platform.

Latency is not tested here: the deadline allows for a busy machine, and each scan waits for the
result of the last one. Only the loop that the whole stack closes runs at a rate of its own: of
scans that arrive faster than the machine matches them, the older ones are skipped.
"""

from __future__ import annotations

import csv
import json
import os
import signal
import sys
import time
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from rmw_manycore_py.native import _transport
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.files import load
from rmw_manycore_py.trace.latency import latencies
from support import IS_MANYCORE, MAPFILES, REPOSITORY, TIMEOUT_S, wait_until
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command
from support.processes.program import Program
from support.sources.advice import quoted

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

DATA = Path(os.environ.get("MANYCORE_DATA", REPOSITORY.parent / "shared" / "data"))
BALM = DATA / "balm_seq177_v0.10.npz"
needs_data = pytest.mark.skipif(not BALM.exists(), reason=f"no {BALM}; set MANYCORE_DATA")
LONG_S = 10 * TIMEOUT_S
POSE_TYPE = "geometry_msgs/msg/PoseStamped"
DEADLINE_MS = str(1e3 * TIMEOUT_S)
PATIENTLY = ("--timeout", str(2 * TIMEOUT_S))  # while matcher and bridge start


@pytest.fixture
def offload(start, platform) -> Program:
    """Return the matcher on the platform, running."""
    program = start(forked_manycore("run", MAPFILES / "ndt_offload.yaml"))
    program.wait_for("ndt_scan_matcher started")
    return program


def replayed(start: Any, recording: Path, *options: str, status: int = 0) -> dict[str, Any]:
    """Return the figures of a replay as a dict.

    The status of a closed loop tells how quick the machine is: 1 if a scan was skipped.
    """
    is_closed_loop = not {"stack", "lost"}.isdisjoint(options)
    pace = () if is_closed_loop else ("--wait",)
    options = ("--deadline", DEADLINE_MS, "--json", *PATIENTLY, *pace, *options)
    replay = start(forked_manycore("ndt", "replay", recording, *options))
    assert replay.wait(LONG_S) in ({0, 1} if is_closed_loop else {status}), replay
    figures: dict[str, Any] = json.loads(replay.output[replay.output.index("{") :])
    return figures


def test_every_scan_of_a_drive_is_answered(start, platform, street, tmp_path):
    alone = start(forked_manycore("ndt", "replay", street / "drive.npz", "--timeout", "1"))
    assert alone.wait(LONG_S) == 1
    assert "points_raw has no subscription: start a scan matcher" in alone.output
    assert quoted(alone.output) == ["manycore run ndt_offload"]
    offload = start(manycore_command("run", "ndt_offload"), directory=tmp_path)
    offload.wait_for("ndt_scan_matcher started")
    figures = replayed(start, street / "drive.npz", "--csv", str(tmp_path / "scans.csv"))
    assert (figures["scans"], figures["answered"]) == (10, 10)
    assert figures["within_share"] == 1.0
    assert figures["node_cpu_percent"] >= 0.0
    assert len((tmp_path / "scans.csv").read_text().splitlines()) == 11
    assert "Traceback" not in offload.output
    assert offload.stop() == 0, offload


def test_a_trace_shows_bridge_alignments_and_workers_in_a_chain(start, platform, street, tmp_path):
    path = tmp_path / "trace.json"
    run = start(forked_manycore("run", MAPFILES / "ndt_offload.yaml", "--trace", path))
    run.wait_for("ndt_scan_matcher started")
    assert replayed(start, street / "drive.npz")["answered"] == 10
    assert run.stop() == 0, run
    trace = load(path)
    messages = Messages(trace)
    (pose,) = latencies(messages, [("/points_raw", "/ndt_pose")])
    expected = [
        "bridge in",
        "communication",
        "node",
        "NDT alignment",
        "communication",
        "bridge out",
    ]
    if len(os.sched_getaffinity(0)) > 1:
        expected.insert(4, "NDT workers")
    names = [part.name.rsplit(" ", 1)[0] for part in pose.parts[:-3]]
    assert names == expected
    (count,) = {len(part.samples_us) for part in pose.parts[:-3]}
    assert count >= 10  # the first scan is repeated until the matcher is discovered
    aligned = next(part for part in pose.parts if part.name.startswith("NDT alignment"))
    node = next(part for part in pose.parts if part.name.startswith("node"))
    assert all(0 < a < n for a, n in zip(aligned.samples_us, node.samples_us, strict=True))


def test_who_waits_loses_no_scan(start, offload, street):
    """Though they would come a thousand times a second."""
    figures = replayed(start, street / "drive.npz", "--rate", "1000", "--voxel", "0")
    assert figures["answered"] == 10


def test_figures_are_there_though_a_file_cannot_be_written(start, offload, street):
    files = ("--csv", "/dev/full", "--motion", "reference", "--wait", "--deadline", DEADLINE_MS)
    replay = start(forked_manycore("ndt", "replay", street / "drive.npz", *PATIENTLY, *files))
    assert replay.wait(LONG_S) == 1, replay
    assert "10 scans: 10 answered" in replay.output
    assert replay.lines[-1] == "manycore: /dev/full: cannot be written: No space left on device"


@pytest.mark.parametrize("guess", ["velocity", "perturbed"])
def test_guesses_of_all_kinds(start, offload, street, guess):
    figures = replayed(start, street / "drive.npz", "--guess", guess)
    assert figures["within_share"] == 1.0
    if guess == "perturbed":
        assert figures["guess_error_m_max"] == pytest.approx(0.5)
        assert figures["guess_error_deg_max"] == pytest.approx(3.0)


@pytest.mark.parametrize("suffix", [".pcd", ".npz"])
def test_a_drive_in_utm_coordinates(start, offload, street, tmp_path, suffix):
    """Five million metres from the origin it finds the same poses as at the origin."""
    from rmw_manycore_py.ndt.maps.map_file import read_points, write_points
    from rmw_manycore_py.ndt.recordings.recording import Recording, load_recording, save_recording

    utm_m = np.array([500_000.0, 5_000_000.0, 100.0])
    drive = load_recording(street / "drive.npz")
    poses = drive.poses.copy()
    poses[:, :3, 3] += utm_m
    save_recording(tmp_path / "drive.npz", Recording(drive.scans, poses, drive.stamps))
    write_points(tmp_path / f"map{suffix}", read_points(street / "map.npz") + utm_m)
    files = ("--map", str(tmp_path / f"map{suffix}"))
    figures = replayed(start, tmp_path / "drive.npz", *files)
    assert (figures["answered"], figures["within_share"]) == (10, 1.0)
    assert figures["error_m_median"] < 0.05


def test_a_plot(start, offload, street, tmp_path):
    replayed(start, street / "drive.npz", "--plot", str(tmp_path / "replay.png"))
    assert (tmp_path / "replay.png").read_bytes().startswith(b"\x89PNG")


def check_closed_loop(rows: Path, figures: dict[str, Any]) -> None:
    """Check that each pose is right, and that scans without one are refused for a reason.

    The loop runs at a rate of its own: on a machine that stands still for a moment, scans are
    skipped for a newer one, or the newest guess is too old for them. Where it misleads the matcher,
    that lets no pose out.
    """
    assert figures["diverged"] == 0
    with rows.open() as file:
        scans = list(csv.DictReader(file))
    lost = [row["reason"] for row in scans if row["state"] == "lost"]
    misled = [reason for reason in lost if reason.startswith("the pose is implausible")]
    assert len(misled) <= 0.02 * len(scans), misled
    late = ("skipped", "Couldn't interpolate pose")
    for reason in set(lost) - set(misled):
        # The matcher may warn of the scan's age before it says what it is refused for.
        assert any(remark.startswith(late) for remark in reason.split("; ")), lost
    assert figures["answered"] > 0
    assert figures["within_share"] * figures["scans"] >= 0.99 * figures["answered"]


@pytest.mark.long
def test_a_whole_stack_on_the_platform(start, platform, street, tmp_path):
    """Voxel filter, pose initializer, matcher and EKF form a closed loop, without a first pose."""
    stack = start(forked_manycore("run", MAPFILES / "ndt_stack.yaml"))
    rows = tmp_path / "scans.csv"
    drive, files = street / "drive.npz", ("--csv", str(rows))
    figures = replayed(start, drive, "--guess", "lost", "--rate", "4", *files)
    check_closed_loop(rows, figures)
    assert "Traceback" not in stack.output
    assert stack.stop() == 0, stack


def test_motion_of_the_reference(start, offload, street):
    figures = replayed(start, street / "drive.npz", "--motion", "reference")
    assert figures["within_share"] == 1.0
    assert "REFERENCE's motion with 5% error" in figures["guesses"]


@pytest.mark.stress
def test_a_drive_with_motion_distortion_at_twice_its_rate(start, platform, tmp_path):
    """The LiDAR turns faster, as the vehicle drives faster: deskewing still fits.

    Also for the first scan, which the vehicle reaches at full speed.
    """
    options = ("--length", "32", "--beams", "16", "--azimuths", "360", "--distortion")
    made = start(forked_manycore("ndt", "simulate", tmp_path, *options))
    assert made.wait(LONG_S) == 0, made
    mapfile = yaml.safe_load((MAPFILES / "ndt_offload.yaml").read_text())
    parameters = {"activated": True, "sensor_points.deskew": True}
    mapfile["nodes"]["ndt_scan_matcher"]["parameters"] = parameters
    (tmp_path / "map.yaml").write_text(yaml.safe_dump(mapfile))
    run = start(forked_manycore("run", tmp_path / "map.yaml"))
    run.wait_for("ndt_scan_matcher started")
    more = ("--rate", "20", "--motion", "reference", "--voxel", "0")
    figures = replayed(start, tmp_path / "drive.npz", *more)
    assert figures["answered"] == figures["scans"]
    assert figures["error_m_median"] < 0.05
    assert figures["error_m_max"] < 0.1


@pytest.mark.long
def test_no_scan_is_lost_while_maps_are_swapped(start, platform, tmp_path):
    """The matcher reads the map tiles around the vehicle while it drives."""
    drive, tiles = tmp_path / "drive.npz", tmp_path / "tiles"
    for arguments in (
        ("simulate", tmp_path, "--length", "30"),
        ("map", drive, "-o", tiles, "--tile-size", "5", "--format", "npz"),
    ):
        made = start(forked_manycore("ndt", *arguments))
        assert made.wait(LONG_S) == 0, made
    mapfile = yaml.safe_load((MAPFILES / "ndt_offload.yaml").read_text())
    mapfile["nodes"]["ndt_scan_matcher"]["parameters"] = {
        "activated": True,
        "map_path": str(tiles),
        "dynamic_map_loading.map_radius": 50.0,
        "dynamic_map_loading.lidar_radius": 40.0,
        "dynamic_map_loading.update_distance": 5.0,
    }
    (tmp_path / "tiles.yaml").write_text(yaml.safe_dump(mapfile))
    matcher = start(forked_manycore("run", tmp_path / "tiles.yaml"))
    figures = replayed(start, drive, "--no-map", "--rate", "2")
    assert figures["answered"] == figures["scans"] == 37
    assert figures["within_share"] == 1.0
    assert matcher.stop() == 0, matcher
    assert matcher.output.count("matching to a map of") >= 2  # some may be read as one


def echo_of_poses(start: Any, platform: str) -> Program:
    """Return an echo of the poses, listed as a subscription: else it might miss a whole drive."""
    echo = start(forked_manycore("topic", "echo", "/ndt_pose", POSE_TYPE, "--csv"))

    def is_listed() -> bool:
        with _transport.Platform(platform) as opened:
            ends = opened.endpoints()
        return any((end.topic, end.kind) == ("/ndt_pose", "subscription") for end in ends)

    wait_until(is_listed, "the echo is a subscription")
    return echo


@pytest.mark.stress
def test_an_inward_bridge_that_stops_for_a_while(start, platform, tmp_path):
    """At 15 m/s beside other load, poses are right or missing, and the loop recovers.

    Scans and guesses of 0.7 s reach the matcher at once. The time to recover is not tested.
    """
    size = ("--length", "225", "--beams", "16", "--azimuths", "360")
    made = start(forked_manycore("ndt", "simulate", tmp_path, *size, "--speed", "15"))
    assert made.wait(LONG_S) == 0, made
    run = start(forked_manycore("run", MAPFILES / "ndt_offload.yaml", "--json"))
    inward = json.loads(run.wait_for(r'"started".*\(bridge inward\)').string)["pid"]
    run.wait_for('"started".*"ndt_scan_matcher"')
    poses = echo_of_poses(start, platform)
    burners = [start([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    rows = tmp_path / "scans.csv"
    options = ("--csv", rows, "--motion", "reference", *PATIENTLY)
    replay = start(forked_manycore("ndt", "replay", tmp_path / "drive.npz", *options))
    for _ in range(10):
        poses.wait_for("^[0-9]")
    os.kill(inward, signal.SIGSTOP)
    time.sleep(0.7)  # this is the disturbance, not a synchronisation
    os.kill(inward, signal.SIGCONT)
    continued_ns = time.time_ns()
    stamp_ns = 0
    while stamp_ns < continued_ns:  # until a later scan is answered
        seconds, nanoseconds = poses.wait_for("^([0-9]+),([0-9]+),").groups()
        stamp_ns = int(seconds) * 10**9 + int(nanoseconds)
    for burner in burners:
        burner.kill()
    replay.wait(LONG_S)
    with rows.open() as file:
        errors_m = [row["error_m"] for row in csv.DictReader(file)]
    assert len(errors_m) == 150
    assert all(float(error) < 0.5 for error in errors_m if error), errors_m


@pytest.mark.long
def test_a_killed_matcher_is_started_again_and_finds_itself(start, platform, tmp_path):
    """By the mapfile, without a first pose; of the scans after its first pose it refuses few.

    Beside load the new process takes as long as it is kept from the CPUs: scans that the machine
    makes it skip do not count.
    """
    size = ("--length", "120", "--beams", "16", "--azimuths", "360")
    made = start(forked_manycore("ndt", "simulate", tmp_path, *size))
    assert made.wait(LONG_S) == 0, made
    mapfile = yaml.safe_load((MAPFILES / "ndt_respawn.yaml").read_text())
    mapfile["nodes"]["ndt_scan_matcher"]["parameters"]["last_pose_path"] = str(tmp_path / "pose")
    (tmp_path / "respawn.yaml").write_text(yaml.safe_dump(mapfile))
    run = start(forked_manycore("run", tmp_path / "respawn.yaml", "--json"))
    matcher = json.loads(run.wait_for('"started".*"ndt_scan_matcher"').string)["pid"]
    poses = echo_of_poses(start, platform)
    rows = tmp_path / "scans.csv"
    pace = ("--rate", "10", "--voxel", "0", "--deadline", "2000")
    options = ("--csv", rows, "--motion", "reference", *PATIENTLY, *pace)
    replay = start(forked_manycore("ndt", "replay", tmp_path / "drive.npz", *options))
    for _ in range(20):
        poses.wait_for("^[0-9]")
    os.kill(matcher, signal.SIGKILL)
    run.wait_for('"started".*"ndt_scan_matcher"')
    run.wait_for("matching to a map of")
    replay.wait(LONG_S)
    with rows.open() as file:
        scans = list(csv.DictReader(file))
    errors_m = [float(row["error_m"]) for row in scans if row["error_m"]]
    assert all(error_m < 0.5 for error_m in errors_m), errors_m
    assert any(row["error_m"] for row in scans[-5:]), scans[-5:]
    assert len(refused_by_a_new_matcher(scans)) <= MAX_REFUSED


MAX_REFUSED = 10  # after a kill, at 10 Hz


def refused_by_a_new_matcher(scans: list[dict[str, str]]) -> list[str]:
    """Return why scans got no pose after the first one that a new process, after a kill, gave.

    Its CPU time begins anew.
    """
    known = [(i, float(row["cpu_time_s"])) for i, row in enumerate(scans) if row["cpu_time_s"]]
    first = next(i for (_, before), (i, now) in pairwise(known) if now < before)
    answered = next(i for i in range(first, len(scans)) if scans[i]["error_m"])
    reasons = [row["reason"] for row in scans[answered:] if not row["error_m"]]
    return [why for why in reasons if not why.startswith(("skipped", "Couldn't interpolate"))]


@needs_data
@pytest.mark.long
def test_a_recorded_drive_in_closed_loop(start, offload):
    """Hand-held, turning by up to 50 degrees between scans; half of the scans made the map.

    The motion comes from the scans alone; the first pose is off by 0.3 m and 2.9 degrees.
    """
    figures = replayed(start, BALM, "--rate", "5")
    assert "matched from scan to scan" in figures["guesses"]
    assert (figures["scans"], figures["answered"], figures["diverged"]) == (177, 177, 0)
    assert figures["within_share"] >= 0.99
    assert figures["error_m_median"] < 0.06


@needs_data
@pytest.mark.stress
def test_a_recorded_drive_with_the_whole_stack(start, platform, tmp_path):
    """The same recording; the sensor also moves sideways, which the speed does not contain.

    Estimating the motion takes most of a replay's time: the test above covers it.
    """
    stack = start(forked_manycore("run", MAPFILES / "ndt_stack.yaml"))
    rows = tmp_path / "scans.csv"
    guesses = ("--guess", "stack", "--motion", "reference", "--voxel", "0", "--csv", str(rows))
    figures = replayed(start, BALM, "--rate", "4", "--scans", "80", *guesses)
    check_closed_loop(rows, figures)
    assert stack.stop() == 0, stack
