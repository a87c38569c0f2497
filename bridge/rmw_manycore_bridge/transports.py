# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which transports of Fast DDS a process uses that takes the place of an earlier one.

A publisher outside keeps messages in its shared-memory segment until subscribers have read them.
Nothing reads what was sent to a killed process, and Fast DDS (2.14 to 3.6) gives it up only while
its count of free bytes falls short of the next message. The count is a sum over holes: where it
suffices, and no single hole does, each message of that size is dropped without a word, for all
subscribers of this publisher in shared memory. UDP needs no room in the segment.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from pathlib import Path
from xml.sax.saxutils import escape

TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
PROFILES = "FASTRTPS_DEFAULT_PROFILES_FILE"
RANGE, LOCALHOST_ONLY = "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY"
STATIC_PEERS = "ROS_STATIC_PEERS"
NOTICE = (
    "an earlier process of the bridge has ended: this one listens over UDP alone, as publishers "
    "may have no room in shared memory left"
)
# What rmw_fastrtps sets up for LOCALHOST, where it asks for shared memory whatever the variable
# above says: no multicast, and the ports of 32 participants at each peer.
_LOCALHOST_PROFILE = """<?xml version="1.0" encoding="UTF-8" ?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <transport_descriptors>
    <transport_descriptor>
      <transport_id>udp</transport_id>
      <type>UDPv4</type>
      <maxInitialPeersRange>32</maxInitialPeersRange>
    </transport_descriptor>
  </transport_descriptors>
  <participant profile_name="localhost" is_default_profile="true">
    <rtps>
      <builtin>
        <metatrafficUnicastLocatorList><locator><udpv4/></locator></metatrafficUnicastLocatorList>
        <initialPeersList>{peers}</initialPeersList>
      </builtin>
      <userTransports><transport_id>udp</transport_id></userTransports>
      <useBuiltinTransports>false</useBuiltinTransports>
    </rtps>
  </participant>
</profiles>
"""
_PEER = "<locator><udpv4><address>{address}</address></udpv4></locator>"


def avoid_shared_memory(environment: MutableMapping[str, str], profile: Path) -> bool:
    """Have participants that this process makes from now on use UDP; a user's choice stays.

    Return whether it changes anything.

    :param profile: file to write, where Fast DDS needs one.
    """
    if TRANSPORTS in environment or PROFILES in environment:
        return False
    if environment.pop(LOCALHOST_ONLY, "") == "1" or environment.get(RANGE) == "LOCALHOST":
        profile.write_text(_localhost_profile(environment.get(STATIC_PEERS, "")))
        environment[PROFILES] = str(profile)
        environment[RANGE] = "SYSTEM_DEFAULT"  # the profile has the range
    else:
        environment[TRANSPORTS] = "UDPv4"
    return True


def _localhost_profile(static_peers: str) -> str:
    addresses = ["127.0.0.1", *filter(None, static_peers.split(";"))]
    peers = "".join(_PEER.format(address=escape(address)) for address in addresses)
    return _LOCALHOST_PROFILE.format(peers=peers)
