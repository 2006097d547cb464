"""What several tests need: real models, an independent comparison of models."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from amalthea_uros import describe, extract, load
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.metamodel.defaults import defaults_of
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model

ROOT = Path(__file__).parents[1]
SHARED = ROOT.parent / "shared"
DATA = ROOT / "tests" / "data"

#: A model around an excerpt.
MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">{}</am:Amalthea>
"""


def model_text(excerpt: str, version: str = "3.3.0") -> str:
    """The text of a file with an excerpt, in which ` t="Task"` stands for the class of an object, `xsi:type="am:Task"`."""
    return MODEL.format(excerpt.replace(' t="', ' xsi:type="am:')).replace("amalthea/3.3.0", f"amalthea/{version}")


def is_held(version: str) -> bool:
    return not version.startswith("ITEA") and tuple(map(int, version.split("."))) >= (0, 9, 7)


def corpus(*writers: str) -> list[Any]:
    """Published models of the versions held, by writer; a skipped parameter where they are not at hand."""
    inventory = SHARED / "corpus" / "inventory.json"
    if not inventory.exists():
        return [pytest.param(None, marks=pytest.mark.skip("the published models are not at hand"))]
    entries = json.loads(inventory.read_text())
    return [
        pytest.param(SHARED / "corpus" / entry["file"], id=entry["file"])
        for entry in entries
        if is_held(entry["version"]) and entry["wellFormed"] and (not writers or entry["writer"] in writers)
    ]


def hand_written() -> list[Any]:
    """Small models laid out by hand: no ids, no defaults, any order."""
    folder = SHARED / "vectors" / "am2inc"
    if not folder.exists():
        return [pytest.param(None, marks=pytest.mark.skip("the hand-written models are not at hand"))]
    return [pytest.param(path, id=path.name) for path in sorted(folder.glob("*.amxmi")) if path.stat().st_size]


@cache
def analysis_of(path: Path) -> Analysis:
    """The analysis of a description or a model, which several tests look at."""
    return analyze_system(describe(path).system if path.suffix == ".yaml" else extract(load(path)).system)


def meaning(model: Model) -> Any:
    """Everything a model says, as nested tuples; references by the position of their target, defaults like unset."""
    positions = {element: position for position, element in enumerate(model.walk())}
    return tuple(_said(document.root, document.facts_version, positions) for document in model.documents)


def _said(element: Element, version: str, positions: dict[Element, int]) -> Any:
    said = []
    defaults = defaults_of(version, type(element))
    for name, value in sorted(element.__dict__.items()):
        if name.startswith("_") or value is None or value == [] or (name in defaults and value == defaults[name]):
            continue
        values = value if isinstance(value, list) else [value]
        said.append((name, tuple(_value(element, item, version, positions) for item in values)))
    return (type(element).__name__, tuple(said))


def _value(holder: Element, value: Any, version: str, positions: dict[Element, int]) -> Any:
    if not isinstance(value, Element):
        return repr(value)
    if value.container is holder:
        return _said(value, version, positions)
    return positions.get(value, value.unresolved)
