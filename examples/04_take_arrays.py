# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Take the arrays that 03_publish_arrays.py publishes, in another process and another cluster.

    python examples/04_take_arrays.py

Each array is read where the publisher has put it: nothing is copied. It is the publisher's again at
the end of a turn of the loop, so what is kept has to be computed or copied until then.
"""

import numpy as np

from rmw_manycore_py import transport


def main() -> None:
    """Take clouds of points until one is empty."""
    with transport.join(cluster=2) as member:
        subscription = member.subscription("/points", np.float32)
        for message in subscription:
            if message.array.size == 0:
                break
            centre = message.array.mean(axis=0)
            print(f"cloud {message.sequence}: {message.array.shape}, centre {centre.round(1)}")
        print(f"{subscription.lost} clouds were overwritten before they were taken")


if __name__ == "__main__":
    main()
