"""0.8.3 -> 0.9.0, hardware: what the successors of objects have a place for, and the order of converters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from amalthea_uros.xmi.migrate.steps.tools import content_of, names_of
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

#: Values by which EMF states that nothing is stated.
_NOTHING = frozenset({"", "0", "0.0", "0x0", "false", "_undefined_"})


@dataclass(frozen=True)
class Shape:
    """What the successor of an object has a place for.

    Attributes
    ----------
    words : the kind of object, for messages; plural
    attributes, references, parts : names that it has; besides name, custom properties and tags
    """

    words: str
    attributes: frozenset[str] = frozenset()
    references: frozenset[str] = frozenset()
    parts: frozenset[str] = frozenset()

    def reduce(self, node: Node, notes: StepNotes) -> None:
        """Remove the rest, and report it."""
        shared = frozenset({"customProperties", "tags"})
        for key, text in list(node.attributes.items()):
            if key != "name" and key not in self.attributes:
                del node.attributes[key]
                if text.strip() not in _NOTHING:
                    notes.lost(node, f"{key!r} of {self.words}", text, key)
        for key, targets in list(node.references.items()):
            if key not in self.references | shared:
                del node.references[key]
                notes.lost(node, f"{key!r} of {self.words}", names_of(targets), key)
        superfluous = [part for part in node.children if part.tag not in self.parts | shared]
        for part in superfluous:
            notes.lost(part, f"{part.tag!r} of {self.words}", part.name or part.get("key") or content_of(part))
        remove_all(superfluous)


def keep_reference(node: Node, key: str, targets: Sequence[Node]) -> None:
    """State references as custom properties."""
    for target in targets:
        made = node.add("customProperties", at=_place_for_property(node), key=key)
        made.add("value", "ReferenceObject").refer("value", target)


def _place_for_property(node: Node) -> int:
    return next((at for at, part in enumerate(node.children) if part.tag != "customProperties"), len(node.children))


def is_cache(memory: Node) -> bool:
    """Whether a memory, not yet converted, becomes a cache."""
    memory_type = memory.target("type")
    return memory_type is not None and (memory_type.get("type") == "CACHE" or memory_type.type == "CacheDefinition")


def hash_order(nodes: Iterable[Node]) -> list[Node]:
    """Nodes in the order of a Java `HashMap` by name, in which APP4MC writes them."""
    held = list(nodes)
    buckets = 16
    while len(held) > 0.75 * buckets:
        buckets *= 2

    def bucket(node: Node) -> int:
        code = _java_hash(node.name)
        return (code ^ (code >> 16)) & (buckets - 1)

    return sorted(held, key=bucket)


def _java_hash(text: str) -> int:
    code = 0
    units = text.encode("utf-16-be", "surrogatepass")
    for at in range(0, len(units), 2):
        code = (31 * code + units[at] * 256 + units[at + 1]) & 0xFFFFFFFF
    return code
