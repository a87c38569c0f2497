# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generate C and Python code for the interfaces of one package, with the generators of ROS 2.

Called by ManycoreInterfaces.cmake with the directory of the definitions, the output directory, and
the prefix of the ROS 2 wheels.
"""

from __future__ import annotations

import sys
from pathlib import Path

# The package is not installed yet while it is being built; this module only needs rosidl.
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from rmw_manycore_py.interfaces import generator


def main() -> None:
    """Generate everything."""
    source, output, prefix = (Path(argument).resolve() for argument in sys.argv[1:4])
    share = prefix / "share"
    request = generator.Request(
        package=source.name,
        source=str(source),
        definitions=sorted(str(f.relative_to(source)) for f in source.glob("*/*.*")),
        output=str(output),
        share=str(share),
        dependencies={d.name: str(d) for d in share.iterdir() if (d / "msg").is_dir()},
    )
    generator.describe(request)
    generator.generate_code(request)
    generator.generate_python(request)
    generator.write_visibility_headers(request)
    (request.place(generator.PYTHON) / "__init__.py").touch()


if __name__ == "__main__":
    main()
