# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Keys, tokens, QoS and attachments of rmw_zenoh, byte by byte."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rmw_manycore_bridge.zenoh.attachment import Attachment, pack, unpack
from rmw_manycore_bridge.zenoh.keys import (
    Token,
    TokenError,
    any_key,
    data_key,
    graph_key,
    parse_token,
)
from rmw_manycore_bridge.zenoh.qos import decode, encode
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.ros.qos import policies_of

pytestmark = [pytest.mark.unit, pytest.mark.needs("zenoh", "xxhash")]

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
GID = bytes(range(16))
ATTACHMENT = (
    "0700000000000000"  # number 7
    "15cd5b0700000000"  # 123456789 ns
    "10000102030405060708090a0b0c0d0e0f"  # 16 bytes of gid
)
# rmw_zenoh before 0.2.4: each value behind its label.
OLD_ATTACHMENT = (
    "0f73657175656e63655f6e756d6265720700000000000000"
    "10736f757263655f74696d657374616d7015cd5b0700000000"
    "0a736f757263655f67696410000102030405060708090a0b0c0d0e0f"
)
# Of a talker of demo_nodes_cpp in a namespace, as reported in rmw_zenoh's issue 643.
PARAMETER_EVENTS = (
    "@ros2_lv/0/999bf91283606d2068c7524e5badfa6c/0/8/MP/%/%robot1/talker/%parameter_events/"
    "rcl_interfaces::msg::dds_::ParameterEvent_/"
    "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204/::,1000:,:,:,,"
)
ROSOUT_QOS = ":1:,1000:,:10,0:,,"


def test_data_keys() -> None:
    key = data_key(0, "/robot/chatter", "std_msgs/msg/String", STRING_HASH)
    assert key == f"0/robot/chatter/std_msgs::msg::dds_::String_/{STRING_HASH}"
    assert any_key(3, "/robot/chatter") == "3/robot/chatter/*/*"
    goal = data_key(0, "/fib/_action/send_goal", "p/action/Fib_SendGoal", "h")
    assert goal == "0/fib/_action/send_goal/p::action::dds_::Fib_SendGoal_/h"
    assert graph_key(3) == "@ros2_lv/3/**"


def test_the_token_of_a_talker() -> None:
    token = parse_token(PARAMETER_EVENTS)
    assert (token.domain, token.node_id, token.entity_id, token.kind) == (0, 0, 8, "MP")
    assert token.full_node_name == "/robot1/talker"
    assert (token.name, token.type) == ("/parameter_events", "rcl_interfaces/msg/ParameterEvent")
    assert token.text == PARAMETER_EVENTS
    assert parse_token(f"{PARAMETER_EVENTS}/backends:cpu") == token


def test_a_token_between_hosts_has_the_gid_of_the_publisher() -> None:
    token = replace(parse_token(PARAMETER_EVENTS), source=bytes(range(16)))
    assert token.text == f"{PARAMETER_EVENTS}/000102030405060708090a0b0c0d0e0f"
    assert parse_token(token.text) == token


def test_the_token_of_a_node() -> None:
    token = Token(0, "aac3178e146ba6f1fc6e6a4085e77f21", 0, 0, "NN", "/", "listener")
    text = "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/0/NN/%/%/listener"
    assert token.text == text
    assert parse_token(text) == token


def test_the_gid_is_the_hash_of_the_token() -> None:
    # XXH3 with 128 bits of the text, low half first.
    gid = "2bb0d90d83ccad599ffc51b414c97d0c"
    assert parse_token(PARAMETER_EVENTS).gid.hex() == gid


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("@ros2_lv/0/abc", "at least 8 parts more"),
        ("@ros2_lv/0/a/0/1/XX/%/%/n", "one of NN, MP, MS, SS, SC as the 6th part"),
        ("@ros2_lv/0/a/0/1/MP/%/%/n/%t/type/hash/qos", "a type such as std_msgs::msg"),
        ("@ros2_lv/0/a/0/1/MP/%/%/n/%t/..::..::dds_::x_/hash/qos", "a type such as"),
        ("@ros2_lv/0/a/0/1/MP/%/%/n/%t/type", "at least 13 parts, found 11"),
        ("@ros2_lv/0/a/b/1/NN/%/%/n", "numbers of domain, node and entity"),
    ],
)
def test_unknown_tokens(text: str, problem: str) -> None:
    with pytest.raises(TokenError, match=problem):
        parse_token(text)


@pytest.mark.parametrize(
    ("qos", "text"),
    [
        (Qos(), "::,10:,:,:,,"),
        (Qos(depth=42), "::,:,:,:,,"),
        (Qos(reliability="best_effort", depth=5), "2::,5:,:,:,,"),
        (Qos(durability="transient_local", depth=1000, lifespan_ns=10**10), ROSOUT_QOS),
        (Qos(deadline_ns=1_500_000_000), "::,10:1,500000000:,:,,"),
        (Qos(liveliness="manual_by_topic", liveliness_lease_ns=10**9), "::,10:,:,:3,1,0"),
    ],
)
def test_qos(qos: Qos, text: str) -> None:
    assert encode(qos) == text
    assert policies_of(decode(text)) == policies_of(qos)


def test_qos_as_peers_may_write_it() -> None:
    assert encode(Qos(history="keep_all")) == "::2,:,:,:,,"
    assert decode(f"::,{10**30}:,:,:,,").depth == 1 << 20
    infinite = "9223372036,854775807"
    assert policies_of(decode(f"1:2:1,10:{infinite}:{infinite}:1,{infinite}")) == policies_of(Qos())
    for text in ("", "::,10:,:,", "7::,10:,:,:,,", "::,x:,:,:,,"):
        with pytest.raises(ValueError, match=r"unknown policy|unpack|invalid literal"):
            decode(text)


def test_attachments() -> None:
    assert pack(7, 123456789, GID).hex() == ATTACHMENT
    assert unpack(bytes.fromhex(ATTACHMENT)) == Attachment(7, 123456789, GID)
    assert unpack(bytes.fromhex(OLD_ATTACHMENT)) == Attachment(7, 123456789, GID, is_old=True)
    negative = pack(-1, 0, GID), pack(0, -1, GID)
    for data in (b"", bytes(33), bytes(77), bytes.fromhex(ATTACHMENT)[:-1], *negative):
        assert unpack(data) is None


def test_attachments_are_what_zenoh_serializes() -> None:
    from zenoh.ext import Int64, z_serialize

    values = (Int64(7), Int64(123456789), GID)
    assert z_serialize(values).to_bytes() == pack(*values)
