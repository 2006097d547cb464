"""The nodes of some trees by tag and by type, kept up to date from step to step: most steps change little of a large model."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from itertools import chain
from operator import attrgetter

from amalthea_uros.xmi.migrate.node import Node

_ORIGIN = attrgetter("origin")

#: If more than this share of the nodes changed, everything is indexed anew, which is faster then.
_LARGE_SHARE = 0.1


class NodeIndex:
    """Nodes by tag, and by type where they state one; as they were when it was brought up to date."""

    def __init__(self) -> None:
        self._by_tag: dict[str, dict[Node, None]] = {}
        self._by_type: dict[str, dict[Node, None]] = {}
        self._size = 0
        #: What changed since: the nodes with the tag and the type that they had. None: too much.
        self._changed: dict[Node, tuple[str, str]] | None = None
        #: Tags and types of which the nodes are not in order any more.
        self._unordered: set[str] = set()

    def note(self, node: Node) -> None:
        """Note, before it happens, that a node gets another tag or type."""
        if self._changed is not None:
            self._changed.setdefault(node, (node.tag, node.type))

    def note_all(self, top: Node) -> None:
        """Note that a node gets or loses its container, with everything in it."""
        changed = self._changed
        if changed is None:
            return
        stack = [top]
        while stack:
            node = stack.pop()
            changed.setdefault(node, (node.tag, node.type))
            stack += node.children
        if len(changed) > _LARGE_SHARE * self._size:
            self._changed = None

    def update(self, roots: list[Node]) -> None:
        """Bring the index up to date for some trees."""
        if self._changed is None or any(root.index is not self for root in roots):
            self._build(roots)
            return
        present = set(roots)
        for node, (tag, type_name) in self._changed.items():
            self._by_tag.get(tag, {}).pop(node, None)
            self._by_type.get(type_name, {}).pop(node, None)
            if node.root in present:
                self._place(node)
        self._changed = {}

    def _place(self, node: Node) -> None:
        self._by_tag.setdefault(node.tag, {})[node] = None
        if node.type:
            self._by_type.setdefault(node.type, {})[node] = None
        self._unordered.update((node.tag, node.type))

    def _build(self, roots: list[Node]) -> None:
        by_tag: defaultdict[str, dict[Node, None]] = defaultdict(dict)
        by_type: defaultdict[str, dict[Node, None]] = defaultdict(dict)
        nodes = list(roots)
        for node in nodes:
            # The list grows meanwhile: level by level is the fastest way, and order matters only where somebody asks.
            nodes += node.children
            by_tag[node._tag][node] = None
            if node._type:
                by_type[node._type][node] = None
        self._by_tag, self._by_type = dict(by_tag), dict(by_type)
        self._size, self._changed = len(nodes), {}
        self._unordered = {*by_tag, *by_type}
        for root in roots:
            root.index = self

    def all(self) -> Iterator[Node]:
        """All nodes, in no order that means something."""
        return chain.from_iterable(self._by_tag.values())

    def of_tag(self, tag: str) -> list[Node]:
        """The nodes of a tag, in the order of the files."""
        return self._ordered(self._by_tag, tag)

    def of_type(self, type_name: str) -> list[Node]:
        """The nodes that state a type, in the order of the files."""
        return self._ordered(self._by_type, type_name)

    def _ordered(self, by_name: dict[str, dict[Node, None]], name: str) -> list[Node]:
        found = list(by_name.get(name, ()))
        if name in self._unordered:
            # What a step made has the origin of what it was made from.
            found.sort(key=_ORIGIN)
        return found


def all_below(roots: list[Node]) -> list[Node]:
    """Every node of some trees, parents first; faster than walking, and unaffected by changes afterwards."""
    found: list[Node] = []

    def visit(nodes: list[Node]) -> None:
        for node in nodes:
            found.append(node)
            if node.children:
                visit(node.children)

    visit(roots)
    return found
