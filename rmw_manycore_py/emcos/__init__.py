# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transfers of ROS-lite and the thesis between two Python processes: message, session, segment.

```python
from rmw_manycore_py import emcos

with emcos.MessageSender("scan") as sender:          # one process; waits for the other
    sender.send(b"stop", priority=7)                 # False: the pipe is full, counted as dropped

with emcos.MessageReceiver("scan") as receiver:      # another process
    for message in receiver:                         # the highest priority first
        print(message.priority, message.data)
```

The two sides of a transfer find each other by its name, on the platform of their environment;
either may come first. Both must run as the same user on the same machine, in one network namespace.
Neither a platform nor any part of ROS has to run. An end is for one thread at a time.
"""

from rmw_manycore_py.emcos.errors import PeerGoneError
from rmw_manycore_py.emcos.message_receiver import MessageReceiver
from rmw_manycore_py.emcos.message_sender import MessageSender
from rmw_manycore_py.emcos.packets import ALL_PRIORITIES, Message, mask_of
from rmw_manycore_py.emcos.segment_reader import SegmentReader
from rmw_manycore_py.emcos.segment_writer import SegmentWriter
from rmw_manycore_py.emcos.session_receiver import SessionReceiver
from rmw_manycore_py.emcos.session_sender import SessionSender

__all__ = [
    "ALL_PRIORITIES",
    "Message",
    "MessageReceiver",
    "MessageSender",
    "PeerGoneError",
    "SegmentReader",
    "SegmentWriter",
    "SessionReceiver",
    "SessionSender",
    "mask_of",
]
