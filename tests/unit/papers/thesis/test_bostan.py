# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The model of Bostan: nothing gets lost unnoticed, times are those computed by hand, and FIFOs
overflow exactly where more is sent than they hold.
"""

from __future__ import annotations

import random
from dataclasses import fields, replace
from itertools import permutations

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.thesis.noc.cases import Case
from rmw_manycore_py.papers.thesis.noc.model import ROUTES, SETTING, relevant
from rmw_manycore_py.prediction.bostan import routing, topology
from rmw_manycore_py.prediction.bostan.cache import Cache
from rmw_manycore_py.prediction.bostan.chip import run
from rmw_manycore_py.prediction.bostan.fifo import Fifo
from rmw_manycore_py.prediction.bostan.memory import Memory
from rmw_manycore_py.prediction.bostan.packets import (
    MAX_TRANSFER_BYTES,
    Packet,
    flits_of,
    payloads,
)
from rmw_manycore_py.prediction.bostan.parameters import (
    REFRESH_INTERVAL_S,
    REFRESH_S,
    Parameters,
    corners,
    range_of,
)
from rmw_manycore_py.prediction.bostan.transfers import Transfer

pytestmark = pytest.mark.unit

# Whole numbers, so that sums by hand are exact.
P = Parameters(header_flits=2, hop_cycles=5, fifo_flits=256, tx_start_cycles=500)
P = replace(P, uc_start_cycles=400, cluster_smem_cycles=10, uc_read_ahead_packets=4)
SMEM_BYTES_PER_CYCLE = 16 * 8


def between(start: str, end: str, size: int, method: str = "UC") -> Transfer:
    return Transfer(routing.shortest(start, end), size, method, "CC SMEM")  # type: ignore[arg-type]


def test_the_chip_has_32_nodes_and_the_rings_of_a_torus() -> None:
    assert len(topology.nodes()) == len(set(topology.nodes())) == 32
    # Eight rings of six nodes, in both directions.
    assert len(topology.hops()) == 8 * 6 * 2
    assert ("N0", "S0") in topology.hops()
    assert ("N0", "N1") not in topology.hops()


def test_routes_go_along_the_row_and_then_the_column() -> None:
    assert routing.shortest("N1", "C6") == ("N1", "C2", "C6")
    assert routing.shortest("C1", "C6") == ("C1", "C2", "C6")
    assert routing.shortest("W0", "S3") == ("W0", "C1", "C2", "C3", "C4", "C8", "C12", "C16", "S3")


def test_shortest_routes_cannot_deadlock() -> None:
    routes = [routing.shortest(*ends) for ends in permutations(topology.nodes(), 2)]
    assert not routing.can_deadlock(routes)


def test_routes_around_a_ring_can_deadlock() -> None:
    ring = topology.column(0)
    around = [(ring[i], ring[(i + 1) % 6], ring[(i + 2) % 6]) for i in range(6)]
    assert routing.can_deadlock(around)
    assert not routing.can_deadlock(around[:-1])


@pytest.mark.parametrize("size", [1, 100, 248])
def test_a_lone_packet_takes_what_is_computed_by_hand(size: int) -> None:
    route = routing.shortest("C1", "C16")  # six links
    found = run([Transfer(route, size, "UC", "CC SMEM")], P).end
    flits = -(-size // 4) + 2
    read = size / SMEM_BYTES_PER_CYCLE + 10
    assert found == pytest.approx(400 + read + 6 * 5 + flits)


def test_a_packet_by_tx_waits_for_the_core() -> None:
    parameters = replace(P, tx_loop_cycles=3, line_bytes=64)
    found = run([between("C1", "C2", 64, "Tx")], parameters).end
    # Eight loads and stores, and a cache line: 10 cycles to its first word, 7 for the others.
    assert found == pytest.approx(500 + 8 * 3 + 17 + 5 + 18)


def test_a_core_feeds_one_packet_after_the_other() -> None:
    parameters = replace(P, tx_loop_cycles=3, line_bytes=64)
    found = run([between("C1", "C2", 3 * 248, "Tx")], parameters).end
    each = 31 * 3 + 248 / 64 * 17
    assert found == pytest.approx(500 + 3 * each + 5 + 64)


def test_the_uc_reads_no_farther_ahead_than_it_has_buffers() -> None:
    parameters = replace(P, uc_read_ahead_packets=1)
    found = run([between("C1", "C2", 3 * 248)], parameters).end
    read = 248 / SMEM_BYTES_PER_CYCLE + 10
    assert found == pytest.approx(400 + 3 * (read + 64) + 5)


def test_the_uc_fills_a_link_and_no_more() -> None:
    size = 1_000_000
    traffic = run([between("C1", "C16", size)], P)
    flits = sum(flits_of(payload, 2) for payload in payloads(size))
    assert traffic.link_flits["C1", "C2"] == flits
    assert flits < traffic.end < flits + 400 + 10 + 6 * 5 + 64 + 10
    assert size / traffic.end <= 4 * 62 / 64


def test_two_transfers_share_a_link_fairly() -> None:
    alone = run([between("C1", "C3", 100_000)], P).end
    roomy = replace(P, fifo_flits=1e6)
    both = run([between("C1", "C3", 100_000), between("C2", "C3", 100_000)], roomy)
    first, second = (outcome.end for outcome in both.outcomes)
    assert first == pytest.approx(second, rel=0.01)
    assert first == pytest.approx(2 * alone, rel=0.05)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("flow_control", ["none", "credits"])
def test_packets_are_delivered_or_counted_as_lost(seed: int, flow_control: str) -> None:
    draw = random.Random(seed)
    parameters = replace(P, fifo_flits=1000)
    ends = [draw.sample([f"C{n}" for n in range(1, 17)], 2) for _ in range(12)]
    transfers = [between(*pair, draw.randrange(1, 20_000)) for pair in ends]
    traffic = run(transfers, parameters, flow_control)  # type: ignore[arg-type]
    for transfer, outcome in zip(transfers, traffic.outcomes, strict=True):
        assert outcome.sent == len(payloads(transfer.size_bytes))
        assert (outcome.delivered_bytes == transfer.size_bytes) == (outcome.lost == 0)
    assert (traffic.lost_flits > 0) == (traffic.lost_packets > 0)
    if flow_control == "credits":
        assert traffic.lost_packets == 0
        assert traffic.peak_fifo_flits <= parameters.fifo_flits


def packets(*flits: float) -> list[Packet]:
    return [Packet(0, 0, length) for length in flits]


@pytest.mark.parametrize(("capacity", "lost"), [(120, 0), (119.5, 0.5), (100, 20)])
def test_a_fifo_overflows_exactly_when_it_is_exceeded(capacity: float, lost: float) -> None:
    fifo = Fifo(capacity)
    one, other = packets(60, 60)
    fifo.begin_arrival(0, one)
    fifo.end_arrival(60, one)
    fifo.begin_arrival(60, other)
    fifo.end_arrival(120, other)
    assert fifo.front(120) is one
    assert (fifo.lost_flits, fifo.peak_flits) == (lost, min(capacity, 120))
    assert (one.is_damaged, other.is_damaged) == (False, lost > 0)


def test_a_fifo_that_is_emptied_meanwhile_does_not_overflow() -> None:
    fifo = Fifo(60)
    one, other = packets(60, 60)
    fifo.begin_arrival(0, one)
    fifo.end_arrival(60, one)
    fifo.begin_departure(60, one, 60)
    fifo.begin_arrival(60, other)
    fifo.end_departure(120)
    fifo.end_arrival(120, other)
    assert (fifo.lost_flits, fifo.peak_flits) == (0, 60)


def test_a_damaged_packet_gives_its_room_back() -> None:
    fifo = Fifo(100)
    one, other, third = packets(60, 60, 90)
    for start, packet in ((0, one), (60, other)):
        fifo.begin_arrival(start, packet)
        fifo.end_arrival(start + 60, packet)
    fifo.begin_departure(120, one, 60)
    fifo.end_departure(180)
    assert fifo.front(180) is None  # the other one was damaged
    fifo.begin_arrival(180, third)
    fifo.end_arrival(270, third)
    assert fifo.front(270) is third
    assert fifo.lost_flits == 20


def four_into_ddr(size: int = 100_000) -> list[Transfer]:
    return [
        Transfer(routing.shortest(f"C{n + 1}", f"N{n}"), size, "UC", "CC SMEM", "IO DDR")
        for n in range(4)
    ]


SLOW_DDR = replace(P, ddr_bytes_per_s=4.3e9, ddr_scatter_share=0.5)


def test_fifos_overflow_without_flow_control_and_not_with_it() -> None:
    assert run(four_into_ddr(), SLOW_DDR).lost_packets > 0
    controlled = run(four_into_ddr(), SLOW_DDR, "credits")
    assert controlled.lost_packets == 0
    assert [o.delivered_bytes for o in controlled.outcomes] == [100_000] * 4


def test_the_nodes_of_an_io_subsystem_share_the_rate_of_its_ddr() -> None:
    parameters = replace(SLOW_DDR, fifo_flits=1e6)
    traffic = run(four_into_ddr(), parameters)
    bytes_per_cycle = 0.5 * 4.3e9 / parameters.clock_hz
    writing = 400_000 / bytes_per_cycle / (1 - REFRESH_S / REFRESH_INTERVAL_S)
    assert traffic.lost_packets == 0
    assert traffic.end == pytest.approx(writing, rel=0.01)


def test_what_fits_exactly_is_not_lost() -> None:
    roomy = replace(SLOW_DDR, fifo_flits=1e6)
    peak = run(four_into_ddr(5000), roomy).peak_fifo_flits
    assert run(four_into_ddr(5000), replace(SLOW_DDR, fifo_flits=peak)).lost_packets == 0
    assert run(four_into_ddr(5000), replace(SLOW_DDR, fifo_flits=peak - 1)).lost_packets > 0


def test_a_refresh_holds_up_what_meets_it() -> None:
    parameters = Parameters()
    refresh = parameters.cycles(REFRESH_S)
    fast = Memory("IO DDR", parameters, phase=0.5).read(0, 64)
    assert Memory("IO DDR", parameters, phase=0).read(0, 64) == pytest.approx(fast + refresh)
    interval = parameters.cycles(REFRESH_INTERVAL_S)
    size = round(interval * parameters.ddr_bytes_per_s * parameters.cycle_s)
    long = Memory("IO DDR", parameters, phase=0.5).read(0, size)
    assert long == pytest.approx(interval + refresh + parameters.ddr_cycles, rel=1e-3)
    smem = [Memory("IO SMEM", parameters, phase=phase).read(0, 64) for phase in (0, 0.5)]
    assert smem[0] == smem[1]


def test_defaults_are_the_middle_of_their_ranges() -> None:
    low, high = range_of("ddr_cycles")
    assert low < Parameters().ddr_cycles < high
    assert Parameters().ddr_cycles ** 2 == pytest.approx(low * high, rel=1e-3)
    found = list(corners(Parameters(), ("ddr_cycles", "hop_cycles")))
    assert {(p.ddr_cycles, p.hop_cycles) for p in found} == {
        (ddr, hop) for ddr in (low, high) for hop in range_of("hop_cycles")
    }


@pytest.mark.parametrize("case", SETTING.cases, ids=lambda case: case.name)
def test_a_parameter_that_is_left_out_does_not_matter(case: Case) -> None:
    draw = random.Random(1)
    transfer = Transfer(ROUTES[case.route], 5000, case.method, case.source)
    for _ in range(5):
        ranges = {f.name: f.metadata["range"] for f in fields(Parameters) if f.metadata}
        parameters = Parameters(**{name: draw.choice(ends) for name, ends in ranges.items()})
        assert run([transfer], relevant(case, parameters)).end == run([transfer], parameters).end


def test_a_cache_keeps_the_lines_that_were_used_last() -> None:
    cache = Cache(size_bytes=256, ways=2, line_bytes=64)  # two sets
    for address in (0, 60, 128, 0, 256, 0, 128):
        cache.load(address)
    # 0, 128 and 256 share a set: 256 evicts 128, which evicts 256.
    assert cache.misses == 4


def to_memory(transfer: Transfer, **changed: object) -> list[Transfer]:
    return [replace(transfer, **changed)]  # type: ignore[arg-type]


GOOD = between("C1", "C6", 100)


@pytest.mark.parametrize(
    ("transfers", "message"),
    [
        (to_memory(GOOD, size_bytes=0), "transfer of 0 bytes: expected 1 to 2097152"),
        (to_memory(GOOD, size_bytes=MAX_TRANSFER_BYTES + 1), "expected 1 to 2097152"),
        (to_memory(GOOD, route=("C1", "C6")), "no link from C1 to C6"),
        (to_memory(GOOD, route=("C1",)), "needs two nodes"),
        (to_memory(GOOD, source="IO DDR"), "node C1 has no IO DDR"),
        (to_memory(GOOD, destination="IO SMEM"), "node C6 has no IO SMEM"),
        ([GOOD] * 9, "node C1: 9 transfers need a UC, expected at most 8"),
        (to_memory(GOOD, method="Tx") * 257, "node C6: 257 transfers need a Rx"),
    ],
)
def test_what_the_chip_cannot_do_is_an_error(transfers: list[Transfer], message: str) -> None:
    with pytest.raises(ManycoreError, match=message):
        run(transfers, P)


@pytest.mark.parametrize("number", [0, 17])
def test_there_is_no_such_cluster(number: int) -> None:
    with pytest.raises(ManycoreError, match=rf"cluster {number}: expected 1 to 16"):
        topology.cluster(number)


@pytest.mark.parametrize("place", [("N", 4), ("X", 0), ("NS", 0)])
def test_there_is_no_such_io_node(place: tuple[str, int]) -> None:
    with pytest.raises(ManycoreError, match="expected N, S, W or E with 0 to 3"):
        topology.io_node(*place)


def test_credits_need_room_for_a_packet() -> None:
    with pytest.raises(ManycoreError, match="a packet has 27 flits, its share of a FIFO 25"):
        run([GOOD] * 4, replace(P, fifo_flits=100), "credits")
