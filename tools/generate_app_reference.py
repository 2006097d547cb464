"""Generate `docs/app-yaml-reference`, a page for each part of an app.yaml, from the sections of the package.

Usage: python tools/generate_app_reference.py [TARGET]
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from templating import ROOT

from amalthea_uros.spec.description import json_schema

HEAD = """# All keys of app.yaml

Generated from the JSON Schema that `amuros schema` prints. Keys in **bold** are required. Times, sizes, rates and frequencies have
a unit: `10 ms`, `4 B`, `250 kbit/s`, `50 Hz`.
"""

#: Page -> its title, and the keys of the file whose sections it has.
PAGES = {
    "hardware": ("Keys of the hardware", ("hardware",)),
    "os": ("Keys of the operating system", ("os",)),
    "middleware": ("Keys of the middleware", ("middleware",)),
    "application": ("Keys of the micro-ROS application", ("application",)),
    "host": ("Keys of several controllers, and of the host with ROS 2", ("controllers", "host")),
    "tasks": ("Keys of tasks, ISRs and labels", ("tasks", "isrs", "labels")),
    "chains": ("Keys of chains and requirements", ("chains", "requirements")),
}
#: Where the sections are that several parts have, such as execution times.
SHARED = "tasks"

#: Section -> its name in English, where that is an abbreviation.
TITLES = {"Os": "OS", "Isr": "ISR"}

#: The quantity of a pattern is recognised by its smallest unit.
QUANTITIES = {"ps": "time", "Hz": "frequency", "B/s": "bit rate", "B": "size"}

#: What values are that YAML may take for a number or a text, by the start of their pattern.
OTHER_KINDS = {r"^\S": "text", "^0x": "number or text", "^(?": "number", r"^\s": "time or 0"}


def main(target: Path) -> None:
    schema = json_schema()
    pages = pages_of_sections(schema)
    write(target / "index.md", HEAD, section("The file", schema, schema, pages))
    for page, (title, _) in PAGES.items():
        named = (line for name in order(schema) if pages[name] == page for line in of_definition(name, schema, pages))
        write(target / f"{page}.md", f"# {title}\n", named)


def write(file: Path, head: str, lines: Iterator[str]) -> None:
    """A page of sections."""
    file.write_text("\n".join((head, *lines)).rstrip() + "\n", encoding="utf-8")


def pages_of_sections(schema: dict[str, Any]) -> dict[str, str]:
    """The page of each section: that of the only part which has it, or the one of what several parts have."""
    properties = schema["properties"]
    parts = {key: closure({key: value}, schema) for key, value in properties.items()}
    # A controller of a robot has the sections of a whole description.
    parts["controllers"] = references(properties["controllers"])
    return {
        name: next((page for page, (_, keys) in PAGES.items() if users <= set(keys)), SHARED)
        for name in schema["definitions"]
        for users in ({key for key, names in parts.items() if name in names},)
    }


def closure(start: dict[str, Any], schema: dict[str, Any]) -> list[str]:
    """Names of the sections that properties lead to, in the order of their first use."""
    waiting, seen = references(start), list[str]()
    while waiting:
        name = waiting.pop(0)
        if name not in seen:
            seen.append(name)
            waiting += references(schema["definitions"][name])
    return seen


def order(schema: dict[str, Any]) -> list[str]:
    """Names of all sections in the order of their first use."""
    return closure(schema["properties"], schema)


def references(schema: Any) -> list[str]:
    """The names of the sections that a schema refers to."""
    return [part.partition('"')[0] for part in json.dumps(schema).split("#/definitions/")[1:]]


def of_definition(name: str, schema: dict[str, Any], pages: dict[str, str]) -> Iterator[str]:
    """A section by its name."""
    found = schema["definitions"][name]
    whole = found["anyOf"][-1] if "anyOf" in found else found
    yield from section(name, whole | {"description": found.get("description", "")}, schema, pages)


def section(title: str, schema: dict[str, Any], whole: dict[str, Any], pages: dict[str, str]) -> Iterator[str]:
    """A heading, what it is about, and a table of its keys; a key without a description has that of its section."""
    yield f"## {TITLES.get(title, title)}\n"
    yield f"{schema.get('description', '')}\n"
    yield "| key | value | meaning |"
    yield "|---|---|---|"
    for key, value in schema["properties"].items():
        shown = f"**`{key}`**" if key in schema.get("required", ()) else f"`{key}`"
        behind = next((whole["definitions"][name].get("description", "") for name in references(value)), "")
        yield f"| {shown} | {kind(value, pages)} | {value.get('description') or behind} |"
    yield ""


def kind(schema: dict[str, Any], pages: dict[str, str]) -> str:
    """What kind of value it is, in a word or two."""
    if "allOf" in schema:
        return kind(schema["allOf"][0], pages)
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return f"[{TITLES.get(name, name)}]({pages[name]}.md#{name.lower()})"
    if "anyOf" in schema:
        return " or ".join(kind(item, pages) for item in schema["anyOf"])
    if "enum" in schema:
        return ", ".join(f"`{item}`" for item in schema["enum"])
    if "const" in schema:
        return f"`{schema['const']}`"
    if schema["type"] == ["string"]:
        units = schema["pattern"].rpartition("(")[2].partition(")")[0].split("|")
        return QUANTITIES[units[0]]
    if schema.get("type") == "array":
        return f"list of {kind(schema['items'], pages)}"
    if schema.get("type") == "object":
        (named,) = schema["patternProperties"].values()
        return f"{kind(named, pages)} by name"
    names = {"string": "text", "integer": "number", "number": "number", "boolean": "true, false"}
    return names[schema["type"]] if isinstance(schema["type"], str) else OTHER_KINDS[schema["pattern"][:3]]


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "app-yaml-reference")
