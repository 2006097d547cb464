"""Text of one file -> nodes, and the references that are still to be linked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple
from xml.parsers import expat

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.xmi.emf import problems
from amalthea_uros.xmi.emf.handlers import connect, disconnect
from amalthea_uros.xmi.emf.header import XMI_NAMESPACE, XSI_NAMESPACE
from amalthea_uros.xmi.emf.versions import itea_package, namespace_version
from amalthea_uros.xmi.tree.model_set import Origins, Tree
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

_new = object.__new__

#: What references start with that leave the search for the file to the reader.
_ANY_FILE = "amlt:/#"


class PendingHref(NamedTuple):
    """A reference as an element: `<task href="amlt:/#T?type=Task"/>`.

    Attributes
    ----------
    type : class of the target that `xsi:type` states, "" if it states none
    """

    holder: Node
    tag: str
    text: str
    type: str


@dataclass
class ParsedFile:
    """One file as nodes.

    Attributes
    ----------
    nodes : all objects, in the order of the file
    hrefs : references as elements; those as attributes are still attributes
    ids : objects by their `xmi:id`, the first of several
    """

    tree: Tree
    nodes: list[Node]
    hrefs: list[PendingHref] = field(default_factory=list)
    ids: dict[str, Node] = field(default_factory=dict)


def parse(path: Path, content: FileText, origins: Origins, notes: StepNotes) -> ParsedFile:
    """The nodes of a file of any version.

    Raises
    ------
    ReadError : not well-formed, or refused for safety.
    """
    parser = _NodeParser(path, content, origins, notes)
    try:
        return parser.parse()
    finally:
        disconnect(parser.expat)


class _NodeParser:
    def __init__(self, path: Path, content: FileText, origins: Origins, notes: StepNotes) -> None:
        self.path, self.content, self.origins, self.notes = path, content, origins, notes
        self.expat = expat.ParserCreate("utf-8")
        self.root: Node | None = None
        self.version = ""
        self.nodes: list[Node] = []
        #: The open elements; None for one without a node of its own.
        self.stack: list[Node | None] = []
        self.hrefs: list[PendingHref] = []
        self.ids: dict[str, Node] = {}
        self.packages: dict[str, str] = {}
        self.types: dict[str, str] = {}
        self.xsi_type, self.xmi_id = "xsi:type", "xmi:id"
        self.comments: list[str] = []
        self.prolog: list[str] = []

    def parse(self) -> ParsedFile:
        parser, utf8 = self.expat, self.content.utf8
        connect(
            parser,
            utf8,
            start=self.start_root,
            end=self.end,
            characters=self.characters,
            comment=lambda data: self.comments.append(f"<!--{data}-->"),
            processing_instruction=lambda target, data: self.comments.append(f"<?{target} {data}?>"),
            doctype=self.refuse_doctype,
        )
        self.origins.begin_file(self.path, self.content)
        try:
            # In UTF-8, whatever the encoding of the file and its declaration: so the offsets count.
            parser.Parse(utf8, True)
        except expat.ExpatError as error:
            held = next((node for node in reversed(self.stack) if node is not None), None)
            place = (held.type or held.tag, problems.line_at(self.content, self.origins.starts[held.origin])) if held else None
            raise problems.malformed(self.path, self.content, error, parser.ErrorByteIndex, place) from None
        assert self.root is not None
        names = {node.tag for node in self.nodes} | {node.type for node in self.nodes}
        tree = Tree(self.path, self.content, self.version, self.root, self.prolog, self.comments, frozenset(names))
        return ParsedFile(tree, self.nodes, self.hrefs, self.ids)

    def start_root(self, name: str, attributes: dict[str, str]) -> None:
        prefixes = {key.partition(":")[2]: uri for key, uri in attributes.items() if key.startswith("xmlns")}
        by_namespace = {uri: prefix for prefix, uri in prefixes.items()}
        if problems.lacks_namespace(self.content.utf8):
            raise problems.undeclared_prefix(self.path, self.content, self.offset, "xsi", XSI_NAMESPACE)
        self.xsi_type = f"{by_namespace.get(XSI_NAMESPACE, 'xsi')}:type"
        xmi = by_namespace.get(XMI_NAMESPACE, "xmi")
        self.xmi_id = f"{xmi}:id"
        prefix, _, tag = name.rpartition(":")
        self.version = namespace_version(prefixes.get(prefix, ""))
        self.declare_packages(attributes)
        own = {key: text for key, text in attributes.items() if not key.startswith(("xmlns", f"{xmi}:version", f"{prefix}:"))}
        self.prolog, self.comments = self.comments, []
        self.root = root = Node(tag, attributes=own, origin=self.origins.add(self.offset, -1, tag, own.get("name", "")))
        self.take_marked(root, own.pop(self.xsi_type, ""))
        self.nodes.append(root)
        self.stack.append(root)
        self.expat.StartElementHandler = self.start_handler()

    def start_handler(self) -> Callable[[str, dict[str, str]], None]:
        """The handler of start tags, with everything it needs in local names: it runs once per element."""
        parser, stack, max_depth, origins = self.expat, self.stack, problems.MAX_DEPTH, self.origins
        add_start, add_end, add_parent = origins.starts.append, origins.ends.append, origins.parents.append
        add_label, starts, add_node = origins.labels.append, origins.starts, self.nodes.append
        xsi_type, types = self.xsi_type, self.types

        def start(tag: str, attributes: dict[str, str]) -> None:
            parent = stack[-1]
            if parent is None or ":" in tag:
                self.skip(tag, parent)
                return
            if "href" in attributes:
                self.start_href(parent, tag, attributes)
                return
            node: Node = _new(Node)
            node._tag, node._type, node.target_class = tag, "", ""
            type_text = attributes.pop(xsi_type, "")
            if type_text:
                node._type = types.get(type_text) or self.type_of(type_text)
            node.attributes, node.references, node.children = attributes, {}, []
            node.parent, node.comments, node.index = parent, None, None
            node.origin = len(starts)
            parent.children.append(node)
            add_start(parser.CurrentByteIndex)
            add_end(0)
            add_parent(parent.origin)
            add_label((tag, attributes.get("name", "")))
            add_node(node)
            for key in attributes:
                if ":" in key:
                    self.take_marked(node, type_text)
                    break
            if self.comments:
                node.comments, self.comments = self.comments, []
            stack.append(node)
            if len(stack) > max_depth:
                raise problems.too_deep(self.path, self.content, self.offset)

        return start

    def start_href(self, holder: Node, tag: str, attributes: dict[str, str]) -> None:
        """A reference as an element."""
        self.hrefs.append(PendingHref(holder, tag, _href(attributes["href"]), self.type_of(attributes.get(self.xsi_type, ""))))
        self.stack.append(None)

    def take_marked(self, node: Node, type_text: str) -> None:
        """Take the attributes with a prefix away from a node, of which `xsi:type` was taken; nothing of a model has one."""
        attributes = node.attributes
        keys = [key for key in attributes if ":" in key]
        declared = {key: attributes.pop(key) for key in keys if key.startswith("xmlns:")}
        if declared:
            self.declare_packages(declared)
        node._type = self.type_of(type_text)
        for key in keys:
            if key == self.xmi_id:
                self.ids.setdefault(attributes.pop(key), node)
            elif key not in declared:
                self.notes.lost(node, "attribute of another namespace", f"{key}={attributes.pop(key)!r}", key)

    def declare_packages(self, attributes: dict[str, str]) -> None:
        """Note the sub-models of ITEA versions that some of the attributes declare as namespaces."""
        for key, uri in attributes.items():
            if key.startswith("xmlns:") and (package := itea_package(uri)):
                self.packages[key.partition(":")[2] + ":"] = package + ":"
                self.types.clear()

    def type_of(self, text: str) -> str:
        """The class that an `xsi:type` states, in ITEA versions with its package."""
        known = self.types.get(text)
        if known is None:
            prefix, mark, name = text.rpartition(":")
            known = self.types[text] = self.packages.get(prefix + mark, "") + name
        return known

    def skip(self, tag: str, parent: Node | None) -> None:
        """An element that is no part of a model: of another namespace, or inside a reference."""
        holder = parent or next(node for node in reversed(self.stack) if node is not None)
        self.notes.lost(holder, "content of another namespace, or inside a reference", f"<{tag}>")
        self.stack.append(None)

    def end(self, _tag: str) -> None:
        node = self.stack.pop()
        if node is not None:
            self.origins.ends[node.origin] = self.expat.CurrentByteIndex
            if self.comments and node.parent is not None:
                # Behind the last part: it stays with the container.
                node.comments = [*(node.comments or ()), *self.comments]
                self.comments = []

    def characters(self, data: str) -> None:
        if data.isspace():
            return
        holder = next((node for node in reversed(self.stack) if node is not None), None)
        if holder is not None:
            self.notes.lost(holder, "text between the elements", repr(data.strip()[:30]))

    def refuse_doctype(self, *_declaration: Any) -> None:
        raise problems.has_doctype(self.path, self.content, self.offset)

    @property
    def offset(self) -> int:
        return self.expat.CurrentByteIndex


def _href(text: str) -> str:
    """A reference into a file that was not read is written with its file name in the place of an id: `amlt:/#x.amxmi#//@swModel`."""
    inner = text.removeprefix(_ANY_FILE)
    return inner if "#" in inner else text
