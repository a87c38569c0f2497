# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads a recording: a file, or a rosbag2 directory with one or several."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterator
from pathlib import Path, PurePosixPath
from typing import Any

from typing_extensions import Self

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.recording.gaps import Gap, gaps_between
from rmw_manycore_py.recording.input import Input, Recorded
from rmw_manycore_py.recording.metadata import FILE_NAME, Span, TopicRow, read_metadata
from rmw_manycore_py.recording.target import SUFFIX


class Recording:
    """An open recording."""

    def __init__(self, path: Path) -> None:
        """Open a recording.

        :raises ManycoreError: if there is none, or it is not in MCAP.
        """
        self.path = path
        metadata = read_metadata(path) if path.is_dir() else None
        self._inputs: list[Input] = []
        try:
            for file in _files(path, metadata):
                self._inputs.append(Input(file, metadata))
            self.topics = _merged(row for one in self._inputs for row in one.rows())
        except BaseException:
            self.close()
            raise
        self.distro = str(self._inputs[0].described.get("ros_distro", ""))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def files(self) -> list[Path]:
        """Return its files, in time order."""
        return [one.path for one in self._inputs]

    @property
    def size_bytes(self) -> int:
        """Return the total size of its files."""
        return sum(one.size_bytes for one in self._inputs)

    @property
    def faults(self) -> list[str]:
        """Return the faults of files that are only partly readable."""
        return [
            f"{one.path}: {one.fault}; reading the intact part" for one in self._inputs if one.fault
        ]

    @property
    def remarks(self) -> list[str]:
        """Return notes on QoS profiles that were left out."""
        return [remark for one in self._inputs for remark in one.remarks]

    def gaps(self, min_gap_ns: int) -> list[Gap]:
        """Return the times without messages of at least this length."""
        return gaps_between([one.busy_times(min_gap_ns) for one in self._inputs], min_gap_ns)

    @property
    def span(self) -> Span:
        """Return the number of messages, and the first and last time."""
        spans = [one.span for one in self._inputs if one.span.messages]
        if not spans:
            return Span(0, 0, 0)
        start_ns = min(span.start_ns for span in spans)
        end_ns = max(span.end_ns for span in spans)
        return Span(sum(span.messages for span in spans), start_ns, end_ns)

    def messages(
        self, topics: Collection[str], start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Yield the messages of topics in a time range, in time order."""
        for one in self._inputs:
            yield from one.messages(topics, start_ns, end_ns)

    def close(self) -> None:
        """Close its files."""
        for one in self._inputs:
            one.close()


def _files(path: Path, metadata: dict[str, Any] | None) -> list[Path]:
    if not path.is_dir():
        _refuse_other_storage(path)
        return [path]
    if metadata is None:
        files = sorted(path.glob(f"*{SUFFIX}"))
    else:
        # Old recordings name files relative to the parent directory.
        names = [PurePosixPath(str(name)).name for name in metadata["relative_file_paths"]]
        files = [path / name for name in names]
    for file in files:
        _refuse_other_storage(file)
    if not files:
        others = sorted(path.glob("*.db3"))
        for file in others:
            _refuse_other_storage(file)
        raise ManycoreError(
            f"{path}: expected a recording, a directory with {FILE_NAME} or {SUFFIX} files, found "
            "neither",
            EXIT_BAD_INPUT,
        )
    return files


def _refuse_other_storage(file: Path) -> None:
    if file.suffix == ".db3":
        raise ManycoreError(
            f"{file}: expected MCAP, found rosbag2's sqlite3: `pip install rosbags`, then "
            f"`rosbags-convert --src {shlex.quote(str(file.parent))} --dst NEW --dst-storage mcap`",
            EXIT_BAD_INPUT,
        )
    if file.suffix == ".zstd":
        raise ManycoreError(
            f"{file}: expected MCAP, found a file that rosbag2 compressed as a whole: "
            f"zstd -d {file}, and its name in {FILE_NAME} without .zstd",
            EXIT_BAD_INPUT,
        )


def _merged(rows: Iterator[TopicRow]) -> list[TopicRow]:
    """Return one row per topic and type."""
    found: dict[tuple[str, str], TopicRow] = {}
    for row in rows:
        known = found.setdefault((row.name, row.type), row)
        if known is not row:
            known.add_offers(row.offers)
            known.messages += row.messages
    return sorted(found.values(), key=lambda row: row.name)
