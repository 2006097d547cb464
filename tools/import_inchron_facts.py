"""Write `amalthea_uros/inchron/facts.txt` from a JSON dump of the Ecore file of the INCHRON metamodel.

Usage: python tools/import_inchron_facts.py inchron-root-3.5.0.json [TARGET]

The grammar of the written file is that of `amalthea_uros/metamodel/factfile.py`. Classes have the name of their package in front,
except those of the package `model`, which most objects belong to.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

TARGET = Path(__file__).parent.parent / "amalthea_uros" / "inchron" / "facts.txt"

_KINDS = {"a": "", "c": "<> ", "r": "-> "}


def short(name: str) -> str:
    """A type without the packages that go without saying."""
    return name.removeprefix("ecore:").removeprefix("model.")


def feature_line(feature: dict[str, Any]) -> str:
    """One feature as a line."""
    lower, upper = feature.get("lo", 0), feature.get("hi", 1)
    bounds = {(0, 1): "", (1, 1): " 1", (0, -1): " *"}.get((lower, upper), f" {lower}..{'*' if upper == -1 else upper}")
    line = f"  {feature['n']} {_KINDS[feature['k']]}{short(feature['t'])}{bounds}"
    if feature.get("derived") or feature.get("transient"):
        line += " derived"
    if "opp" in feature:
        line += " opposite " + feature["opp"].rpartition(".")[2]
    return line + (" = " + json.dumps(feature["def"]) if "def" in feature else "")


def blocks(packages: list[dict[str, Any]]) -> list[str]:
    """All declarations."""
    found = []
    for package in packages:
        prefix = short(package["name"] + ".")
        for name, cls in package["classes"].items():
            kind = " abstract" if cls.get("abstract") or cls.get("interface") else ""
            above = " : " + " ".join(map(short, cls["super"])) if cls.get("super") else ""
            found.append("\n".join([f"class {prefix}{name}{kind}{above}", *map(feature_line, cls["f"])]))
        for name, literals in package.get("enums", {}).items():
            found.append("\n".join([f"enum {prefix}{name}", *(f"  {literal}" for literal, _ in literals)]))
    return found


def main(source: Path, target: Path) -> None:
    """Write the file."""
    target.write_text("\n\n".join(blocks(json.loads(source.read_text())["packages"])) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else TARGET)
