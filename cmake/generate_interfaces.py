# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generate C and Python for the messages and services of one package, with ROS 2's generators.

Called by ManycoreInterfaces.cmake, with the directory of the package's definitions, the directory
for what is generated, and the prefix of the ROS 2 wheels.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import rosidl_generator_c
import rosidl_generator_py
import rosidl_generator_type_description
import rosidl_typesupport_c
import rosidl_typesupport_fastrtps_c
import rosidl_typesupport_introspection_c
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl

# rmw_manycore and Fast DDS serialize with the first; Fast DDS describes types with the second.
TYPE_SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]
CONVERT = {".msg": convert_msg_to_idl, ".srv": convert_srv_to_idl}


class Package:
    """The definitions of one package; what GENERATOR makes goes to OUTPUT/GENERATOR/PACKAGE."""

    def __init__(self, source: Path, output: Path, prefix: Path) -> None:
        self.source = source
        self.output = output
        self.share = prefix / "share"
        self.definitions = sorted(f for f in source.rglob("*.*") if f.suffix in CONVERT)

    def convert(self) -> None:
        """Write an .idl file for each definition, as all generators start from these."""
        for file in self.definitions:
            name = file.relative_to(self.source)
            place = self._place("idl") / name.parent
            CONVERT[file.suffix](self.source, self.source.name, name, place)

    def generate(self) -> None:
        """Run the generators; each wants its arguments in a file."""
        dependencies = [f"{d.name}:{d}" for d in self.share.iterdir() if (d / "msg").is_dir()]
        description = "rosidl_generator_type_description"
        rosidl_generator_type_description.generate_type_hash(
            self._arguments(description, include_paths=dependencies)
        )
        hashes = [
            f"{idl}:{self._place(description) / idl.with_suffix('.json')}" for idl in self._idl()
        ]
        rosidl_generator_c.generate_c(
            self._arguments("rosidl_generator_c", type_description_tuples=hashes)
        )
        fastrtps, introspection = TYPE_SUPPORTS
        rosidl_typesupport_fastrtps_c.generate_typesupport_fastrtps_c(self._arguments(fastrtps))
        rosidl_typesupport_introspection_c.generate_c(self._arguments(introspection))
        rosidl_typesupport_c.generate_c(self._arguments("rosidl_typesupport_c"), TYPE_SUPPORTS)
        rosidl_generator_py.generate_py(
            self._arguments("rosidl_generator_py"), ["rosidl_typesupport_c"]
        )
        (self._place("rosidl_generator_py") / "__init__.py").touch()

    def write_visibility_headers(self) -> None:
        """Write the headers that say what a library exports."""
        for generator in ("rosidl_generator_c", *TYPE_SUPPORTS):
            name = f"{generator}__visibility_control.h"
            text = (self.share / generator / "resource" / f"{name}.in").read_text()
            text = text.replace("@PROJECT_NAME@", self.source.name)
            text = text.replace("@PROJECT_NAME_UPPER@", self.source.name.upper())
            header = self._place(generator) / "msg" / name
            header.parent.mkdir(exist_ok=True)
            header.write_text(text)

    def _place(self, generator: str) -> Path:
        return self.output / generator / self.source.name

    def _idl(self) -> list[Path]:
        return [f.relative_to(self.source).with_suffix(".idl") for f in self.definitions]

    def _arguments(self, generator: str, **more: Any) -> str:
        place = self._place(generator)
        place.mkdir(parents=True, exist_ok=True)
        arguments = {
            "package_name": self.source.name,
            "output_dir": str(place),
            "template_dir": str(self.share / generator / "resource"),
            "idl_tuples": [f"{self._place('idl')}:{idl}" for idl in self._idl()],
            "ros_interface_dependencies": [],
            "target_dependencies": [],
            **more,
        }
        file = place / "arguments.json"
        file.write_text(json.dumps(arguments))
        return str(file)


def main() -> None:
    """Generate everything."""
    package = Package(*(Path(argument).resolve() for argument in sys.argv[1:4]))
    package.convert()
    package.generate()
    package.write_visibility_headers()


if __name__ == "__main__":
    main()
