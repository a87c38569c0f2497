# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Complete, truncated and damaged files, and folders of rosbag2."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml
from mcap.reader import NonSeekingReader, SeekingReader
from mcap.writer import CompressionType, IndexType, Writer

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.metadata import write_metadata
from rmw_manycore_py.recording.output import Output
from rmw_manycore_py.recording.recording import Recording
from rmw_manycore_py.recording.target import Target
from support.samples.bags import Bag
from support.samples.recordings import (
    START_NS,
    STRING,
    string_row,
    text_in,
    text_message,
    write_texts,
)
from support.sources.advice import run_quoted

pytestmark = [pytest.mark.unit, pytest.mark.needs("rosbags", "mcap")]

TEXTS = [("/a", 0.1 * n, f"text {n}") for n in range(12)]


def texts_of(recording: Recording, *topics: str) -> list[str]:
    return [text_in(m.data) for m in recording.messages(topics or {"/a"})]


@pytest.mark.parametrize("compression", ["none", "lz4", "zstd"])
def test_what_is_written_is_read(tmp_path: Path, compression: str) -> None:
    path = write_texts(tmp_path / "a.mcap", TEXTS, compression=compression, each=5)
    with Recording(path) as recording:
        assert texts_of(recording) == [text for _, _, text in TEXTS]
        assert recording.faults == []
        (row,) = recording.topics
        assert (row.name, row.type, row.messages, row.offers) == ("/a", STRING, 12, [Qos()])
        span = recording.span
        assert (span.messages, span.start_ns) == (12, START_NS)
        assert recording.distro == "jazzy"
        late = recording.messages({"/a"}, START_NS + 1_000_000_000)
        assert [text_in(message.data) for message in late] == ["text 10", "text 11"]


@pytest.mark.parametrize("compression", ["none", "lz4", "zstd"])
def test_the_reader_of_mcap_finds_all_of_it_whole(tmp_path: Path, compression: str) -> None:
    """With and without the index, all checksums verified."""
    path = write_texts(tmp_path / "a.mcap", TEXTS, compression=compression, each=5)
    for kind in (SeekingReader, NonSeekingReader):
        with path.open("rb") as stream:
            found = kind(stream, validate_crcs=True).iter_messages()
            assert [text_in(message.data) for _, _, message in found] == [t for _, _, t in TEXTS]
    with path.open("rb") as stream:
        reader = SeekingReader(stream, validate_crcs=True)
        statistics = reader.get_summary().statistics
        assert (statistics.message_count, statistics.channel_count) == (12, 1)
        assert reader.get_header().profile == "ros2"


def test_messages_come_in_the_order_of_their_times(tmp_path: Path) -> None:
    texts = [("/a", 0.3, "c"), ("/b", 0.1, "a"), ("/a", 0.2, "b")]
    with Recording(write_texts(tmp_path / "a.mcap", texts, each=2)) as recording:
        assert texts_of(recording, "/a", "/b") == ["a", "b", "c"]
        assert texts_of(recording, "/b") == ["a"]


@pytest.mark.parametrize("compression", ["none", "zstd"])
def test_a_file_may_be_cut_off_anywhere(tmp_path: Path, compression: str) -> None:
    """A file truncated anywhere keeps the messages of the chunks before."""
    whole = write_texts(tmp_path / "a.mcap", TEXTS, compression=compression, each=3).read_bytes()
    cut, found = tmp_path / "cut.mcap", set()
    for size in range(len(whole) - 1, 8, -61):
        cut.write_bytes(whole[:size])
        with Recording(cut) as recording:
            texts = texts_of(recording)
            assert texts == [text for _, _, text in TEXTS[: len(texts)]]
            assert recording.span.messages == len(texts)
            found.add(len(texts))
            assert [fault for fault in recording.faults if "not finished" in fault]
    assert found == {0, 3, 6, 9, 12}


def test_a_file_without_chunks_may_be_cut_off(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    write_foreign(path, use_chunking=False)
    data = path.read_bytes()
    with Recording(path) as recording:
        assert len(texts_of(recording)) == 12
    path.write_bytes(data[: data.index(b"text 7") + 3])
    with Recording(path) as recording:
        assert texts_of(recording) == [f"text {n}" for n in range(7)]
        assert "not finished" in recording.faults[0]


@pytest.mark.parametrize(
    "options",
    [
        {"compression": CompressionType.LZ4},
        {"compression": CompressionType.ZSTD},
        {"index_types": IndexType.NONE},
        {"use_statistics": False},
        {"repeat_channels": False, "repeat_schemas": False},
        {"repeat_schemas": False},
    ],
)
def test_files_of_other_writers_are_read(tmp_path: Path, options: dict[str, object]) -> None:
    write_foreign(tmp_path / "a.mcap", **options)
    with Recording(tmp_path / "a.mcap") as recording:
        assert len(texts_of(recording)) == 12
        assert recording.faults == []
        assert recording.span.messages == 12


def write_foreign(path: Path, **options: object) -> None:
    """Write TEXTS with the library alone."""
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=100, **options)  # type: ignore[arg-type]
        writer.start("ros2")
        schema = writer.register_schema(STRING, "ros2msg", b"string data")
        channel = writer.register_channel("/a", "cdr", schema)
        for _, at_s, text in TEXTS:
            at_ns = START_NS + round(at_s * 1e9)
            writer.add_message(channel, at_ns, text_message(text), at_ns)
        writer.finish()


