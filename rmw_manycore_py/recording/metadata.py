# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""rosbag2 metadata: metadata.yaml, and its copy in the MCAP file."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_distribution import NAME
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.yaml_faults import yaml_fault
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.definitions import NO_SCHEMA, Schema
from rmw_manycore_py.recording.offers import profiles_of
from rmw_manycore_py.recording.plain_yaml import dump

FILE_NAME = "metadata.yaml"
_ROOT = "rosbag2_bagfile_information"
_VERSION = 9
_RECORD = "rosbag2"  # name of the metadata record in an MCAP file


@dataclass
class TopicRow:
    """A topic of a recording, and its number of messages."""

    name: str
    type: str
    type_hash: str = ""
    schema: Schema = NO_SCHEMA
    offers: list[Qos] = field(default_factory=list)
    encoding: str = "cdr"
    messages: int = 0

    def add_offers(self, offers: Iterable[Qos]) -> None:
        """Add offered QoS profiles, without duplicates."""
        self.offers += [offer for offer in _distinct(offers) if offer not in self.offers]


@dataclass(frozen=True)
class Span:
    """Number of messages, and times of the first and last (ns)."""

    messages: int
    start_ns: int
    end_ns: int

    @property
    def duration_ns(self) -> int:
        """Return the time between the first and the last message."""
        return self.end_ns - self.start_ns


def information(file_name: str, rows: Sequence[TopicRow], span: Span) -> dict[str, Any]:
    """Return rosbag2's metadata of a recording in one file."""
    start = {"nanoseconds_since_epoch": span.start_ns}
    duration = {"nanoseconds": span.duration_ns}
    return {
        "version": _VERSION,
        "storage_identifier": "mcap",
        "duration": duration,
        "starting_time": start,
        "message_count": span.messages,
        "topics_with_message_count": [_topic(row) for row in rows],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file_name],
        "files": [
            {
                "path": file_name,
                "starting_time": start,
                "duration": duration,
                "message_count": span.messages,
            }
        ],
        "custom_data": {},
        "ros_distro": os.environ.get("ROS_DISTRO") or NAME,
    }


def _topic(row: TopicRow) -> dict[str, Any]:
    metadata = {
        "name": row.name,
        "type": row.type,
        "serialization_format": row.encoding,
        "offered_qos_profiles": profiles_of(row.offers),
        "type_description_hash": row.type_hash,
    }
    return {"topic_metadata": metadata, "message_count": row.messages}


def write_metadata(folder: Path, found: dict[str, Any]) -> None:
    """Write metadata.yaml atomically."""
    path = folder / FILE_NAME
    temporary = path.with_suffix(".yaml.part")
    temporary.write_text(dump({_ROOT: found}))
    temporary.rename(path)


def read_metadata(folder: Path) -> dict[str, Any] | None:
    """Return the contents of metadata.yaml; None if missing, as for unfinished recordings.

    :raises ManycoreError: if it is not a metadata.yaml of rosbag2.
    """
    path = folder / FILE_NAME
    try:
        found = yaml.safe_load(path.read_text(encoding="utf-8"))[_ROOT]
        if not isinstance(found["relative_file_paths"], list):
            raise TypeError("relative_file_paths")
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ManycoreError(f"{path}: cannot be read: {error.strerror}", EXIT_BAD_INPUT) from error
    except Exception as error:  # numbers and dates of YAML raise errors of their own
        raise ManycoreError(
            f"{path}: expected '{_ROOT}' with 'relative_file_paths', as rosbag2 writes it, found "
            f"{yaml_fault(error)}; without this file the recording is read by itself",
            EXIT_BAD_INPUT,
        ) from error
    assert isinstance(found, dict)
    return found


def own_metadata(records: Mapping[str, Mapping[str, str]]) -> dict[str, Any]:
    """Return rosbag2's metadata from the records of an MCAP file; empty if there is none."""
    record = records.get(_RECORD, {})
    try:
        found = yaml.safe_load(record.get("serialized_metadata", ""))
    except Exception:  # the messages can be read without it
        found = None
    # A file that rosbag2 has not finished has only the distribution.
    distro = {"ros_distro": record["ROS_DISTRO"]} if "ROS_DISTRO" in record else {}
    return {**distro, **(found if isinstance(found, dict) else {})}


def _distinct(offers: Iterable[Qos]) -> list[Qos]:
    found: list[Qos] = []
    for offer in offers:
        if offer not in found:
            found.append(offer)
    return found
