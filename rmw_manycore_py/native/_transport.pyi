# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transport without ROS: platforms seen, configured and joined."""

from collections.abc import Callable, Mapping, Sequence
from types import TracebackType
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Buffer, Self

from rmw_manycore_py.native.enums import (
    Durability,
    EndpointKind,
    EndpointRole,
    History,
    Liveliness,
    Reliability,
    Transfer,
    WaitMode,
    ZeroCopy,
)

Scalar = TypeVar("Scalar", bound=np.number[Any])

class PlatformError(RuntimeError):
    """Something is wrong with a platform; the message says what to do."""

class PlatformInUseError(PlatformError):
    """The platform has living processes; the message names those that are visible."""

class Qos:
    """The policies of an endpoint. Durations in nanoseconds, None = no limit."""

    def __init__(
        self,
        *,
        reliability: Reliability = "reliable",
        durability: Durability = "volatile",
        history: History = "keep_last",
        depth: int = 10,
        deadline_ns: int | None = None,
        lifespan_ns: int | None = None,
        liveliness: Liveliness = "automatic",
        liveliness_lease_ns: int | None = None,
    ) -> None: ...
    @property
    def reliability(self) -> Reliability: ...
    @property
    def durability(self) -> Durability: ...
    @property
    def history(self) -> History: ...
    @property
    def depth(self) -> int:
        """Messages kept, at least 1; for `keep_last`."""

    @property
    def deadline_ns(self) -> int | None: ...
    @property
    def lifespan_ns(self) -> int | None: ...
    @property
    def liveliness(self) -> Liveliness: ...
    @property
    def liveliness_lease_ns(self) -> int | None: ...

class PlatformInfo:
    """The shape of a platform, fixed when it was created."""

    @property
    def name(self) -> str: ...
    @property
    def clusters(self) -> int:
        """Number of clusters."""

    @property
    def cores_per_cluster(self) -> int: ...
    @property
    def smem_bytes(self) -> int:
        """Local memory of each cluster."""

    @property
    def alive(self) -> bool:
        """Whether a process, a receive thread or the configurator lives."""

class ProcessInfo:
    """A member process of a platform."""

    @property
    def slot(self) -> int:
        """Place in the registry; nodes and endpoints name their process by it."""

    @property
    def pid(self) -> int: ...
    @property
    def cluster(self) -> int:
        """Counted from 1."""

    @property
    def core(self) -> int | None:
        """Counted from 0 in its cluster; None = not placed on a core."""

    @property
    def host_cpu(self) -> int | None:
        """None = not pinned."""

    @property
    def label(self) -> str:
        """What the tools call it."""

    @property
    def alive(self) -> bool: ...

class Death:
    """A process that ended though nothing had told it to: it was killed, or crashed."""

    @property
    def pid(self) -> int: ...
    @property
    def process(self) -> int:
        """The slot it had."""

    @property
    def found_ns(self) -> int:
        """When it was reaped, on the monotonic clock."""

class ClusterInfo:
    """A cluster whose segment exists, and what its receive thread has done."""

    @property
    def id(self) -> int:
        """Counted from 1."""

    @property
    def smem_bytes(self) -> int: ...
    @property
    def used_bytes(self) -> int:
        """Of `smem_bytes`."""

    @property
    def charged_bytes(self) -> int:
        """Of `used_bytes`: memory of processes outside the segment."""

    @property
    def receive_thread_pid(self) -> int: ...
    @property
    def messages(self) -> int:
        """Number of eMCOS messages handled."""

    @property
    def notifications(self) -> int:
        """Number of entries that the receive thread put into subscriber queues."""

    @property
    def alive(self) -> bool:
        """Whether the receive thread lives."""

class NodeInfo:
    """A node of a member process."""

    @property
    def handle(self) -> int: ...
    @property
    def process(self) -> int:
        """Slot of its process."""

    @property
    def name(self) -> str: ...
    @property
    def namespace(self) -> str: ...
    @property
    def enclave(self) -> str: ...

