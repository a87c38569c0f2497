# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transport without ROS: join a platform, publish and take numpy arrays in shared memory.

```python
import numpy as np
from rmw_manycore_py import transport

with transport.join("demo", cluster=2) as member:
    points = member.subscription("/points", np.float32)
    for message in points:                   # sleeps until there is one
        print(message.array.mean(axis=0))    # in shared memory, without a copy
```

Arrays travel as std_msgs/msg/Float32MultiArray and its sisters, so ROS 2 nodes, `manycore topic`
and the bridge read and write them too. Neither rclpy nor any other part of ROS is loaded.
"""

from rmw_manycore_py.native._transport import Loan, Message
from rmw_manycore_py.transport.errors import (
    MessageInUseError,
    TransportError,
    TransportTimeoutError,
)
from rmw_manycore_py.transport.member import Member, join
from rmw_manycore_py.transport.publisher import Publisher
from rmw_manycore_py.transport.qos import Qos
from rmw_manycore_py.transport.subscription import Subscription

__all__ = [
    "Loan",
    "Member",
    "Message",
    "MessageInUseError",
    "Publisher",
    "Qos",
    "Subscription",
    "TransportError",
    "TransportTimeoutError",
    "join",
]
