"""Nodes of a version with facts -> document, by the reader of files: what the newest version does not know is found by the same rules,
and with the places in the old file.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.versions import NAMESPACE_PREFIX
from amalthea_uros.xmi.header import XMI_NAMESPACE, XSI_NAMESPACE
from amalthea_uros.xmi.migrate.model_set import ModelSet, Origins, Tree
from amalthea_uros.xmi.migrate.names import reference_text
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.reader import ReadResult, read_events


def read_trees(models: ModelSet, versions: Sequence[str]) -> tuple[list[ReadResult], dict[str, Element]]:
    """Read all trees of a set; their versions were others before the migration.

    Returns
    -------
    The results, and the objects by the texts of the references to them.
    """
    linked: dict[str, Element] = {}
    texts = _Texts(models)
    results = []
    for tree, version in zip(models.trees, versions, strict=True):
        events = TreeEvents(tree, models.origins, texts, linked)
        result = read_events(tree.path, tree.content, events)
        document = result.document
        assert document.source is not None
        document.source = replace(document.source, version=version)
        document.migrated_from = version
        results.append(result)
    return results, linked


class _Texts:
    """The text of every reference: the name of its target, made unique by a number where several targets have the same."""

    def __init__(self, models: ModelSet) -> None:
        self.of: dict[Node, str] = {}
        self.roots: dict[Node, Node] = {}
        used: set[str] = set()
        for root in (tree.root for tree in models.trees):
            for node in root.walk():
                for targets in node.references.values():
                    for target in targets:
                        if target not in self.of:
                            self.of[target] = _unique(reference_text(target), used)
                            self.roots[target] = target.root


def _unique(text: str, used: set[str]) -> str:
    found, number = text, 1
    while found in used:
        number += 1
        found = f"{text}#{number}"
    used.add(found)
    return found


class TreeEvents:
    """The nodes of a file as the events of a parser: what the reader needs of `xml.parsers.expat`.

    Attributes
    ----------
    made : the objects that the reader has made so far
    """

    StartElementHandler: Callable[[str, dict[str, str]], None]
    EndElementHandler: Callable[[str], None]
    CommentHandler: Callable[[str], None]
    ProcessingInstructionHandler: Callable[[str, str], None]

    def __init__(self, tree: Tree, origins: Origins, texts: _Texts, linked: dict[str, Element]) -> None:
        self.tree, self.origins, self.texts, self.linked = tree, origins, texts, linked
        self.made: list[Element] = []
        self.CurrentByteIndex = 0

    def SetParamEntityParsing(self, _flag: int) -> None:  # noqa: N802 (names of expat)
        """Nothing to do: the text was parsed before."""

    def Parse(self, _text: str, _is_final: bool) -> None:  # noqa: N802
        """Report everything."""
        root = self.tree.root
        self.outside(self.tree.prolog)
        declarations = {
            "xmi:version": "2.0",
            "xmlns:xmi": XMI_NAMESPACE,
            "xmlns:xsi": XSI_NAMESPACE,
            "xmlns:am": NAMESPACE_PREFIX + self.tree.version,
        }
        self.element(root, "am:" + root.tag, declarations)
        self.outside(self.tree.epilog)

    def element(self, node: Node, tag: str, attributes: dict[str, str]) -> None:
        """Report a node and everything in it."""
        if node.comments:
            self.outside(node.comments)
        attributes |= node.attributes
        if node.type:
            attributes["xsi:type"] = "am:" + node.type
        hrefs: list[tuple[str, list[Node]]] = []
        for name, targets in node.references.items():
            if all(self.texts.roots[target] is self.tree.root for target in targets):
                attributes[name] = " ".join([self.texts.of[target] for target in targets])
            else:
                hrefs.append((name, targets))
        start, end = self.origins.starts[node.origin], self.origins.ends[node.origin]
        self.CurrentByteIndex = start
        before = len(self.made)
        self.StartElementHandler(tag, attributes)
        if node in self.texts.of and len(self.made) > before:
            self.linked[self.texts.of[node]] = self.made[-1]
        for name, targets in hrefs:
            for target in targets:
                self.CurrentByteIndex = start
                self.StartElementHandler(name, {"href": "amlt:/#" + self.texts.of[target]})
                self.EndElementHandler(name)
        for child in node.children:
            self.element(child, child.tag, {})
        self.CurrentByteIndex = end
        self.EndElementHandler(tag)

    def outside(self, comments: list[str]) -> None:
        """Report comments and processing instructions."""
        for text in comments:
            if text.startswith("<!--"):
                self.CommentHandler(text[4:-3])
            else:
                target, _, data = text[2:-2].partition(" ")
                self.ProcessingInstructionHandler(target, data)
