"""References as text -> links between nodes, before the first step moves or renames anything.

A text is one of these: a name with its class (`Label_1?type=Label`, in ITEA 1.3.0 `Label_1?type=sw.Label`); the `xmi:id` of an object,
mostly a UUID (ITEA 1.1.0 and 1.2.0); a position (`//@swModel/@tasks.0`). In `href` elements a file or `amlt:/` stands before it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from urllib.parse import unquote, unquote_plus

from amalthea_uros.metamodel.naming import TYPE_MARK
from amalthea_uros.xmi.migrate.classes import local_name, may_be
from amalthea_uros.xmi.migrate.model_set import ModelSet, Origins
from amalthea_uros.xmi.migrate.node import Node, proxy
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.parse import Parsed

#: Attributes that are text in all classes of all versions, whatever they look like.
_TEXT = frozenset(
    {
        *("name", "description", "displayName", "abbreviation", "xmlPrefix", "algorithm", "alias", "interfaceName", "osName"),
        *("platformName", "platformType", "structureType", "tagType", "typeName", "vendor", "version"),
    }
)

#: Tags of entries of which the key is text.
_TEXT_KEYS = frozenset({"customProperties", "entries", "needs", "parameterExtensions"})

#: What references by id or position start with.
_STARTS = ("_", "/", "#")

_STEP = re.compile(r"@?([A-Za-z]+)(?:\.(\d+))?").fullmatch
_UUID = re.compile(r"_[A-Za-z0-9_-]{22}").fullmatch


def file_of(href: str) -> str:
    """The file that an `href` names, relative to that of the reference; "" if it leaves the search to the reader (`amlt:/`)."""
    file, mark, _ = href.partition("#")
    return "" if not mark or ":" in file else unquote(file)


def link(parsed: Sequence[Parsed], origins: Origins, notes: Notes) -> ModelSet:
    """The set of some files with every reference linked; what is in no file is linked to a proxy."""
    models = ModelSet([one.tree for one in parsed], origins)
    linker = _Linker(parsed, models)
    for one in parsed:
        linker.link(one)
    linker.make_unique(notes)
    return models


class _Linker:
    def __init__(self, parsed: Sequence[Parsed], models: ModelSet) -> None:
        self.models = models
        self.by_path = {_normal(one.tree.path): one for one in parsed}
        self.ids: dict[str, Node] = {}
        for one in parsed:
            for text, node in one.ids.items():
                self.ids.setdefault(text, node)
        self.by_name: dict[str, list[Node]] = {}
        self.siblings: dict[tuple[Node, str], list[Node]] = {}
        for one in parsed:
            for node in one.tree.root.walk():
                if "name" in node.attributes:
                    self.by_name.setdefault(node.attributes["name"], []).append(node)
        self.proxies: dict[str, Node] = {}
        self.found: dict[tuple[str, Node], Node] = {}
        #: Targets that were not found by their names, and which therefore may share them with others.
        self.by_identity: dict[Node, None] = {}

    def link(self, one: Parsed) -> None:
        """Link the references of one file."""
        root, ids = one.tree.root, one.ids
        for node in root.walk():
            attributes = node.attributes
            linked: list[str] | None = None
            for key, text in attributes.items():
                if TYPE_MARK in text or text[:1] in _STARTS or (ids and text.partition(" ")[0] in ids):
                    targets = None if key in _TEXT or _is_text_value(node, key) else self.targets(one, text.split())
                    if targets:
                        node.references[key] = targets
                        linked = [*(linked or ()), key]
            for key in linked or ():
                del attributes[key]
        for holder, tag, text in one.hrefs:
            file, _, fragment = text.rpartition("#")
            elsewhere = self.by_path.get(_normal(one.tree.path.parent / unquote(file))) if file_of(text) else one
            target = self.target(elsewhere, fragment) if elsewhere else None
            holder.refer(tag, target or self.proxy(fragment))

    def targets(self, one: Parsed, texts: list[str]) -> list[Node] | None:
        """The objects that the texts name; None if this is no reference."""
        found = []
        for text in texts:
            target = self.target(one, text)
            if target is None:
                if not (TYPE_MARK in text or _UUID(text) or text.startswith(("//", "#//"))):
                    return None
                target = self.proxy(text)
            found.append(target)
        return found

    def target(self, one: Parsed, text: str) -> Node | None:
        """The object that a text names."""
        text = text.removeprefix("#")
        root = one.tree.root
        known = self.found.get((text, root))
        if known is not None:
            return known
        found = self.by_id(one, text) or (self.at(root, text) if text.startswith("/") else self.named(one, text))
        if found is not None:
            self.found[text, root] = found
        return found

    def by_id(self, one: Parsed, text: str) -> Node | None:
        if TYPE_MARK in text:
            return None  # ids of this form are names, and may be out of date
        found = one.ids.get(text) or self.ids.get(text)
        if found is not None:
            self.by_identity[found] = None
        return found

    def named(self, one: Parsed, text: str) -> Node | None:
        """The object of a name; the first one in the same file of several."""
        if TYPE_MARK not in text:
            text = unquote(text)  # some converters encoded the whole text again, `?type=` included
        path, mark, class_name = text.rpartition(TYPE_MARK)
        if not mark:
            return None
        class_name = class_name.replace(".", ":")
        segments = [unquote_plus(segment) for segment in path.split("/")]
        # The converters to 0.9.0 encoded some names twice.
        for read in (segments, list(map(unquote_plus, segments))):
            fitting = [n for n in self.by_name.get(read[-1], ()) if may_be(n, local_name(class_name))]
            if len(fitting) > 1 and len(read) > 1:
                fitting = [n for n in fitting if n.parent is not None and n.parent.name == read[-2]] or fitting
            if fitting:
                found = fitting[0] if len(fitting) == 1 else next((n for n in fitting if n.root is one.tree.root), fitting[0])
                if not found.type:
                    found.target_class = class_name
                return found
        return None

    def at(self, root: Node, text: str) -> Node | None:
        """The object at a position such as `//@swModel/@tasks.0`."""
        node = root
        for step in text.strip("/").split("/") if text.strip("/") else ():
            match = _STEP(step)
            if match is None:
                return None
            siblings = self.siblings.get((node, match[1]))
            if siblings is None:
                siblings = self.siblings[node, match[1]] = node.all(match[1])
            place = int(match[2] or 0)
            if place >= len(siblings):
                return None
            node = siblings[place]
        self.by_identity[node] = None
        return node

    def proxy(self, text: str) -> Node:
        """What stands for an object that is in no file."""
        made = self.proxies.get(text)
        if made is None:
            path, mark, class_name = text.rpartition(TYPE_MARK)
            made = self.proxies[text] = proxy(path if mark else text, class_name.replace(".", ":") if mark else "")
            self.models.proxies.append(made)
        return made

    def make_unique(self, notes: Notes) -> None:
        """Give names of their own to objects to which references were not by name, where the name does not tell them from others."""
        for node in self.by_identity:
            same = [n for n in self.by_name.get(node.name, ()) if n.tag == node.tag and n.type == node.type]
            if len(same) < 2 or same[0] is node or (node.parent is not None and _is_qualified(node)):
                continue
            number = 2
            while f"{node.name}_{number}" in self.by_name:
                number += 1
            old, node.attributes["name"] = node.name, f"{node.name}_{number}"
            self.by_name[node.name] = [node]
            notes.renamed(node, "made unique: references were by id, and are by name now", f"{old} -> {node.name}", "name")


def _is_qualified(node: Node) -> bool:
    return node.tag in ("literals", "ports", "features")


def _is_text_value(node: Node, key: str) -> bool:
    """Whether an attribute is the text of a custom property or parameter extension."""
    if key == "value":
        return node.tag == "parameterExtensions" or local_name(node.type) == "StringObject"
    return key == "key" and node.tag in _TEXT_KEYS


def _normal(path: Path) -> Path:
    return Path(*_parts(path.parts))


def _parts(parts: Iterable[str]) -> list[str]:
    """The parts of a path without `..`."""
    found: list[str] = []
    for part in parts:
        if part == ".." and found and found[-1] not in ("..", "/"):
            found.pop()
        else:
            found.append(part)
    return found
