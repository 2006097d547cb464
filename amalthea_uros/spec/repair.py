"""What is left of a file whose mistakes are taken out, so that the rest can be examined in the same run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.spec.mistakes import Mistake, intended_key, intended_word
from amalthea_uros.spec.nodes import MappingNode, NodePlace, ScalarNode
from amalthea_uros.spec.section import Section

#: Similarity of words from which on one is taken for a misspelling of the other.
CERTAIN = 0.8


def repair(mistakes: Iterable[Mistake], kind: type[Section]) -> set[NodePlace] | None:
    """Correct misspelled keys and words in the nodes of a file, and remove those that are not understood.

    Returns
    -------
    set : the places whose further findings may be consequences; None if a mistake leaves too little to examine, such as an unknown
        list, which may define names.
    """
    touched: set[NodePlace] = set()
    for mistake in mistakes:
        holder = mistake.path[-2] if len(mistake.path) > 1 else None
        if not isinstance(holder, MappingNode) or not _repair(mistake, holder, kind):
            return None
        touched.update(_places(holder))
    return touched


def _repair(mistake: Mistake, holder: MappingNode, kind: type[Section]) -> bool:
    """Repair a mistake in the mapping that it is in, unless that would be a guess."""
    value = mistake.path[-1]
    key = next((part for part in map(str, reversed(mistake.details["loc"])) if holder.items.get(part) is value), None)
    if key is None:
        return True  # It is also in the place of an alias, where it was repaired.
    if mistake.kind == "extra_forbidden":
        return _rename(holder, key, intended_key(mistake, kind, CERTAIN))
    if mistake.kind == "literal_error":
        word = intended_word(mistake, CERTAIN)
        if word is None:
            del holder.items[key]
        else:
            holder.items[key] = ScalarNode(value.place, word)
        return True
    return False


def _rename(holder: MappingNode, key: str, intended: str | None) -> bool:
    if intended is not None and intended not in holder.items:
        holder.items[intended], holder.keys[intended] = holder.items[key], holder.keys[key]
    elif not isinstance(holder.items[key], ScalarNode):
        return False
    del holder.items[key]
    return True


def _places(holder: MappingNode) -> Iterator[NodePlace]:
    """The places of a mapping and of its plain values."""
    yield holder.place
    for item in holder.items.values():
        if isinstance(item, ScalarNode):
            yield item.place
