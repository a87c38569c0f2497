# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fast DDS transports of a bridge process that replaces a killed one.

A DDS publisher keeps messages in its shared-memory segment until subscribers have read them. What
was sent to a killed process is never read, and Fast DDS (2.14 to 3.6) reclaims it only while its
count of free bytes is below the size of the next message. That count sums up all holes: if it
suffices and no single hole does, each message of that size is silently dropped for all
shared-memory subscribers of this publisher. UDP needs no room in the segment.
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
    "a previous bridge process has ended: receiving over UDP only, since publishers may have "
    "no shared memory left"
)
# What rmw_fastrtps configures for LOCALHOST, where it requests shared memory regardless of the
# variable above: no multicast, and the ports of 32 participants at each peer.
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
    """Make participants created from now on use UDP, unless the user has chosen transports.

    Return whether anything was changed.

    :param profile: path to write a Fast DDS profile to, if one is needed.
    """
    if TRANSPORTS in environment or PROFILES in environment:
        return False
    if environment.pop(LOCALHOST_ONLY, "") == "1" or environment.get(RANGE) == "LOCALHOST":
        profile.write_text(_localhost_profile(environment.get(STATIC_PEERS, "")))
        environment[PROFILES] = str(profile)
        environment[RANGE] = "SYSTEM_DEFAULT"  # the profile sets the range
    else:
        environment[TRANSPORTS] = "UDPv4"
    return True


def _localhost_profile(static_peers: str) -> str:
    addresses = ["127.0.0.1", *filter(None, static_peers.split(";"))]
    peers = "".join(_PEER.format(address=escape(address)) for address in addresses)
    return _LOCALHOST_PROFILE.format(peers=peers)
