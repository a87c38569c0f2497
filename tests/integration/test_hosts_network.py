# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Two hosts of one platform in network namespaces: links that go down, and TLS."""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.bench.hosts import ADDRESSES, Host, can_have_hosts, two_hosts
from support import IS_MANYCORE, wait_until
from support.nodes.parted import HEARD, HOSTS, Parted
from support.nodes.speakers import count_up, flood, hear
from support.processes.lossy_cable import lossy_hosts
from support.processes.platforms import leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("zenoh", "xxhash"),
    pytest.mark.skipif(not IS_MANYCORE, reason="hosts are part of rmw_manycore"),
    pytest.mark.skipif(not can_have_hosts(), reason="network namespaces need root"),
]


@pytest.fixture
def both() -> Iterator[tuple[Host, Host]]:
    with two_hosts() as hosts:
        yield hosts


def parted(start: Any, directory: Path, both: tuple[Host, Host], link: str) -> Parted:
    """Return the hosts of a mapfile, one in each namespace."""
    addresses = [f"{link}/{address}:7450" for address in ADDRESSES]
    pairs = (dict(zip(HOSTS, ends, strict=True)) for ends in (addresses, both))
    return Parted(start, directory, *pairs)


def set_link(host: Host, state: str) -> None:
    subprocess.run([*host, "ip", "link", "set", "cable", state], check=True)


@pytest.mark.long
def test_a_link_that_was_down(start, tmp_path, both) -> None:
    """What was published meanwhile counts as lost, also after the other host had vanished."""
    hosts = parted(start, tmp_path, both, "tcp")
    runs = hosts.run_all()
    set_link(both[0], "down")
    runs["b"].wait_for("lost host a; connecting again")
    wait_until(lambda: hosts.row("a", "outward", "/chatter")["state"] == "ready", "it is gone")
    runs["a"].skip_output()
    runs["a"].wait_for("Publishing")  # to none
    runs["b"].skip_output()
    set_link(both[0], "up")
    runs["b"].wait_for(HEARD)
    first, *_, last = map(int, re.findall(r"Hello World: (\d+)", runs["b"].output))
    row = hosts.row("b", "inward", "/chatter")
    assert row["messages"] + row["lost"] > last - first


def test_a_slow_link_costs_counted_messages(start, tmp_path) -> None:
    """The publisher goes on at its pace, 40 times that of the link."""
    with two_hosts("8mbit") as both:
        hosts = parted(start, tmp_path, both, "tcp")
        hosts.run_all()
        hearer, speaker = hosts.node("b", hear, "/much", {}), hosts.node("a", flood, "/much")
        hearer.wait_for("^heard x")
        wait_until(lambda: hosts.row("a", "outward", "/much")["lost"] > 100, "losses are counted")
        assert speaker.is_running()
        hearer.skip_output()
        hearer.wait_for("^heard x")


@pytest.mark.skipif(not os.path.exists("/dev/net/tun"), reason="needs network devices of a process")
def test_a_link_with_delay_and_loss(start, tmp_path) -> None:
    """Reliable messages stay in order, and each that does not arrive is counted."""
    with lossy_hosts(delay_s=0.02, loss=0.02) as both:
        hosts = parted(start, tmp_path, both, "tcp")
        hosts.run_all()
        kept = {"depth": 1000}
        hearer = hosts.node("b", hear, "/numbers", kept)
        hearer.wait_for("^listening$")
        hosts.node("a", count_up, "/numbers", kept, 0.005)
        hearer.wait_for("^heard 1000 ")
        heard = [int(number) for number in re.findall(r"^heard (\d+) ", hearer.output, re.M)]
        assert heard == sorted({*heard})
        rows = hosts.row("a", "outward", "/numbers"), hosts.row("b", "inward", "/numbers")
        assert len(heard) + sum(row["lost"] for row in rows) > heard[-1] - heard[0]


def certificates(directory: Path) -> Path:
    """Make an authority and one certificate for both hosts; return zenoh's configuration.

    It names its files relative to it.
    """

    def openssl(*words: str) -> None:
        subprocess.run(["openssl", *words], check=True, capture_output=True, cwd=directory)

    key = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-subj")
    openssl("req", "-x509", *key, "/CN=authority", "-keyout", "ca.key", "-out", "ca.pem")
    openssl("req", *key, "/CN=host", "-keyout", "host.key", "-out", "host.csr")
    names = ",".join(f"IP:{address}" for address in ADDRESSES)
    (directory / "names").write_text(f"subjectAltName={names}\n")
    signed_by = ("-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial", "-extfile", "names")
    openssl("x509", "-req", "-in", "host.csr", *signed_by, "-out", "host.pem")
    pair = {"certificate": "host.pem", "private_key": "host.key"}
    tls = {
        "root_ca_certificate": "ca.pem",
        "enable_mtls": True,
        **{f"{side}_{part}": file for side in ("listen", "connect") for part, file in pair.items()},
    }
    config = directory / "zenoh.json5"
    config.write_text(json.dumps({"transport": {"link": {"tls": tls}}}))
    return config


@pytest.mark.needs("openssl")
def test_topics_over_tls(start, tmp_path, both) -> None:
    hosts = parted(start, tmp_path, both, "tls")
    hosts.run_all(ZENOH_SESSION_CONFIG_URI=str(certificates(tmp_path)))
    assert hosts.row("b", "inward", "/chatter")["lost"] == 0


@pytest.mark.needs("openssl")
def test_a_certificate_that_is_missing(start, tmp_path, both) -> None:
    hosts = parted(start, tmp_path, both, "tls")
    config = certificates(tmp_path)
    (tmp_path / "host.pem").unlink()
    run = hosts.run("a", ZENOH_SESSION_CONFIG_URI=str(config))
    run.wait_for(f"{config}: transport/link/tls/listen_certificate: there is no file {tmp_path}")


def test_hosts_with_their_own_processes_and_memory(start, tmp_path, both) -> None:
    """Each has its process numbers, System V IPC and /dev/shm, as two machines."""
    unshare = ["unshare", "--pid", "--ipc", "--mount", "--fork", "--kill-child", "--mount-proc"]
    own_memory = ["sh", "-c", 'mount -t tmpfs tmpfs /dev/shm && exec "$@"', "sh"]
    apart = [[*host, *unshare, *own_memory] for host in both]
    hosts = parted(start, tmp_path, (apart[0], apart[1]), "tcp")
    hosts.run_all(MANYCORE_DIRECTORY="")
    assert not any(leftovers(name) for name in hosts.platforms.values())
