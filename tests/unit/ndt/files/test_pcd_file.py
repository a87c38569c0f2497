# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""PCD files as other programs write them, and damaged ones."""

from __future__ import annotations

from itertools import chain

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.files.cloud_file import read_cloud
from rmw_manycore_py.ndt.files.pcd_file import read_pcd
from rmw_manycore_py.ndt.maps.map_file import read_points

pytestmark = pytest.mark.unit

UTM_M = np.array([500_000.0, 5_000_000.0, 100.0])
POINTS = UTM_M + np.random.default_rng(1).uniform(-50, 50, (60, 3))
HEADER = """# .PCD v0.7
VERSION 0.7
FIELDS {names}
SIZE {sizes}
TYPE {types}
COUNT {counts}
WIDTH {width}
HEIGHT {height}
VIEWPOINT 0 0 0 1 0 0 0
POINTS {points}
DATA {data}
"""
PLAIN = np.dtype([(name, "<f8") for name in "xyz"])
PADDED = np.dtype(  # as PCL writes PointXYZIRT: `_` is padding
    [
        *((name, "<f4") for name in "xyz"),
        ("_", "u1", 4),
        ("intensity", "<f4"),
        ("ring", "<u2"),
        ("_2", "u1", 10),
    ]
)
SHUFFLED = np.dtype(
    [("rgb", "<u4"), ("z", "<f8"), ("normal", "<f4", 3), ("x", "<f8"), ("y", "<f4")]
)
KINDS = {"f": "F", "i": "I", "u": "U"}


def records_of(dtype: np.dtype) -> np.ndarray:
    records = np.zeros(len(POINTS), dtype)
    for axis, name in enumerate("xyz"):
        records[name] = POINTS[:, axis]
    return records


def header_of(dtype: np.dtype, data: str, **changes: object) -> bytes:
    subtypes = [dtype[name].subdtype or (dtype[name], (1,)) for name in dtype.names]
    entries = {
        "names": " ".join(name.rstrip("2") for name in dtype.names),
        "sizes": " ".join(str(number.itemsize) for number, _ in subtypes),
        "types": " ".join(KINDS[number.kind] for number, _ in subtypes),
        "counts": " ".join(str(shape[0]) for _, shape in subtypes),
        "width": len(POINTS),
        "height": 1,
        "points": len(POINTS),
        "data": data,
    }
    return HEADER.format(**{**entries, **changes}).encode()


def packed(data: bytes) -> bytes:
    """Return data as LZF without back references."""
    parts = [data[at : at + 32] for at in range(0, len(data), 32)]
    lzf = b"".join(bytes([len(part) - 1]) + part for part in parts)
    return len(lzf).to_bytes(4, "little") + len(data).to_bytes(4, "little") + lzf


def body_of(records: np.ndarray, data: str) -> bytes:
    if data == "binary":
        return records.tobytes()
    if data == "binary_compressed":
        return packed(b"".join(records[name].tobytes() for name in records.dtype.names))
    rows = ([np.ravel(value).tolist() for value in record] for record in records.tolist())
    return "".join(" ".join(map(repr, chain(*row))) + "\n" for row in rows).encode()


@pytest.mark.parametrize("data", ["ascii", "binary", "binary_compressed"])
@pytest.mark.parametrize("dtype", [PLAIN, PADDED, SHUFFLED], ids=["plain", "padded", "shuffled"])
def test_layouts(tmp_path, dtype, data):
    records = records_of(dtype)
    path = tmp_path / "map.pcd"
    path.write_bytes(header_of(dtype, data, width=len(POINTS) // 4, height=4))
    with path.open("ab") as file:
        file.write(body_of(records, data))
    expected = np.stack([records[name] for name in "xyz"], axis=1)
    np.testing.assert_array_equal(read_cloud(path), expected)
    assert read_cloud(path).dtype == (np.float32 if dtype is PADDED else np.float64)


def test_a_text_has_the_precision_of_its_type(tmp_path):
    header = header_of(PLAIN, "ascii", sizes="4 4 4", points=1, width=1)
    (tmp_path / "map.pcd").write_bytes(header + b"0.1 0.2 0.3\n")
    found = read_cloud(tmp_path / "map.pcd")
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, np.float32([[0.1, 0.2, 0.3]]))


def test_as_windows_writes_it_with_holes(tmp_path):
    """Header lines end with CR LF."""
    text = header_of(PLAIN, "ascii", points=2, width=2).decode() + "1 2 3\nnan NaN nan\n"
    (tmp_path / "map.pcd").write_bytes(text.replace("\n", "\r\n").encode())
    np.testing.assert_array_equal(read_pcd(tmp_path / "map.pcd"), [[1, 2, 3], [np.nan] * 3])


@pytest.mark.parametrize(
    "content",
    [
        header_of(PLAIN, "binary") + bytes(100),
        header_of(PLAIN, "ascii") + b"1 2 3\n",
        header_of(PLAIN, "ascii", points=1, width=1) + b"1 2\n",
        header_of(PLAIN, "ascii", points=1, width=1) + b"1 2 three\n",
        header_of(PLAIN, "zip"),
        header_of(PLAIN, "binary", names="a b c") + records_of(PLAIN).tobytes(),
        header_of(PLAIN, "binary", sizes="3 3 3"),
        header_of(PLAIN, "binary", sizes="8 8"),
        header_of(PLAIN, "binary", types="F F X"),
        header_of(PLAIN, "binary", points="many"),
        header_of(PLAIN, "binary", points=-1),
        header_of(PLAIN, "binary", counts="1 1 -1"),
        header_of(PLAIN, "binary", counts="1 1 19999999999999"),
        header_of(PLAIN, "binary", points=10**25, width=10**25),
        header_of(PLAIN, "binary_compressed", points=10**25, width=10**25) + packed(bytes(10)),
        header_of(PLAIN, "ascii", points=10**13, width=10**13) + b"1 2 3\n",
        header_of(PLAIN, "binary", points=10**13, width=10**13),
        header_of(PLAIN, "binary_compressed") + bytes(3),
        header_of(PLAIN, "binary_compressed") + packed(bytes(10)),
        header_of(PLAIN, "binary_compressed") + packed(bytes(1440))[:700],
        b"",
        b"no header\n" * 100,
    ],
)
def test_broken_files(tmp_path, content):
    (tmp_path / "map.pcd").write_bytes(content)
    with pytest.raises(ManycoreError, match=r"map\.pcd: .{10}"):
        read_points(tmp_path / "map.pcd")


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (header_of(PLAIN, "binary", width=-5), "header is broken: WIDTH is negative: -5"),
        (
            header_of(PLAIN, "binary", width="five"),
            "header is broken: WIDTH is not a number: 'five'",
        ),
        (header_of(PLAIN, "binary", points=10**25), f"POINTS is too large: {10**25}"),
        (header_of(PLAIN, "ascii") + b"1 2 3\n1 2 three\n", "numbers in line 13, found 'three'"),
    ],
)
def test_a_fault_is_named_with_its_place(tmp_path, content, fault):
    (tmp_path / "map.pcd").write_bytes(content)
    with pytest.raises(ManycoreError, match=f"{fault}$"):
        read_points(tmp_path / "map.pcd")
