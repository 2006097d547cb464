"""Generate `docs/app-yaml-reference.md` from the sections of the package.

Usage: python tools/generate_app_reference.py [TARGET]
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from templating import ROOT

from amalthea_uros.spec.schema import json_schema

HEAD = """# All keys of app.yaml

Generated from the JSON Schema that `amuros schema` prints. Keys in **bold** are required. Times, sizes, rates and frequencies have
a unit: `10 ms`, `4 B`, `250 kbit/s`, `50 Hz`.
"""

#: The quantity of a pattern is recognised by its smallest unit.
QUANTITIES = {"ps": "time", "Hz": "frequency", "B/s": "bit rate", "B": "size"}

#: What values are that YAML may take for a number or a text, by the start of their pattern.
OTHER_KINDS = {r"^\S": "text", "^0x": "number or text", "^(?": "number", r"^\s": "time or 0"}


def main(target: Path) -> None:
    schema = json_schema()
    named = (line for name in order(schema) for line in of_definition(name, schema))
    parts = [HEAD, *section("The file", schema, schema), *named]
    (target / "app-yaml-reference.md").write_text("\n".join(parts).rstrip() + "\n", encoding="utf-8")


def order(schema: dict[str, Any]) -> Iterator[str]:
    """Names of the sections in the order of their first use."""
    waiting, seen = references(schema["properties"]), set()
    while waiting:
        name = waiting.pop(0)
        if name not in seen:
            seen.add(name)
            yield name
            waiting += references(schema["definitions"][name])


def references(schema: Any) -> list[str]:
    """The names of the sections that a schema refers to."""
    return [part.partition('"')[0] for part in json.dumps(schema).split("#/definitions/")[1:]]


def of_definition(name: str, schema: dict[str, Any]) -> Iterator[str]:
    """A section by its name."""
    found = schema["definitions"][name]
    whole = found["anyOf"][-1] if "anyOf" in found else found
    yield from section(name, whole | {"description": found.get("description", "")}, schema)


def section(title: str, schema: dict[str, Any], whole: dict[str, Any]) -> Iterator[str]:
    """A heading, what it is about, and a table of its keys; a key without a description has that of its section."""
    yield f"## {title}\n"
    yield f"{schema.get('description', '')}\n"
    yield "| key | value | meaning |"
    yield "|---|---|---|"
    for key, value in schema["properties"].items():
        shown = f"**`{key}`**" if key in schema.get("required", ()) else f"`{key}`"
        behind = next((whole["definitions"][name].get("description", "") for name in references(value)), "")
        yield f"| {shown} | {kind(value)} | {value.get('description') or behind} |"
    yield ""


def kind(schema: dict[str, Any]) -> str:
    """What kind of value it is, in a word or two."""
    if "allOf" in schema:
        return kind(schema["allOf"][0])
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "anyOf" in schema:
        return " or ".join(kind(item) for item in schema["anyOf"])
    if "enum" in schema:
        return ", ".join(f"`{item}`" for item in schema["enum"])
    if "const" in schema:
        return f"`{schema['const']}`"
    if schema["type"] == ["string"]:
        units = schema["pattern"].rpartition("(")[2].partition(")")[0].split("|")
        return QUANTITIES[units[0]]
    if schema.get("type") == "array":
        return f"list of {kind(schema['items'])}"
    if schema.get("type") == "object":
        (named,) = schema["patternProperties"].values()
        return f"{kind(named)} by name"
    names = {"string": "text", "integer": "number", "number": "number", "boolean": "true, false"}
    return names[schema["type"]] if isinstance(schema["type"], str) else OTHER_KINDS[schema["pattern"][:3]]


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
