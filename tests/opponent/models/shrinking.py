"""Smaller models of which the same is said falsely."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from xml.etree import ElementTree

from opponent.models.generator import RandomModel
from opponent.models.reading import references

#: What is tried to be left out, with whatever refers to it; the rest of a model says how these are understood.
_PARTS = {
    "items", "entries", "defaultEntry", "tasks", "isrs", "runnables", "stimuli", "events", "executionCondition", "setModeValueList",
    "counter", "labels", "channels", "modeLabels", "jitter", "minDistance", "offset", "computationItems", "osOverheads", "eventChains",
}  # fmt: skip


_QUANTITIES = (
    "response_time", "response time", "start_to_start", "end_to_end", "end_to_start", "activate_to_activate", "initial_pending_time",
    "gross_execution_time", "running_time", "negative", "played in", "is above", "analysis", "simulation",
)  # fmt: skip


def kind_of(text: str) -> str:
    """What false answers of the same kind have in common: who shows it, about what, and whether a limit is met."""
    who = "simulation" if text.startswith("simulated") else "play"
    delay = re.search(r"T\d+ (start|terminate) T\d+ (start|terminate)", text)
    quantity = next((name for name in _QUANTITIES if name in text), "chain" if "chain" in text else "something else")
    side = "low" if " low" in text or "at least" in text or "min_" in text else "up"
    return f"{who}: {'delay' if delay else quantity} {side}, {'a limit is met' if ' met' in text else 'beyond a bound'}"


def shrunk(model: RandomModel, false: Callable[[RandomModel], list[str]], wanted: str) -> RandomModel:
    """The smallest model found about which something of the same kind is said."""

    def still(candidate: RandomModel) -> bool:
        try:
            return any(kind_of(text) == wanted for text in false(candidate))
        except Exception:  # whatever it is, it is no smaller model
            return False

    is_smaller = True
    while is_smaller:
        is_smaller = False
        for text in _smaller(model.text):
            candidate = replace(model, text=text)
            if still(candidate):
                model, is_smaller = candidate, True
                break
    return model


def _smaller(text: str) -> Iterator[str]:
    count = sum(1 for _ in ElementTree.fromstring(text).iter())
    for number in range(count):
        root = ElementTree.fromstring(text)
        element = list(root.iter())[number]
        if element.tag in _PARTS:
            _leave_out(root, element)
            yield ElementTree.tostring(root, encoding="unicode")


def _leave_out(root: ElementTree.Element, element: ElementTree.Element) -> None:
    """Without an element and what refers to it."""
    name = element.get("name") if element.get("{http://www.omg.org/XMI}id") else None
    for parent in list(root.iter()):
        for child in list(parent):
            refers = name and any(
                name in references(value) for key, value in child.attrib.items() if "?" in value and "id" not in key
            )
            is_stimuli = child.tag in ("tasks", "isrs")
            if child is element or (refers and not is_stimuli):
                parent.remove(child)
            elif refers:
                kept = [part for part in child.get("stimuli", "").split() if part.partition("?")[0] != name]
                child.set("stimuli", " ".join(kept))
