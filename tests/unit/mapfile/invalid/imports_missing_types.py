# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from no_such_msgs.msg import Word  # noqa: F401
from std_msgs.msg import Strong  # noqa: F401