class CounterValues:
    """Numbers of messages that an endpoint has seen so far."""

    @property
    def messages(self) -> int:
        """Published or taken."""

    @property
    def bytes(self) -> int:
        """Size of their serialized data."""

    @property
    def lost(self) -> int:
        """Subscription: gone before they were taken."""

    @property
    def superseded(self) -> int:
        """Subscription with KEEP_LAST 1: a newer one was found in their place."""

    @property
    def expired(self) -> int:
        """Subscription: older than their lifespan when their turn came."""

    @property
    def refused(self) -> int:
        """Publisher: did not fit."""

    @property
    def overwritten(self) -> int:
        """Publisher: recycled while a reader still wanted them."""

    @property
    def dropped(self) -> int:
        """Publisher: records that did not reach a cluster they were transferred to."""

    @property
    def in_place(self) -> int:
        """Written or read where their record lies, without a copy."""

class EndpointInfo:
    """A publisher or subscription of a topic, or of a service's requests or replies."""

    @property
    def kind(self) -> EndpointKind: ...
    @property
    def role(self) -> EndpointRole: ...
    @property
    def topic(self) -> str:
        """Full name; for requests and replies the service's name."""

    @property
    def type(self) -> str:
        """As "std_msgs/msg/String"; for requests and replies the service's type."""

    @property
    def type_hash(self) -> str:
        """As "RIHS01_" and 64 hexadecimal digits (REP 2011)."""

    @property
    def id(self) -> int:
        """Unique on its platform."""

    @property
    def gid(self) -> bytes:
        """16 bytes; a publisher that stands for one of another host has that one's."""

    @property
    def node_name(self) -> str: ...
    @property
    def node_namespace(self) -> str: ...
    @property
    def cluster(self) -> int: ...
    @property
    def process(self) -> int:
        """Slot of its process."""

    @property
    def qos(self) -> Qos: ...
    @property
    def matched(self) -> int:
        """Number of endpoints it is matched with now."""

    @property
    def counters(self) -> CounterValues: ...
    @property
    def held_bytes(self) -> int:
        """SMEM of large records that readers hold.

        Publisher: of its own. Subscription: of its topic, by its process.
        """

    @property
    def transfer(self) -> Transfer: ...

