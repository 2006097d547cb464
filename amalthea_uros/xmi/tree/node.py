"""The nodes of a model that is being migrated."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import chain
from operator import attrgetter


class Node:
    """An object of a model in any version: what an element of the file says, without knowing its class.

    A step may change everything, by the methods or directly; only containers and their parts are set by the methods alone.

    Attributes
    ----------
    attributes : text by name; without references
    references : targets by name, whether they were attributes or `href` elements
    children : the parts, in order
    parent : what this is a part of; None for a root and after removal
    target_class : class by which references name this object, where the tag does not tell it
    comments : comments and processing instructions in front of the element
    origin : index of the element in the files from which this comes
    index : at a root, what keeps track of changes in the whole tree
    """

    __slots__ = (
        "_tag",
        "_type",
        "attributes",
        "children",
        "comments",
        "index",
        "origin",
        "parent",
        "references",
        "target_class",
    )

    def __init__(self, tag: str, type_name: str = "", attributes: dict[str, str] | None = None, origin: int = -1) -> None:
        self._tag = tag
        self._type = type_name
        self.attributes: dict[str, str] = {} if attributes is None else attributes
        self.references: dict[str, list[Node]] = {}
        self.children: list[Node] = []
        self.parent: Node | None = None
        self.target_class = ""
        self.comments: list[str] | None = None
        self.origin = origin
        self.index: NodeIndex | None = None

    # Reading

    @property
    def tag(self) -> str:
        """Name of the element, without prefix."""
        return self._tag

    @tag.setter
    def tag(self, tag: str) -> None:
        index = self.root.index
        if index is not None:
            index.note(self)
        self._tag = tag

    @property
    def type(self) -> str:
        """Class that `xsi:type` states, "" if it states none; in ITEA versions with the package ("sw:LabelAccess")."""
        return self._type

    @type.setter  # noqa: A003 (as in the files)
    def type(self, type_name: str) -> None:
        index = self.root.index
        if index is not None:
            index.note(self)
        self._type = type_name

    @property
    def name(self) -> str:
        """The name, "" if there is none."""
        return self.attributes.get("name", "")

    @property
    def is_proxy(self) -> bool:
        """Whether this stands for an object that is in no file of the set, and of which only the reference is known."""
        return not self.tag

    def get(self, attribute: str, default: str = "") -> str:
        """The text of an attribute, `default` if it is absent."""
        return self.attributes.get(attribute, default)

    def target(self, reference: str) -> Node | None:
        """The first target of a reference, None if there is none."""
        targets = self.references.get(reference)
        return targets[0] if targets else None

    def child(self, tag: str) -> Node | None:
        """The first part of that tag, None if there is none."""
        return next((child for child in self.children if child._tag == tag), None)

    def all(self, *tags: str) -> list[Node]:
        """The parts of these tags, in order; a copy, so that they can be moved and removed meanwhile."""
        return [child for child in self.children if child._tag in tags]

    def find(self, *path: str) -> list[Node]:
        """Everything below that a path of tags leads to."""
        found = [self]
        for tag in path:
            found = [child for node in found for child in node.children if child._tag == tag]
        return found

    def walk(self) -> Iterator[Node]:
        """The node itself and everything in it, parents first. What is changed below a node before it is its turn, is met changed."""
        stack = [self]
        while stack:
            node = stack.pop()
            yield node
            if node.children:
                stack += node.children[::-1]

    def enclosing(self, *tags: str) -> Node | None:
        """The nearest container of one of these tags."""
        node = self.parent
        while node is not None and node.tag not in tags:
            node = node.parent
        return node

    @property
    def root(self) -> Node:
        """The outermost container."""
        node = self
        while node.parent is not None:
            node = node.parent
        return node

    # Changing

    def add(
        self, tag: str, type_name: str = "", /, *, at: int | None = None, like: Node | None = None, **attributes: str
    ) -> Node:
        """A new part, the last one or at a position; it has the origin of `like`, or else of this node."""
        made = Node(tag, type_name, attributes, (like or self).origin)
        self.insert(made, at)
        return made

    def child_or_new(self, tag: str, like: Node | None = None) -> Node:
        """The first part of that tag, made if there is none."""
        return self.child(tag) or self.add(tag, like=like)

    def insert(self, child: Node, at: int | None = None) -> None:
        """Make a node a part of this one, the last one or at a position; it leaves its present container."""
        holder = child.parent
        if holder is not None and holder.root is self.root:
            # Nothing for the index: the tree has the same nodes as before.
            holder.children.remove(child)
            child.parent = self
        else:
            child.remove()
            child.parent = self
            _note_all(self, (child,))
        if at is None:
            self.children.append(child)
        else:
            self.children.insert(at, child)

    def take(self, children: Iterable[Node]) -> None:
        """Make some nodes the last parts of this one; in time linear in their number, unlike inserting one after the other."""
        taken = list(children)
        root = self.root
        coming = [child for child in taken if child.parent is None or child.root is not root]
        remove_all(coming)
        _leave(taken)
        for child in taken:
            child.parent = self
        _note_all(self, coming)
        self.children.extend(taken)

    def set_children(self, children: list[Node]) -> None:
        """Make some nodes, of which none is a part of another node, the parts of this one; the present ones leave it."""
        _note_all(self, self.children)
        for child in self.children:
            child.parent = None
        for child in children:
            child.parent = self
        _note_all(self, children)
        self.children = children

    def remove(self) -> None:
        """Leave the container."""
        if self.parent is not None:
            _note_all(self.parent, (self,))
            # By identity: nodes are never equal to others.
            self.parent.children.remove(self)
            self.parent = None

    def replace_by(self, *nodes: Node) -> None:
        """Put other nodes in the place of this one."""
        holder = self.parent
        assert holder is not None
        at = holder.children.index(self)
        self.remove()
        for offset, node in enumerate(nodes):
            holder.insert(node, at + offset)

    def wrap(self, tag: str, type_name: str = "", /, **attributes: str) -> Node:
        """Put a new node in the place of this one, and this one into it."""
        made = Node(tag, type_name, attributes, self.origin)
        self.replace_by(made)
        made.insert(self)
        return made

    def rename(self, old: str, new: str) -> bool:
        """Rename an attribute or reference; whether there was one."""
        if old in self.attributes:
            self.attributes[new] = self.attributes.pop(old)
            return True
        if old in self.references:
            self.references[new] = self.references.pop(old)
            return True
        return False

    def drop(self, name: str) -> bool:
        """Remove an attribute or reference; whether there was one."""
        return self.attributes.pop(name, None) is not None or self.references.pop(name, None) is not None

    def copy(self) -> Node:
        """The same once more, without container; it refers to the same objects."""
        made = Node(self.tag, self.type, dict(self.attributes), self.origin)
        made.references = {name: list(targets) for name, targets in self.references.items()}
        made.target_class = self.target_class
        for part in self.children:
            made.insert(part.copy())
        return made

    def refer(self, name: str, *targets: Node) -> None:
        """Add targets to a reference."""
        self.references.setdefault(name, []).extend(targets)

    def __repr__(self) -> str:
        kind = f" {self.type}" if self.type else ""
        return f"<Node {self.tag}{kind} {self.name!r}>"


def remove_all(nodes: Iterable[Node]) -> None:
    """Let nodes leave their containers, in time linear in the number of the nodes and their siblings."""
    removed = list(nodes)
    for node in removed:
        if node.parent is not None:
            _note_all(node.parent, (node,))
    _leave(removed)


def _leave(nodes: Iterable[Node]) -> None:
    """Take nodes out of their containers, untold."""
    removed = set(nodes)
    for holder in {node.parent for node in removed if node.parent is not None}:
        holder.children = [child for child in holder.children if child not in removed]
    for node in removed:
        node.parent = None


def _note_all(holder: Node, parts: Iterable[Node]) -> None:
    """Tell of some parts, present or coming, of a node that they change."""
    index = holder.root.index
    if index is not None:
        for part in parts:
            index.note_all(part)


def proxy(path: str, class_name: str) -> Node:
    """What stands for an object that is in no file: its encoded path and class, as in references."""
    made = Node("", attributes={"path": path})
    made.target_class = class_name
    return made


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
            found.sort(key=attrgetter("origin"))
        return found
