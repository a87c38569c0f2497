# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Playback session, from start to end or Ctrl-C, with its status output."""

from __future__ import annotations

import json
import os
import selectors
import time
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.cli.common.keyboard import single_keys
from rmw_manycore_py.cli.common.printing import counted, echo, print_notices
from rmw_manycore_py.cli.topic.alarm import Alarm
from rmw_manycore_py.cli.topic.gap_notices import gap_notices
from rmw_manycore_py.cli.topic.play_keys import HELP, press
from rmw_manycore_py.cli.topic.status_line import StatusLine
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native._transport import now_ns
from rmw_manycore_py.process.signals import signal_inbox
from rmw_manycore_py.process.virtual_time import lives_in_virtual_time
from rmw_manycore_py.recording.play.player import Player, Tally
from rmw_manycore_py.recording.play.position import Position
from rmw_manycore_py.recording.play.program import Program
from rmw_manycore_py.recording.play.stage import Stage
from rmw_manycore_py.recording.recording import Recording

_NS_PER_S = 1_000_000_000
_NS_PER_MS = 1_000_000


@dataclass(frozen=True)
class Settings:
    """What to play, and how."""

    path: Path
    program: Program
    rate: float
    loops: bool
    clock_hz: float | None
    delay_s: float
    paused: bool
    keyless: bool


def play(platform: str | None, settings: Settings, *, as_json: bool) -> None:
    """Play to a platform, or to DDS if it is None, until the end or a signal."""
    with Recording(settings.path) as recording, closing(_stage(platform)) as stage:
        print_notices([*recording.faults, *recording.remarks])
        is_virtual = lives_in_virtual_time()
        position = _virtual(settings) if is_virtual else Position(settings.rate, settings.paused)
        player = Player(
            recording,
            stage,
            settings.program,
            position,
            loops=settings.loops,
            delay_s=settings.delay_s,
            clock_hz=settings.clock_hz,
        )
        print_notices(gap_notices(recording, player.start_ns, player.end_ns))
        if is_virtual:  # which only threads keep that wait for it
            with suppress(KeyboardInterrupt):
                player.play()
        else:
            _run(player, position, settings, StatusLine(quiet=as_json))
    _report(player.tally, as_json)


def _virtual(settings: Settings) -> Position:
    if settings.clock_hz is not None or settings.paused:
        raise ManycoreError(
            "--clock and --start-paused: in virtual time all nodes have its clock already, "
            "and `manycore pause` stops it",
            EXIT_BAD_INPUT,
        )
    return Position(settings.rate, now_ns=now_ns, sleep=time.sleep)


def _stage(platform: str | None) -> Stage:
    if platform is None:
        from rmw_manycore_py.recording.play.outside import Outside

        return Outside()
    from rmw_manycore_py.recording.play.inside import Inside

    return Inside(platform)


def _run(player: Player, position: Position, settings: Settings, line: StatusLine) -> None:
    with (
        closing(Alarm()) as ended,
        signal_inbox() as inbox,
        selectors.DefaultSelector() as selector,
        single_keys(wanted=not settings.keyless) as typing,
    ):
        selector.register(inbox, selectors.EVENT_READ, "end")
        selector.register(ended, selectors.EVENT_READ, "end")
        try:
            if typing is not None:
                selector.register(typing, selectors.EVENT_READ, "keys")
                line.print_line(HELP)
            player.start(ended.ring)
            while True:
                events = [key.data for key, _ in selector.select(line.period_s)]
                if "end" in events:
                    break
                if "keys" in events and typing is not None:
                    press(position, os.read(typing, 1024).decode(errors="replace"))
                line.show(_progress(player, position))
        finally:
            player.stop()
            line.clear()
    if player.failure is not None:
        raise player.failure


def _progress(player: Player, position: Position) -> str:
    at_s = max(position.at_ns() - player.start_ns, 0) / _NS_PER_S
    whole_s = (player.end_ns - player.start_ns) / _NS_PER_S
    parts = [
        f"{'paused at' if position.is_paused else 'playing'} {min(at_s, whole_s):.1f} s "
        f"of {whole_s:.1f} s",
        f"rate {position.rate:.3g}",
        counted(player.tally.messages, "message"),
    ]
    return " | ".join(parts)


def _report(tally: Tally, as_json: bool) -> None:
    facts: dict[str, Any] = {"messages": tally.messages}
    if tally.late_ns:
        median, p99 = np.percentile(np.array(tally.late_ns) / _NS_PER_MS, (50, 99))
        facts.update(late_ms_p50=float(median), late_ms_p99=float(p99))
    if as_json:
        echo(json.dumps(facts))
        return
    text = f"played {counted(tally.messages, 'message')}"
    if tally.late_ns:
        text += (
            f"; late by {facts['late_ms_p50']:.2f} ms (p50), {facts['late_ms_p99']:.2f} ms (p99)"
        )
    echo(text)