class TopicConfiguration:
    """A row of the topic table: the topic DSM of a topic with a fixed size."""

    def __init__(
        self,
        name: str,
        *,
        id: int,
        dsm_size_bytes: int,
        receiver_clusters: int,
        transfer: Transfer = "dsm",
        priority: int = 0,
        synchronous: bool = False,
        zero_copy: ZeroCopy = "unset",
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def id(self) -> int: ...
    @property
    def dsm_size_bytes(self) -> int:
        """0 = starts small and grows."""

    @property
    def receiver_clusters(self) -> int:
        """Bit mask: bit c - 1 = cluster c."""

    @property
    def transfer(self) -> Transfer: ...
    @property
    def priority(self) -> int:
        """Of messages: 0 to 7."""

    @property
    def synchronous(self) -> bool:
        """Messages: publishing waits until the receiving clusters have the message."""

    @property
    def zero_copy(self) -> ZeroCopy:
        """How its large messages are read."""

def now_ns() -> int:
    """Return the clock of timeouts [ns]: CLOCK_MONOTONIC, or virtual time in a run that has it."""

def exit_after(delay_s: float, status: int) -> None:
    """End this process after a time, if it has not ended by then, as os._exit() does.

    Also while a call into a library keeps all Python threads waiting.
    """

virtual_now_offset: int
"""Where the virtual time [ns], 64 bits, is in the timekeeper's page."""

virtual_start_ns: int
"""Virtual time at the begin of a run."""

def platforms() -> list[str]:
    """Return the names of this user's platforms, dead or alive."""

def platform_directory(name: str) -> str:
    """Return the directory that holds all files of a platform."""

def platforms_place() -> str:
    """Return an existing directory on the file system of this user's platforms."""

def clean(name: str, force: bool = False) -> list[str]:
    """Remove what a dead platform left and return the paths; PlatformInUseError while it lives.

    :param force: do not believe its lifelines, only the visible processes that use its files.
    """

class OwnTracer:
    """Notes what this process does beside its nodes, while its platform traces it.

    Times are those of CLOCK_MONOTONIC. PlatformError where the process has no node yet.
    """

    def __init__(self, platform: str) -> None: ...
    @property
    def is_on(self) -> bool: ...
    def resume(self, tid: int, at_ns: int) -> None:
        """Note that this thread goes on with what another one did at a time, in a callback."""

    def align(self, begin_ns: int, end_ns: int) -> None:
        """Note that a scan was matched."""

    def run_pass(self, begin_ns: int, end_ns: int, worker: int, number: int) -> None:
        """Note a worker's share of a pass."""

def charge_smem(platform: str, size_bytes: int) -> None:
    """Count `size_bytes` of this process, outside the segment, as SMEM of its cluster.

    They replace what it had counted before, and end with it; PlatformError where there is no room.
    """

class Configurator:
    """Creates a platform before its first node, and keeps it until closed.

    `smem_bytes` is for each cluster, 0 = this machine's. `close` removes the platform unless
    processes are still on it.
    """

    def __init__(
        self,
        name: str,
        *,
        clusters: int,
        cores_per_cluster: int,
        smem_bytes: int,
        host_cpu_of_receive_thread: Mapping[int, int],
        topics: Sequence[TopicConfiguration],
        priority_of_receive_thread: Mapping[int, int] = ...,
        numa_node_of_cluster: Mapping[int, int] = ...,
    ) -> None: ...
    def close(self) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...

class Platform:
    """A view of a platform: does not join it, and does not keep it alive."""

    def __init__(self, name: str) -> None: ...
    def info(self) -> PlatformInfo: ...
    def processes(self) -> list[ProcessInfo]: ...
    def clusters(self) -> list[ClusterInfo]: ...
    def nodes(self) -> list[NodeInfo]: ...
    def endpoints(self) -> list[EndpointInfo]: ...
    def graph_generation(self) -> int:
        """Return a number that changes when a node or endpoint comes or goes."""

    def activity(self) -> bytes:
        """Return what changes with every message, endpoint by endpoint: rows of 13 uint64.

        Endpoint (its id), the eight of CounterValues; of subscriptions entries in the queue,
        entries that it can hold, deadlines missed; `EndpointInfo.held_bytes`.
        """

    def deaths(self) -> list[Death]:
        """Return the latest 1,024 deaths of processes, oldest first."""

    def is_current(self) -> bool:
        """Tell whether the platform's files are still those that are looked at."""

    def topic_table(self) -> list[TopicConfiguration]: ...
    def close(self) -> None:
        """Unmap the registry; the rows stay valid."""

    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...

class Loan(Generic[Scalar]):
    """A message in the making, in shared memory; it is published at the end of its `with` block.

    An exception inside of the block gives the room back, and nothing is published. Until then the
    publisher can publish and lend further messages.
    """

    def __buffer__(self, flags: int, /) -> memoryview: ...
    @property
    def sequence(self) -> int | None:
        """Sequence number of the published message, from 1; None before."""

    @property
    def array(self) -> NDArray[Scalar]:
        """The array in shared memory: writable, C-contiguous, aligned, not cleared.

        It must not outlive the `with` block.

        :raises TransportError: if the message was published or given back.
        """

    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...

class Publisher:
    """Publishes serialized messages."""

    @property
    def gid(self) -> bytes:
        """What subscriptions know it by, 16 bytes."""

    def publish(
        self,
        data: bytes,
        source_timestamp_ns: int | None = None,
        client: bytes | None = None,
        number: int = 0,
    ) -> int:
        """Publish and return the sequence number; the time is now where none is given.

        Requests and replies carry the client, by the gid of its reply subscription, and the
        client's number of the request; a reply reaches that client only.
        """

    def publish_from(self, address: int, size: int, source_timestamp_ns: int | None = None) -> int:
        """Publish `size` bytes of this process's memory."""

    def publish_parts(self, head: bytes, body: Buffer) -> int:
        """Publish a message of two parts, the second contiguous; return its sequence number."""

    def lend(
        self, head: bytes, body_bytes: int, shape: tuple[int, ...], dtype: np.dtype[Scalar]
    ) -> Loan[Scalar] | None:
        """Lend room for a message; None where the topic's records lie in a ring of fixed size."""

    def matched(self) -> int:
        """Return the number of subscriptions it is matched with."""

    def close(self) -> None:
        """Close the publisher; whatever is done with it later is a ValueError."""

class Message(Generic[Scalar]):
    """A message in shared memory, released at the end of its `with` block.

    Until then its publisher does not overwrite it, however many messages it publishes. A
    subscription has one at a time. What views its memory through the buffer protocol, as arrays and
    `memoryview(message)` do, keeps it from being released.
    """

    def __buffer__(self, flags: int, /) -> memoryview: ...
    @property
    def array(self) -> NDArray[Scalar]:
        """The array in shared memory: read-only, with the publisher's shape, C-contiguous.

        It must not outlive the message; use `copy()` to keep it. Elements of 8 bytes are not
        aligned in CDR: numpy handles them a little more slowly.

        :raises TransportError: if the message was released, or is not an array of this type.
        """

    def copy(self) -> NDArray[Scalar]:
        """Return a copy of the array, writable and aligned.

        :raises TransportError: as `array` does.
        """

    @property
    def sequence(self) -> int:
        """Sequence number of its publisher, from 1."""

    @property
    def source_timestamp_ns(self) -> int:
        """Time of publication [ns since 1970, CLOCK_REALTIME]."""

    @property
    def publisher(self) -> bytes:
        """GID of its publisher, 16 bytes."""

    # Of the record:
    @property
    def address(self) -> int: ...
    @property
    def size(self) -> int: ...
    @property
    def data(self) -> bytes: ...
    @property
    def client(self) -> bytes:
        """Request or reply: gid of the client's reply subscription."""

    @property
    def number(self) -> int:
        """Request or reply: the client's number of the request."""

    def release(self) -> None:
        """Release the message's memory to its publisher; idempotent.

        :raises MessageInUseError: if an array still refers to that memory; it is then released
            with the last such array.
        """

    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...

class Subscription:
    """Takes serialized messages."""

    @property
    def gid(self) -> bytes:
        """Names a client where it is the subscription of its replies, 16 bytes."""

    def read_arrays(self, dtype: np.dtype[Any], layout_of: Callable[..., Any]) -> None:
        """Its messages are arrays; `layout_of` reads their heads, see `multi_array`."""

    def claim(self) -> Message[Any] | None:
        """Return the next record without a copy; BufferError before the last one is released."""

    def note_bridged(self) -> None:
        """Note, for traces, that the claimed message was published outside."""

    def has_data(self) -> bool: ...
    def matched(self) -> int:
        """Return the number of publishers it is matched with."""

    def lost(self) -> int:
        """Return the number of messages that were gone before they were taken."""

    def superseded(self) -> int:
        """Return the number of messages in whose place a newer one was found."""

    def close(self) -> None:
        """Close the subscription; later calls raise ValueError. A claim stays valid."""

class Node:
    """A further node of a process, in the graph until this object is gone."""

class Process:
    """A member of a platform without ROS, with one node named after its label.

    It leaves the platform once it is closed and its nodes, publishers and subscriptions are gone.
    """

    def __init__(
        self,
        platform: str,
        cluster: int = 1,
        core: int | None = None,
        label: str = "tool",
        wait: WaitMode = "block",
    ) -> None: ...
    def node(self, name: str, namespace: str) -> Node:
        """Add a node."""

    def nodes(self) -> list[NodeInfo]:
        """Return the nodes of all processes."""

    def publisher(
        self,
        topic: str,
        type: str,
        qos: Qos,
        role: EndpointRole = "topic",
        type_hash: str = "",
        node: Node | None = None,
        gid: bytes | None = None,
    ) -> Publisher:
        """Return a publisher of a topic, or of a service's requests or replies (its role).

        :param node: whose it is, for as long as that lives; by default the process's first.
        :param gid: of the other host's publisher that it stands for.
        """

    def subscription(
        self, topic: str, type: str, qos: Qos, role: EndpointRole = "topic", type_hash: str = ""
    ) -> Subscription:
        """Return a subscription of a topic, or of a service's requests or replies (its role)."""

    def endpoints(self) -> list[EndpointInfo]:
        """Return all endpoints, with 0 for `held_bytes`, which takes long to find."""

    def endpoints_of(self, topic: str) -> list[EndpointInfo]:
        """Return the endpoints of one topic or service, likewise."""

    def graph_generation(self) -> int:
        """Return a number that changes when a node or endpoint comes or goes."""

    def watch_graph(self) -> None:
        """Have changes of the graph end `wait` too, from now on."""

    def epoch(self) -> int:
        """Return a number that changes when something comes in."""

    def wait(self, seen: int, timeout_s: float | None = None) -> bool:
        """Sleep until the epoch is another than `seen`; False when the time is over.

        Raises what a signal handler raises, as KeyboardInterrupt.
        """

    def require_membership(self) -> None:
        """Raise PlatformError in a child of fork(), and once the platform was taken away."""

    def notify(self) -> None:
        """Wake the thread that waits."""

    def close(self) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...

class TraceName:
    """What an endpoint was called when its first event was recorded."""

    @property
    def slot(self) -> int: ...
    @property
    def incarnation(self) -> int: ...
    @property
    def process(self) -> int: ...
    @property
    def cluster(self) -> int: ...
    @property
    def is_publisher(self) -> bool: ...
    @property
    def role(self) -> int:
        """0 = topic, 1 = request, 2 = reply."""

    @property
    def topic(self) -> str: ...
    @property
    def type(self) -> str: ...
    @property
    def node(self) -> str:
        """Its full name."""

class ThreadTrace:
    """What one thread recorded."""

    @property
    def tid(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def events(self) -> bytes:
        """Of 32 bytes each, oldest first."""

    @property
    def lost(self) -> int:
        """Number of further events, for which there was no room."""

class ProcessTrace:
    """What one process recorded."""

    @property
    def cluster(self) -> int: ...
    @property
    def process(self) -> int | None:
        """Its slot; None = a receive thread."""

    @property
    def pid(self) -> int: ...
    @property
    def core(self) -> int:
        """-1 = not placed on a core."""

    @property
    def host_cpu(self) -> int:
        """-1 = not pinned."""

    @property
    def label(self) -> str: ...
    @property
    def alive(self) -> bool: ...
    @property
    def threads(self) -> list[ThreadTrace]: ...
    @property
    def names(self) -> list[TraceName]: ...
    @property
    def unplaced(self) -> int:
        """Number of lost events of threads that had no room at all."""

class TraceState:
    """Whether a platform is traced, and what waits to be saved."""

    @property
    def started_ns(self) -> int:
        """On the monotonic clock; 0 = nothing is traced."""

    @property
    def clusters(self) -> list[int]: ...
    @property
    def nodes(self) -> list[str]: ...
    @property
    def ring_events(self) -> int: ...
    @property
    def pending(self) -> int:
        """Number of events that were not saved yet."""

    @property
    def lost(self) -> int: ...

class TraceSaver:
    """What was recorded and not saved yet; one at a time."""

    def __init__(self, platform: str) -> None: ...
    @property
    def processes(self) -> list[ProcessTrace]: ...
    @property
    def unplaced(self) -> int:
        """Number of lost events of processes that had no room at all."""

    def finish(self) -> None:
        """Give the room of what was found back, now that it is saved."""

    def close(self) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...

def start_trace(
    platform: str,
    *,
    clusters: Sequence[int],
    nodes: Sequence[str],
    events: int,
    discard: bool,
) -> None:
    """Record from now on; PlatformError while a trace is on, or one was not saved."""

def stop_trace(platform: str) -> None:
    """Record no more; PlatformError where nothing is recorded."""

def trace_state(platform: str) -> TraceState: ...
