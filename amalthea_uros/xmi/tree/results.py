"""Nodes -> text, for versions that have no typed classes; nodes -> documents, by the reader of files, for all others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.versions import NAMESPACE_PREFIX
from amalthea_uros.xmi.emf.escape import escape
from amalthea_uros.xmi.emf.header import XMI_NAMESPACE, XSI_NAMESPACE
from amalthea_uros.xmi.emf.reader import ReadResult, read_events
from amalthea_uros.xmi.emf.versions import ITEA
from amalthea_uros.xmi.tree.classes import local_name, reference_text
from amalthea_uros.xmi.tree.model_set import ModelSet, Origins, Tree
from amalthea_uros.xmi.tree.node import Node

_ITEA_NAMESPACE = "http://www.amalthea.itea2.org/model/"
_ITEA_PACKAGES = (
    *("central", "common", "components", "config", "constraints", "events", "hw", "mapping", "os", "propertyconstraints"),
    *("stimuli", "sw"),
)

#: The package of the root of a file that holds one sub-model only.
_ROOT_PACKAGES = {
    "AMALTHEA": "central",
    "CommonElements": "common",
    "ComponentsModel": "components",
    "ConfigModel": "config",
    "ConstraintsModel": "constraints",
    "EventModel": "events",
    "HWModel": "hw",
    "MappingModel": "mapping",
    "OSModel": "os",
    "PropertyConstraintsModel": "propertyconstraints",
    "StimuliModel": "stimuli",
    "SWModel": "sw",
}


def tree_text(tree: Tree) -> str:
    """The text of a file: references by name, everything in the order of the nodes."""
    out = ['<?xml version="1.0" encoding="UTF-8"?>', *tree.prolog]
    prefix = "am"
    spaces = {"am": NAMESPACE_PREFIX + tree.version}
    if tree.version in ITEA:
        prefix = _ROOT_PACKAGES.get(tree.root.tag, "central")
        number = tree.version.rpartition(" ")[2]
        spaces = {package: f"{_ITEA_NAMESPACE}{number}/{package}" for package in _ITEA_PACKAGES}
    declared = {"xmi:version": "2.0", "xmlns:xmi": XMI_NAMESPACE, "xmlns:xsi": XSI_NAMESPACE}
    declared |= {f"xmlns:{name}": uri for name, uri in spaces.items()}
    _write(tree.root, f"{prefix}:{tree.root.tag}", declared, "", tree.root, out)
    return "\n".join([*out, *tree.epilog, ""])


def _write(node: Node, tag: str, attributes: dict[str, str], indent: str, root: Node, out: list[str]) -> None:
    out += [indent + comment for comment in node.comments or ()]
    if node.type:
        attributes["xsi:type"] = node.type if ":" in node.type else f"am:{node.type}"
    attributes |= node.attributes
    hrefs: list[tuple[str, Node]] = []
    for name, targets in node.references.items():
        if all(target.root is root for target in targets):
            attributes[name] = " ".join(map(reference_text, targets))
        else:
            hrefs += [(name, target) for target in targets]
    start = f"{indent}<{tag}" + "".join(_attributes(attributes.items()))
    if not node.children and not hrefs:
        out.append(start + "/>")
        return
    out.append(start + ">")
    for name, target in hrefs:
        out.append(f'{indent}  <{name} href="amlt:/#{escape(reference_text(target))}"/>')
    for child in node.children:
        _write(child, child.tag, {}, indent + "  ", root, out)
    out.append(f"{indent}</{tag}>")


def _attributes(items: Iterable[tuple[str, str]]) -> Iterable[str]:
    return (f' {name}="{escape(text)}"' for name, text in items)


# Nodes of a version with facts -> document, by the reader of files: what the newest version does not know is found by the same rules,


def read_trees(models: ModelSet, versions: Sequence[str]) -> tuple[list[ReadResult], dict[str, Element]]:
    """Read all trees of a set; their versions were others before the migration.

    Returns
    -------
    The results, and the objects by the texts of the references to them.
    """
    texts = _Texts()
    made: dict[Node, Element] = {}
    results = []
    for tree, version in zip(models.trees, versions, strict=True):
        events = TreeEvents(tree, models.origins, texts, made)
        result = read_events(tree.path, tree.content, events)
        document = result.document
        assert document.source is not None
        document.source = replace(document.source, version=version, byte_starts=events.starts)
        document.migrated_from = version
        results.append(result)
    return results, {text: made[node] for node, text in texts.of.items() if node in made}


class _Texts:
    """The text of every reference: the name of its target, made unique by a number where several targets have the same."""

    def __init__(self) -> None:
        self.of: dict[Node, str] = {}
        self.roots: dict[Node, Node] = {}
        self.used: set[str] = set()

    def of_targets(self, targets: list[Node], root: Node) -> tuple[list[str], bool]:
        """The texts, and whether all targets are below a root."""
        found, is_local = [], True
        for target in targets:
            text = self.of.get(target)
            if text is None:
                text = self.of[target] = self.unique(reference_text(target))
                self.roots[target] = target.root
            found.append(text)
            is_local = is_local and self.roots[target] is root
        return found, is_local

    def unique(self, text: str) -> str:
        found, number = text, 1
        while found in self.used:
            number += 1
            found = f"{text}#{number}"
        self.used.add(found)
        return found


class TreeEvents:
    """The nodes of a file as the events of a parser: what the reader needs of `xml.parsers.expat`. They are used up by it.

    Attributes
    ----------
    made : the objects that the reader has made so far
    starts : the offset of the start tag of each in the file, in bytes of UTF-8
    """

    StartElementHandler: Callable[[str, dict[str, str]], None]
    EndElementHandler: Callable[[str], None]
    CommentHandler: Callable[[str], None]
    ProcessingInstructionHandler: Callable[[str, str], None]

    def __init__(self, tree: Tree, origins: Origins, texts: _Texts, made_of: dict[Node, Element]) -> None:
        self.tree, self.origins, self.texts, self.made_of = tree, origins, texts, made_of
        self.made: list[Element] = []
        self.starts: list[int] = []
        self.CurrentByteIndex = 0

    def SetParamEntityParsing(self, _flag: int) -> None:  # noqa: N802 (names of expat)
        """Nothing to do: the text was parsed before."""

    def Parse(self, _text: bytes, _is_final: bool) -> None:  # noqa: N802
        """Report everything."""
        root = self.tree.root
        self.outside(self.tree.prolog)
        root.attributes |= {
            "xmi:version": "2.0",
            "xmlns:xmi": XMI_NAMESPACE,
            "xmlns:xsi": XSI_NAMESPACE,
            "xmlns:am": NAMESPACE_PREFIX + self.tree.version,
        }
        self.CurrentByteIndex = self.origins.starts[root.origin]
        hrefs = self.refer(root)
        self.begin("am:" + root.tag, root.attributes)
        self.made_of[root] = self.made[0]
        self.report_hrefs(hrefs)
        report = self.reporter()
        for child in root.children:
            report(child)
        self.CurrentByteIndex = self.origins.ends[root.origin]
        self.EndElementHandler(root.tag)
        self.outside(self.tree.epilog)

    def reporter(self) -> Callable[[Node], None]:
        """What reports a node and everything in it, with all that it needs in local names: it runs once per node."""
        begin, made, made_of, starts, ends = self.begin, self.made, self.made_of, self.origins.starts, self.origins.ends

        def report(node: Node) -> None:
            if node.comments:
                self.outside(node.comments)
            tag, attributes, origin = node._tag, node.attributes, node.origin
            if node._type:
                attributes["xsi:type"] = "am:" + node._type
            hrefs = self.refer(node) if node.references else None
            self.CurrentByteIndex = starts[origin]
            if begin(tag, attributes):
                made_of[node] = made[-1]
            if hrefs:
                self.report_hrefs(hrefs)
            for child in node.children:
                report(child)
            self.CurrentByteIndex = ends[origin]
            self.EndElementHandler(tag)

        return report

    def begin(self, tag: str, attributes: dict[str, str]) -> bool:
        """Report a start tag; whether the reader made an object of it."""
        # The reader changes its handlers while it skips something.
        self.StartElementHandler(tag, attributes)
        if len(self.made) == len(self.starts):
            return False
        self.starts.append(self.CurrentByteIndex)
        return True

    def refer(self, node: Node) -> list[tuple[str, dict[str, str]]]:
        """Write the references of a node as attributes; those that must be elements, because a target is in another file."""
        hrefs: list[tuple[str, dict[str, str]]] = []
        for name, targets in node.references.items():
            texts, is_local = self.texts.of_targets(targets, self.tree.root)
            if is_local:
                node.attributes[name] = texts[0] if len(texts) == 1 else " ".join(texts)
            else:
                hrefs += [(name, _href(target, text)) for target, text in zip(targets, texts, strict=True)]
        return hrefs

    def report_hrefs(self, hrefs: list[tuple[str, dict[str, str]]]) -> None:
        """Report references as elements, at the present place."""
        for name, attributes in hrefs:
            self.begin(name, attributes)
            self.EndElementHandler(name)

    def outside(self, comments: list[str]) -> None:
        """Report comments and processing instructions."""
        for text in comments:
            if text.startswith("<!--"):
                self.CommentHandler(text[4:-3])
            else:
                target, _, data = text[2:-2].partition(" ")
                self.ProcessingInstructionHandler(target, data)


def _href(target: Node, text: str) -> dict[str, str]:
    """The attributes of a reference as an element, with the class of a target that is in no file if the old reference states it."""
    stated = target.get("class") if target.is_proxy else ""
    return {"href": "amlt:/#" + text} | ({"xsi:type": f"am:{local_name(stated)}"} if stated else {})
