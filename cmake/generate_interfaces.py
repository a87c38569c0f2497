# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generate C and Python code for the interfaces of one package, with the generators of ROS 2.

Called by ManycoreInterfaces.cmake with the directory of the definitions, the output directory, and
the prefix of the ROS 2 wheels. What was generated from the same input stays as it is: else each
run of CMake would compile all packages again.
"""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path

# The package is not installed yet while it is being built; this module only needs rosidl.
CHECKOUT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(CHECKOUT))


def main() -> None:
    """Generate everything, unless it is there."""
    source, output, prefix = (Path(argument).resolve() for argument in sys.argv[1:4])
    generated = output / "generated" / source.name
    digest = _digest(source, output, prefix)
    if not generated.exists() or generated.read_text() != digest:
        _generate(source, output, prefix)
        generated.parent.mkdir(parents=True, exist_ok=True)
        generated.write_text(digest)


def _digest(source: Path, output: Path, prefix: Path) -> str:
    """Return a hash of all that the output depends on."""
    generators = (Path(__file__).resolve(), CHECKOUT / "rmw_manycore_py/interfaces/generator.py")
    digest = hashlib.sha256(f"{output} {prefix}\0".encode())
    for file in (*generators, *sorted(source.glob("*/*.*"))):
        digest.update(f"{file} {file.stat().st_size}\0".encode() + file.read_bytes())
    # The generators, and the packages whose messages the definitions contain.
    packages = {p.name for path in sys.path for p in Path(path).glob("ros_*.dist-info")}
    digest.update(" ".join(sorted(packages)).encode())
    return digest.hexdigest()


def _generate(source: Path, output: Path, prefix: Path) -> None:
    from rmw_manycore_py.interfaces import generator  # takes seconds: imports all of rosidl

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
