"""Write `amalthea_uros/metamodel/facts/` from per-version JSON dumps of the AMALTHEA Ecore files.

Usage: python tools/import_facts.py DIRECTORY-WITH-amalthea-<version>.json [TARGET]

A class (or enumeration) that reads the same in several versions becomes one block; the versions in which a block holds
stand behind `@`. The grammar of the written files is described in `amalthea_uros/metamodel/factfile.py`.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

TARGET = Path(__file__).parent.parent / "amalthea_uros" / "metamodel" / "facts"

#: The first class of each sub-model in the declaration order of the Ecore files.
SUB_MODELS = {
    "CommonElements": "common",
    "BaseObject": "base",
    "Tag": "common",
    "ComponentsModel": "components",
    "ConfigModel": "config",
    "ConstraintsModel": "constraints",
    "EventModel": "events",
    "HWModel": "hw",
    "MappingModel": "mapping",
    "MeasurementModel": "measurement",
    "OSModel": "os",
    "PropertyConstraintsModel": "property_constraints",
    "StimuliModel": "stimuli",
    "SWModel": "sw",
}

#: am2inc's copies of the Ecore files respell the Java literal `0f`; it is one value.
FLOAT_ZERO = {"0f": "0", "0.f": "0"}

Json = dict[str, Any]


def feature_line(name: str, feature: Json) -> str:
    """One feature as a line of a facts file."""
    words = [f"{name:<24}"]
    if "containment" in feature:
        words.append("<>")
    elif "opposite" in feature or "resolveProxies" in feature or feature.get("is_reference"):
        words.append("->")
    words.append(feature["type"].removeprefix("ecore:"))
    multiplicity = f"{feature['lower']}..{'*' if feature['upper'] == -1 else feature['upper']}"
    words += {"0..1": [], "1..1": ["1"], "0..*": ["*"]}.get(multiplicity, [multiplicity])
    if feature.get("derived"):
        words.append("derived")
    elif not feature.get("changeable"):
        words.append("readonly")
    if "opposite" in feature:
        words.append("opposite " + feature["opposite"].split("/")[1])
    if "typeArguments" in feature:
        words.append("of " + " ".join(feature["typeArguments"]))
    if "default" in feature:
        words.append("= " + json.dumps(FLOAT_ZERO.get(feature["default"], feature["default"])))
    return "  " + " ".join(words)


def class_block(cls: Json) -> str:
    """One class as a block of a facts file, without its versions."""
    head = ["class", cls["name"]]
    if cls.get("interface"):
        head.append("interface")
    elif cls.get("abstract"):
        head.append("abstract")
    if cls.get("instanceClass", "").endswith("Map$Entry"):
        head.append("entry")
    if cls.get("supertypes"):
        head.append(": " + " ".join(cls["supertypes"]))
    features = {f["name"]: f for f in cls.get("attributes", [])}
    features |= {f["name"]: f | {"is_reference": True} for f in cls.get("references", [])}
    return "\n".join([" ".join(head), *(feature_line(n, features[n]) for n in cls.get("featureOrder", []))])


def enum_block(enum: Json) -> str:
    """One enumeration as a block of a facts file, without its versions."""
    literals = [literal["literal"] for literal in enum["literals"]]
    return f"enum {enum['name']}\n" + "\n".join(f"  {literal}" for literal in literals)


def datatype_block(datatype: Json) -> str:
    """One restricted number type as a block of a facts file, without its versions."""
    facets = " ".join(f"{k} {v}" for k, v in datatype["facets"].items())
    return f"datatype {datatype['name']} {datatype['instanceClass']} {facets}"


def blocks_of(facts: Json) -> list[tuple[str, str, str]]:
    """All blocks of one version as (file, name, text), in declaration order."""
    module = "base"
    found = []
    for cls in facts["classes"]:
        module = SUB_MODELS.get(cls["name"], module)
        found.append((module, cls["name"], class_block(cls)))
    found += [("types", enum["name"] + " enum", enum_block(enum)) for enum in facts["enums"]]
    found += [("types", datatype["name"], datatype_block(datatype)) for datatype in facts["datatypes"]]
    return found


def version_ranges(present: list[str], versions: list[str]) -> str:
    """The versions of a block as ranges, "" for all."""
    if present == versions:
        return ""
    runs: list[list[str]] = []
    for version in present:
        index = versions.index(version)
        if runs and versions.index(runs[-1][-1]) == index - 1:
            runs[-1].append(version)
        else:
            runs.append([version])
    return " @ " + " ".join(
        f"{run[0]}.." if run[-1] == versions[-1] else run[0] if len(run) == 1 else f"{run[0]}..{run[-1]}" for run in runs
    )


def main(source: Path, target: Path) -> None:
    versions = sorted(
        (path.stem.removeprefix("amalthea-") for path in source.glob("amalthea-*.json")),
        key=lambda version: tuple(map(int, version.split("."))),
    )
    order: dict[tuple[str, str], dict[str, list[str]]] = {}
    for version in reversed(versions):
        for module, name, text in blocks_of(json.loads((source / f"amalthea-{version}.json").read_text())):
            order.setdefault((module, name), {}).setdefault(text, []).insert(0, version)
    files: dict[str, list[str]] = {}
    for (module, _), texts in order.items():
        for text, present in texts.items():
            head, _, body = text.partition("\n")
            block = head + version_ranges(present, versions) + ("\n" + body if body else "")
            files.setdefault(module, []).append(block)
    target.mkdir(parents=True, exist_ok=True)
    for module, found in files.items():
        (target / f"{module}.txt").write_text("\n\n".join(found) + "\n", encoding="utf-8")
    (target / "versions.txt").write_text("\n".join(versions) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else TARGET)
