"""Smaller descriptions of which the same is said falsely."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from copy import deepcopy
from time import monotonic

from opponent.executors.descriptions import Section

#: What is kept in any case.
_NEEDED = {
    "amuros",
    "name",
    "hardware",
    "middleware",
    "application",
    "executors",
    "transport",
    "nodes",
    "loop",
    "execution_time",
}

Path = tuple[str | int, ...]


def kind_of(text: str) -> str:
    """What false answers of the same kind have in common: without names and figures."""
    found = re.sub(r"^\w+ \d+: ", "", text)
    found = re.sub(r"\d+/\d+|\d+(\.\d+)?", "#", found)
    found = re.sub(r"[A-Z]#(-[\w/#]+)?(/\w#)?", "X", found)
    return re.sub(r"\w*(topic|request|response)_(to|from)_X(_acknowledgement)?", r"message\3", found)


def shrunk(content: Section, false: Callable[[Section], list[str]], wanted: str, seconds: float = 60) -> Section:
    """The smallest description found in some time about which something of the same kind is said."""
    end = monotonic() + seconds

    def still(candidate: Section) -> bool:
        try:
            return any(kind_of(text) == wanted for text in false(candidate))
        except Exception:  # whatever it is, it is no smaller description
            return False

    is_smaller = True
    while is_smaller and monotonic() < end:
        is_smaller = False
        for path in list(_paths(content)):
            candidate = _without(content, path)
            if candidate is not None and monotonic() < end and still(candidate):
                content, is_smaller = candidate, True
    return content


def _paths(content: object, path: Path = ()) -> Iterator[Path]:
    """Everything that can be left out, large parts first."""
    if isinstance(content, dict):
        for key, value in content.items():
            if key not in _NEEDED:
                yield (*path, key)
            yield from _paths(value, (*path, key))
    elif isinstance(content, list):
        for number, value in reversed(list(enumerate(content))):
            yield (*path, number)
            if isinstance(value, dict):
                yield from _paths(value, (*path, number))


def _without(content: Section, path: Path) -> Section | None:
    """A description without a part, and without chains, requirements and orders that name it; None if the part is gone."""
    found = deepcopy(content)
    parent: object = found
    try:
        for key in path[:-1]:
            parent = parent[key]  # type: ignore[index]
        gone = parent[path[-1]]  # type: ignore[index]
        del parent[path[-1]]  # type: ignore[attr-defined]
    except (KeyError, IndexError):
        return None
    names = {gone.get("name"), gone.get("topic"), f"/{gone.get('topic')}"} - {None} if isinstance(gone, dict) else set()
    for key in ("chains", "requirements"):
        if key in found and names:
            found[key] = [each for each in found[key] if names.isdisjoint((*each.get("path", ()), each.get("process")))]
    for executor in found["middleware"]["executors"]:
        if "order" in executor:
            executor["order"] = [name for name in executor["order"] if name not in names]
    for section in _callbacks(found):
        for key in ("publishes", "requests"):
            if key in section:
                section[key] = [name for name in section[key] if name not in names]
    return found


def _callbacks(content: Section) -> Iterator[Section]:
    for node in content["application"]["nodes"]:
        yield from (each for value in node.values() if isinstance(value, list) for each in value)
