# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A run as the child of a Python program, which `ActiveRun` is the parent's side of.

Prints, as JSON lines, each event of the run, that all nodes were started
({"event": "up"}), or why there is none ({"error": ...}). It stops at a signal, and once its
standard input ends: with the parent, however that ends.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import reported
from rmw_manycore_py.launch.run import Mode, Run
from rmw_manycore_py.mapfile import load_mapfile, resolve


def main() -> int:
    """Run the mapfile that the first argument names; return the run's exit status."""
    mapfile = Path(sys.argv[1])
    try:
        loaded = load_mapfile(mapfile)
        run = Run(resolve(loaded, to_start=False), Mode(loaded))
        threading.Thread(target=_stop_after_parent, daemon=True).start()
        return run.run(lambda event: _report(event.as_data()), all_started=_come_up)
    except Exception as error:
        known = reported(error)
        if known is None:
            raise
        _report({"error": str(known), "exit_status": known.exit_status})
        return known.exit_status


def _come_up() -> None:
    _report({"event": "up"})


def _report(data: dict[str, Any]) -> None:
    print(json.dumps(data), flush=True)


def _stop_after_parent() -> None:
    while os.read(0, 1):
        pass
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == "__main__":
    sys.exit(main())
