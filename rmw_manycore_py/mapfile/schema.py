# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""JSON Schema of the mapfile, for editors: `python -m rmw_manycore_py.mapfile.schema`."""

from __future__ import annotations

import json
from typing import Any

from rmw_manycore_py.mapfile.format.model import MapfileSections, PlatformSection
from rmw_manycore_py.mapfile.placing.crossings import CROSSINGS
from rmw_manycore_py.platform.topology import PROFILES

_ID = "https://json-schema.org/draft/2020-12/schema"


def json_schema() -> dict[str, Any]:
    """Return the schema of a mapfile including short forms."""
    schema = MapfileSections.model_json_schema()
    schema |= {"$schema": _ID, "title": "mapfile"}
    properties = schema["properties"]
    reference = f"#/$defs/{PlatformSection.__name__}"
    properties["platform"] = {
        "description": MapfileSections.model_fields["platform"].description,
        "anyOf": [{"enum": list(PROFILES)}, {"$ref": reference}],
    }
    _allow_none_entries(schema["$defs"]["NodeSection"]["properties"])
    return schema


def _allow_none_entries(node: dict[str, Any]) -> None:
    """Allow `none:` for empty entries as in Fig. 8, and param_path as an alias of param_file."""
    empty = {"type": "object", "properties": {"none": {"type": "null"}}, "maxProperties": 1}
    node["param_path"] = dict(node["param_file"])
    for key in ("param_file", "param_path"):
        options = node[key].pop("anyOf")
        node[key]["anyOf"] = [*options, {**empty, "additionalProperties": False}]
    node["respawn"]["anyOf"].insert(0, {"type": "boolean"})
    node["parameters"] = {"anyOf": [node["parameters"], {"const": True}]}
    for key in (*CROSSINGS, "publish", "subscribe"):
        # Types are checked on loading, which also accepts the spellings of ROS 1.
        node[key].pop("propertyNames", None)
        node[key].pop("patternProperties", None)
        node[key]["additionalProperties"] = {"type": ["string", "null"]}


def schema_text() -> str:
    """Return the contents of docs/mapfile.schema.json."""
    return json.dumps(json_schema(), indent=2) + "\n"


if __name__ == "__main__":
    print(schema_text(), end="")
