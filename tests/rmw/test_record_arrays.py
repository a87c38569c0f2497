# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arrays that lie in a record behave as array.array does."""

from __future__ import annotations

import array
import copy
import io
import pickle
import random
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.exchanging import Exchange, in_record, large

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="others copy")

SEQUENCES = 60  # of operations, per type code
OPERATIONS = 12  # in a sequence
Operation = Callable[[Any], Any]


@pytest.fixture(params="Bd")
def exchange(node, request):
    return Exchange(node, typecode=request.param)


@pytest.fixture
def taken(exchange):
    """Return an array in a record, and the same values as array.array."""
    values = large(exchange.kind().data.typecode)
    found = exchange(values)
    assert in_record(found)
    return found, values


def test_it_is_an_array(taken):
    found, values = taken
    assert isinstance(found, array.array)
    assert found == values
    assert values == found
    assert (found.typecode, found.itemsize, len(found)) == (
        values.typecode,
        values.itemsize,
        len(values),
    )
    assert type(found).__name__ == "array"
    assert repr(found) == repr(values)
    assert found.tobytes() == values.tobytes()
    assert type(found) in [list, array.array]
    assert type(found) in {list, array.array}
    assert type(found) not in [list, bytearray]
    assert type(found)(found.typecode, [1, 2]) == array.array(found.typecode, [1, 2])
    with pytest.raises(TypeError):
        hash(found)


def test_numpy_sees_the_same_memory(taken):
    found, values = taken
    seen = np.frombuffer(found, found.typecode)
    assert seen.ctypes.data == found.buffer_info()[0]
    assert seen.ctypes.data % 4 == 0
    assert seen.ctypes.data % found.itemsize == 0
    seen[0] = found[1] = 3
    assert (found[0], seen[1]) == (3, 3)
    assert np.ndarray(len(found), found.typecode, buffer=found)[1] == 3
    assert found[2:] == values[2:]


def test_slices_and_copies_are_plain(taken):
    found, values = taken
    made = [found[:], found[1:9], found[::7], found + found, found * 2, copy.copy(found)]
    made += [copy.deepcopy(found), pickle.loads(pickle.dumps(found))]
    same = [values[:], values[1:9], values[::7], values + values, values * 2]
    assert made == [*same, values, values, values]
    assert {type(one) for one in made} == {array.array}


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_a_pickle_loads_without_us(taken, protocol):
    found, values = taken
    code = "import pickle, sys; print(pickle.load(sys.stdin.buffer).tobytes().hex())"
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", code],
        input=pickle.dumps(found, protocol),
        stdout=subprocess.PIPE,
        timeout=TIMEOUT_S,
        check=True,
    )
    assert done.stdout.decode().strip() == values.tobytes().hex()


def operation(source: random.Random, typecode: str) -> tuple[str, Operation]:
    """Return one of the things that programs do with arrays, and its name."""
    at, other = source.randrange(-200, 200), source.randrange(-200, 200)
    step = source.choice((1, 1, 2, -3))
    some = array.array(typecode, [1, 2, 3] * source.randrange(3))
    item = source.choice((1, 200, 300, "x", None, 1.5))
    text = some.tobytes() + b"x" * source.randrange(2)

    def assign_slice(values: Any) -> None:
        values[at:other:step] = some

    def assign_same_length(values: Any) -> None:
        values[at:other:step] = values[at:other:step]

    def add(values: Any) -> Any:
        values += some
        return values is not None

    def multiply(values: Any) -> Any:
        values *= source_count
        return len(values)

    source_count = source.choice((0, 1, 2, "x"))
    operations: dict[str, Operation] = {
        "append": lambda values: values.append(item),
        "extend": lambda values: values.extend(some),
        "extend by a list": lambda values: values.extend([1, item]),
        "extend by itself": lambda values: values.extend(values),
        "insert": lambda values: values.insert(at, item),
        "pop": lambda values: values.pop(),
        "pop at": lambda values: values.pop(at),
        "remove": lambda values: values.remove(item),
        "frombytes": lambda values: values.frombytes(text),
        "fromlist": lambda values: values.fromlist([1, item]),
        "fromfile": lambda values: values.fromfile(io.BytesIO(text), at),
        "fromunicode": lambda values: values.fromunicode("x"),
        "+=": add,
        "*=": multiply,
        "[] =": lambda values: values.__setitem__(at, item),
        "[:] =": assign_slice,
        "[:] = same length": assign_same_length,
        "[:] = list": lambda values: values.__setitem__(slice(at, other), [1]),
        "[:] = itself": lambda values: values.__setitem__(slice(at, other), values),
        "del []": lambda values: values.__delitem__(at),
        "del [:]": lambda values: values.__delitem__(slice(at, other, step)),
        "del all": lambda values: values.__delitem__(slice(None)),
        "reverse": lambda values: values.reverse(),
        "byteswap": lambda values: values.byteswap() if typecode == "B" else None,
        "read": lambda values: (values.count(1), values[at], values[at:other:step]),
        "wrong arguments": lambda values: values.append(),
    }
    name = source.choice(sorted(operations))
    return name, operations[name]


def outcome(act: Operation, values: Any, is_exported: bool) -> Any:
    view = memoryview(values) if is_exported else None
    try:
        result: Any = act(values)
    except Exception as error:
        result = (type(error), str(error))
    finally:
        if view is not None:
            view.release()
    return result, values.typecode, values.tobytes()


def test_generated_operations_do_what_they_do_with_array(exchange):
    typecode = exchange.kind().data.typecode
    source = random.Random(typecode)
    for number in range(SEQUENCES):
        expected = large(typecode, number)
        found = exchange(expected)
        assert in_record(found)
        done: list[str] = []
        for _ in range(OPERATIONS):
            name, act = operation(source, typecode)
            is_exported = source.random() < 0.3
            done.append(f"{name}{' while exported' * is_exported}")
            assert outcome(act, found, is_exported) == outcome(act, expected, is_exported), done


@pytest.mark.parametrize(
    "act",
    [
        lambda values: values.append(1),
        lambda values: values.pop(),
        lambda values: values.__iadd__(values),
        lambda values: values.__imul__(0),
        lambda values: values.__delitem__(slice(None)),
    ],
)
def test_views_refuse_a_resize_as_upstream(taken, act):
    found, values = taken
    view = memoryview(found)
    with pytest.raises(BufferError, match="exporting buffers"):
        act(found)
    assert found == values
    view.release()
    act(found)
    act(values)
    assert found == values
