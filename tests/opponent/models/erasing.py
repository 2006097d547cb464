"""Models of which something is not told: what occurred while it was known can still occur, and may not be claimed away."""

from __future__ import annotations

from random import Random
from xml.etree import ElementTree

from opponent.models.reading import kind_of

Element = ElementTree.Element

#: The prefixes of models. They are registered with each text: other tests register those of other versions.
_PREFIXES = {
    "am": "http://app4mc.eclipse.org/amalthea/3.3.0",
    "xmi": "http://www.omg.org/XMI",
    "xsi": "http://www.w3.org/2001/XMLSchema-instance",
}


def erased(text: str, rng: Random) -> tuple[str, str]:
    """A model without something that it states, and the name of that."""
    root = ElementTree.fromstring(text)
    known = {
        "no demand": _no_demand,
        "no priority": _no_parameters,
        "no policy": _no_policy,
        "no allocation": _no_allocation,
        "no upper bound": _no_upper_bound,
    }
    name = rng.choice(list(known))
    if not known[name](root, rng):
        return text, ""
    for prefix, uri in _PREFIXES.items():
        ElementTree.register_namespace(prefix, uri)
    return ElementTree.tostring(root, encoding="unicode"), name


def _no_demand(root: Element, rng: Random) -> bool:
    return _without(root, rng, "items", "default", lambda item: kind_of(item) == "Ticks")


def _no_parameters(root: Element, rng: Random) -> bool:
    return _without(root, rng, "taskAllocation", "schedulingParameters")


def _no_policy(root: Element, rng: Random) -> bool:
    rng.choice(list(root.iter("taskSchedulers"))).attrib.pop("definition")
    return True


def _no_allocation(root: Element, rng: Random) -> bool:
    mapping = next(root.iter("mappingModel"))
    allocations = [*mapping.findall("taskAllocation"), *mapping.findall("isrAllocation")]
    mapping.remove(rng.choice(allocations))
    return True


def _no_upper_bound(root: Element, rng: Random) -> bool:
    bounded = [e for e in root.iter("default") if "upperBound" in e.attrib]
    if bounded:
        rng.choice(bounded).attrib.pop("upperBound")
    return bool(bounded)


def _without(root: Element, rng: Random, tag: str, part: str, is_meant: object = None) -> bool:
    """Take all parts of this tag from one of the elements that have some."""
    having = [e for e in root.iter(tag) if e.findall(part) and (not callable(is_meant) or is_meant(e))]
    if not having:
        return False
    element = rng.choice(having)
    for child in element.findall(part):
        element.remove(child)
    return True