def test_a_folder_of_another_rosbag2_writer_is_read(tmp_path: Path) -> None:
    with Bag(tmp_path / "bag", "mcap", "storage") as bag:
        for number in range(3):
            bag.write("/a", bag.make("std_msgs/String", f"text {number}"), number)
    with Recording(tmp_path / "bag") as recording:
        assert texts_of(recording) == ["text 0", "text 1", "text 2"]


# Key of metadata.yaml, and the version of the format that brought it.
KEYS = {
    "compression_format": 3, "compression_mode": 3, "files": 5, "custom_data": 6, "ros_distro": 8,
}  # fmt: skip


@pytest.mark.parametrize("version", range(1, 10))
def test_a_folder_of_any_version_of_rosbag2_is_read(tmp_path: Path, version: int) -> None:
    with Bag(
        tmp_path / "bag", "mcap", "message" if version >= KEYS["compression_mode"] else ""
    ) as bag:
        for number in range(3):
            bag.write("/a", bag.make("std_msgs/String", f"text {number}"), number)
    file = tmp_path / "bag/metadata.yaml"
    metadata = yaml.safe_load(file.read_text())
    found = metadata["rosbag2_bagfile_information"]
    found["version"] = version
    for key in (key for key, since in KEYS.items() if since > version):
        del found[key]
    for topic in found["topics_with_message_count"] if version < 9 else ():
        topic["topic_metadata"]["offered_qos_profiles"] = ""
    if version <= 3:  # relative to the parent directory
        found["relative_file_paths"] = [f"bag/{name}" for name in found["relative_file_paths"]]
    file.write_text(yaml.safe_dump(metadata))
    with Recording(tmp_path / "bag") as recording:
        assert texts_of(recording) == ["text 0", "text 1", "text 2"]
        assert recording.distro == "rosbags"  # the file has it, too
    assert refusal_with(file, metadata, compression_mode="MESSAGE", compression_format="lz4")


def refusal_with(file: Path, metadata: dict[str, Any], **changes: str) -> bool:
    metadata["rosbag2_bagfile_information"].update(changes)
    file.write_text(yaml.safe_dump(metadata))
    return "expected messages compressed with zstd, found 'lz4'" in refusal(file.parent)


