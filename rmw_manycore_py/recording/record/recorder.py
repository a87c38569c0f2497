# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Subscribes to selected topics as publishers appear, and queues messages for writing."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence

from rmw_manycore_bridge.outside import types
from rmw_manycore_py.recording.definitions import NO_SCHEMA, schema_of
from rmw_manycore_py.recording.metadata import TopicRow
from rmw_manycore_py.recording.record.side import Offer, Side
from rmw_manycore_py.recording.record.topic import RecordedTopic
from rmw_manycore_py.recording.record.writing import WritingThread
from rmw_manycore_py.recording.selection import Selection

_COUNT_PERIOD_S = 0.5

Tell = Callable[[str], None]


class Recorder:
    """Takes messages in its own thread."""

    def __init__(
        self, side: Side, selection: Selection, writing: WritingThread, depth: int, tell: Tell
    ) -> None:
        """Create the recorder.

        :param depth: minimum queue depth per topic.
        :param tell: called with notices for the user, once per topic.
        """
        self._side, self._selection, self._depth = side, selection, depth
        self._writing, self._tell = writing, tell
        self._topics: dict[str, RecordedTopic] = {}
        self._refused: set[str] = set()
        self._stopping = False
        self.losses: dict[str, int] = {}  # number of lost messages by topic
        self.failure: BaseException | None = None
        self._ended: Callable[[], None] = lambda: None
        self._thread = threading.Thread(target=self._run, name="taking")

    def start(self, ended: Callable[[], None]) -> None:
        """Start recording; `ended` is called on failure."""
        self._ended = ended
        self._thread.start()

    def stop(self) -> None:
        """Take messages that have arrived, then stop."""
        self._stopping = True
        self._side.wake()
        self._thread.join()

    @property
    def rows(self) -> list[TopicRow]:
        """Return the recorded topics."""
        return [topic.row for topic in list(self._topics.values())]

    def _count_losses(self) -> None:
        found = {name: topic.lost() for name, topic in self._topics.items()}
        self.losses = {name: count for name, count in found.items() if count}

    def _run(self) -> None:
        counted_s = 0.0
        try:
            while not self._stopping and self._writing.failure is None:
                if self._side.stale:
                    self._side.stale = False
                    self._follow()
                self._side.turn()
                if time.monotonic() - counted_s >= _COUNT_PERIOD_S:
                    counted_s = time.monotonic()
                    self._count_losses()
            for topic in self._topics.values():
                topic.take_rest()
        except BaseException as error:
            self.failure = error
        finally:
            for topic in self._topics.values():
                topic.close()
            self._count_losses()
            self._ended()

    def _follow(self) -> None:
        """Subscribe to new topics, and adapt QoS to current publishers."""
        for name, offers in self._side.offers().items():
            if not self._selection.takes(name, offers[0].type):
                continue
            types = self._types_of(name, offers)
            if len(types) > 1:
                self._refuse(name, f"has several types, {' and '.join(types)}")
            else:
                self._record(name, offers)

    def _types_of(self, name: str, offers: Sequence[Offer]) -> list[str]:
        """Return the current types of a topic; with hashes if one has several definitions."""
        found = {(offer.type, offer.type_hash) for offer in offers}
        if name in self._topics:
            row = self._topics[name].row
            found.add((row.type, row.type_hash))
        names = sorted({type_name for type_name, _ in found})
        hashes = sorted({type_hash for _, type_hash in found if type_hash})
        if len(names) > 1 or len(hashes) < 2:
            return names
        return [f"{names[0]} ({type_hash})" for type_hash in hashes]

    def _record(self, name: str, offers: list[Offer]) -> None:
        topic = self._topics.get(name)
        if topic is None:
            topic = self._new_topic(name, offers[0])
        try:
            topic.follow(offers, self._depth)
        except ImportError as error:
            self._refuse(name, f"({error}; `manycore interface build PATH`)")
            return
        if name not in self._topics:
            self._topics[name] = topic
            self._tell(f"recording {name} ({topic.row.type})")
            if topic.row.schema is NO_SCHEMA:
                self._tell(
                    f"{name}: type {topic.row.type} is not installed as its publisher has it: "
                    "recorded without the definition, which viewers need; "
                    "`manycore interface build PATH`"
                )

    def _new_topic(self, name: str, offer: Offer) -> RecordedTopic:
        schema = schema_of(offer.type)
        if offer.type_hash and types.hash_of(offer.type) not in ("", offer.type_hash):
            schema = NO_SCHEMA  # the installed definition differs
        row = TopicRow(name, offer.type, offer.type_hash, schema)
        return RecordedTopic(row, self._side, self._writing, self._tell)

    def _refuse(self, name: str, reason: str) -> None:
        """Report once why a topic or a publisher is skipped."""
        if name not in self._refused:
            self._refused.add(name)
            self._tell(f"not recorded: {name} {reason}")