def test_profiles_of_qos_that_cannot_be_read_are_left_out(tmp_path: Path) -> None:
    with (tmp_path / "a.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start("ros2")
        metadata = {"offered_qos_profiles": "- history: x"}
        channel = writer.register_channel("/a", "cdr", 0, metadata)
        writer.add_message(channel, 1, text_message("text"), 1)
        writer.finish()
    with Recording(tmp_path / "a.mcap") as recording:
        assert texts_of(recording) == ["text"]
        (remark,) = recording.remarks
        assert "/a has no QoS profiles: KeyError('reliability'): they are left out" in remark


def test_messages_of_a_file_without_chunks_come_in_the_order_of_their_times(tmp_path: Path) -> None:
    with (tmp_path / "a.mcap").open("wb") as file:
        writer = Writer(file, use_chunking=False)
        writer.start("ros2")
        channel = writer.register_channel("/a", "cdr", 0)
        for at_ns in (3, 1, 2):
            writer.add_message(channel, at_ns, text_message(f"text {at_ns}"), at_ns)
        writer.finish()
    with Recording(tmp_path / "a.mcap") as recording:
        assert texts_of(recording) == ["text 1", "text 2", "text 3"]


def test_a_folder_with_several_files_is_one_recording(tmp_path: Path) -> None:
    write_texts(tmp_path / "x_0.mcap", TEXTS[:5])
    write_texts(tmp_path / "x_1.mcap", TEXTS[5:])
    with Recording(tmp_path) as recording:
        assert texts_of(recording) == [text for _, _, text in TEXTS]
        assert recording.span.messages == 12
        assert recording.topics[0].messages == 12


def refusal(path: Path) -> str:
    with pytest.raises(ManycoreError) as caught, Recording(path) as recording:
        texts_of(recording)
    assert caught.value.exit_status == EXIT_BAD_INPUT
    return str(caught.value)


def test_what_is_no_recording_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.mcap"
    for content, found in ((b"", "an empty file"), (b"#ROSBAG V2.0\n", "ROSBAG")):
        file.write_bytes(content)
        assert "expected an MCAP file" in refusal(file)
        assert found in refusal(file)
    assert "neither" in refusal(tmp_path.parent / tmp_path.name / ".." / "..")
    (tmp_path / "b").mkdir()
    for text in ("a: 1", "a: 2024-13-01", "[" * 3000, "\0"):
        (tmp_path / "b" / "metadata.yaml").write_text(text)
        assert "rosbag2_bagfile_information" in refusal(tmp_path / "b")
    assert "zstd -d" in refusal(tmp_path / "a.mcap.zstd")


def test_a_recording_in_sqlite_is_converted(tmp_path: Path) -> None:
    with Bag(tmp_path / "the user's bag") as bag:
        for number in range(3):
            bag.write("/text", bag.make("std_msgs/String", f"{number}"), number)
    new = tmp_path / "new"
    run_quoted(refusal(bag.path), "rosbags-convert", NEW=new)
    with Recording(new) as recording:
        assert recording.span.messages == 3


def test_a_missing_file_of_a_folder_is_named(tmp_path: Path) -> None:
    folder = tmp_path / "bag"
    folder.mkdir()
    write_metadata(folder, {"relative_file_paths": ["bag_0.mcap"]})
    assert "bag_0.mcap: cannot be read: No such file" in refusal(folder)
    write_metadata(folder, {"relative_file_paths": ["bag_0.mcap\0"]})
    assert "cannot be read: embedded null byte" in refusal(folder)


def test_a_damaged_chunk_is_reported(tmp_path: Path) -> None:
    path = write_texts(tmp_path / "a.mcap", TEXTS, each=3)
    data = bytearray(path.read_bytes())
    data[data.index(b"text 7")] ^= 1
    path.write_bytes(data)
    assert "is damaged" in refusal(path)
    path.write_bytes(data[: data.index(b"text 10")])  # without an index as well
    with Recording(path) as recording:
        assert len(texts_of(recording)) == 6
        assert "damaged after byte" in recording.faults[0]


def test_no_damage_leads_to_another_error(tmp_path: Path) -> None:
    """Flip random bits."""
    whole = write_texts(tmp_path / "a.mcap", TEXTS, each=6).read_bytes()
    path = tmp_path / "b.mcap"
    for place in range(0, len(whole), 23):
        data = bytearray(whole)
        data[place] ^= 0x10
        path.write_bytes(data)
        try:
            with Recording(path) as recording:
                texts_of(recording)
        except ManycoreError:
            pass


def test_a_topic_without_messages_is_there(tmp_path: Path) -> None:
    output = Output(tmp_path / "a.mcap")
    output.finish([string_row("/quiet")])
    with Recording(tmp_path / "a.mcap") as recording:
        assert [(row.name, row.messages) for row in recording.topics] == [("/quiet", 0)]


def test_a_failed_write_leaves_whole_chunks(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    output, row = Output(path), string_row("/a")
    output.write(row, 1, 1, 1, text_message("first"))
    output.flush()
    size = path.stat().st_size
    output.write(row, 2, 2, 2, text_message("second"))
    output._file.write(b"\x06 the begin of a chunk")
    output.give_up()
    assert path.stat().st_size == size
    assert output.whole_messages == 1
    with Recording(path) as recording:
        assert texts_of(recording) == ["first"]


class TestTarget:
    def test_a_suffix_makes_a_file_else_a_folder(self, tmp_path: Path) -> None:
        assert Target(tmp_path / "a.mcap").file == tmp_path / "a.mcap"
        assert Target(tmp_path / "a").file == tmp_path / "a" / "a_0.mcap"

    def test_what_is_there_is_replaced_only_by_force(self, tmp_path: Path) -> None:
        target = Target(tmp_path / "a")
        target.prepare(force=False)
        target.file.touch()
        with pytest.raises(ManycoreError, match="already exists"):
            target.prepare(force=False)
        target.prepare(force=True)
        assert list(target.path.iterdir()) == []

    def test_force_removes_recordings_only(self, tmp_path: Path) -> None:
        precious = tmp_path / "a" / "thesis.txt"
        precious.parent.mkdir()
        precious.touch()
        for path in (tmp_path / "a", precious):
            with pytest.raises(ManycoreError, match="contains more than a recording"):
                Target(path).prepare(force=True)
        assert precious.is_file()
        shutil.rmtree(precious.parent)
