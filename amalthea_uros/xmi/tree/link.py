"""References as text -> links between nodes, before the first step moves or renames anything.

A text is one of these: a name with its class (`Label_1?type=Label`, in ITEA 1.3.0 `Label_1?type=sw.Label`); the `xmi:id` of an object,
mostly a UUID (ITEA 1.1.0 and 1.2.0); a position (`//@swModel/@tasks.0`). In `href` elements a file or `amlt:/` stands before it.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from itertools import chain
from pathlib import Path
from urllib.parse import unquote, unquote_plus

from amalthea_uros._internal.files import is_file, resolved
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.naming import NO_NAME, TYPE_MARK
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.xmi.emf.files import SUFFIX, read_text
from amalthea_uros.xmi.tree.classes import is_of, local_name, may_be
from amalthea_uros.xmi.tree.model_set import ModelSet, Origins
from amalthea_uros.xmi.tree.node import Node, proxy
from amalthea_uros.xmi.tree.notes import StepNotes
from amalthea_uros.xmi.tree.parse import ParsedFile, PendingHref, parse

#: Attributes that are text in all classes of all versions, whatever they look like.
_TEXT = frozenset(
    {
        *("name", "description", "displayName", "abbreviation", "xmlPrefix", "algorithm", "alias", "interfaceName", "osName"),
        *("platformName", "platformType", "structureType", "tagType", "typeName", "vendor", "version"),
    }
)

#: Tags of entries of which the key is text.
_TEXT_KEYS = frozenset({"customProperties", "entries", "needs", "parameterExtensions"})

#: Attributes `value` that are text, by the class of their object: custom properties and, in ITEA versions, hardware attributes.
_TEXT_VALUES = frozenset({"StringObject", "StrValue", "CharValue", "FeatureTypes"})

#: What references by id or position start with.
_STARTS = ("_", "/", "#")

#: A position as an attribute; the root itself, `/`, occurs in `href` elements only.
_POSITION = re.compile(r"#?/\d*(?:/@[A-Za-z]+(?:\.\d+)?)+").fullmatch
_STEP = re.compile(r"@?([A-Za-z]+)(?:\.(\d+))?").fullmatch
_UUID = re.compile(r"_[A-Za-z0-9_-]{22}").fullmatch


def file_of(href: str) -> str:
    """The file that an `href` names, relative to that of the reference; "" if it leaves the search to the reader (`amlt:/`)."""
    file, mark, _ = href.partition("#")
    return "" if not mark or ":" in file else unquote(file)


def read_set(
    files: Iterable[tuple[Path, FileText]], max_size: int, notes: StepNotes, elsewhere: Collection[Path] = ()
) -> ModelSet:
    """Read some files, and those to which they refer by file names, as one set.

    Parameters
    ----------
    elsewhere : files that are read in another way, and that do not become part of the set

    Raises
    ------
    ReadError : a file cannot be read; carries the findings of all of them.
    """
    origins = Origins()
    parsed: list[ParsedFile] = []
    refused: list[Finding] = []
    waiting = list(files)
    known = {resolved(path) for path in (*elsewhere, *(path for path, _ in waiting))}
    while waiting:
        path, content = waiting.pop(0)
        try:
            parsed.append(parse(path, content, origins, notes))
        except ReadError as error:
            refused += error.findings
            continue
        for other in dict.fromkeys(file_of(href.text) for href in parsed[-1].hrefs):
            found = path.parent / other
            # A missing file is reported with the references to it.
            if other and SUFFIX in found.suffix and resolved(found) not in known and is_file(found):
                known.add(resolved(found))
                try:
                    waiting.append((found, read_text(found, max_size)))
                except ReadError as error:
                    refused += error.findings
    if refused:
        raise ReadError(refused)
    return link(parsed, origins, notes)


def link(parsed: Sequence[ParsedFile], origins: Origins, notes: StepNotes) -> ModelSet:
    """The set of some files with every reference linked; what is in no file is linked to a proxy."""
    models = ModelSet([one.tree for one in parsed], origins)
    linker = _Linker(parsed, models)
    for one in parsed:
        linker.link(one)
    linker.make_unique(notes)
    return models


class _Linker:
    def __init__(self, parsed: Sequence[ParsedFile], models: ModelSet) -> None:
        self.models = models
        self.by_path = {_normal(one.tree.path): one for one in parsed}
        self.ids: dict[str, Node] = {}
        for one in parsed:
            for text, node in one.ids.items():
                self.ids.setdefault(text, node)
        self.by_name: dict[str, list[Node]] = {}
        self.siblings: dict[tuple[Node, str], list[Node]] = {}
        nameless: list[Node] = []
        by_name = self.by_name
        for one in parsed:
            for node in one.nodes:
                name = node.attributes.get("name")
                if not name:
                    nameless.append(node)
                elif name in by_name:
                    by_name[name].append(node)
                else:
                    by_name[name] = [node]
        self.nameless = nameless
        self.nameless_of: dict[str, list[Node]] = {}
        self.proxies: dict[str, Node] = {}
        self.found: dict[tuple[str, Node], Node] = {}
        #: Targets that were not found by their names, and which therefore may share them with others.
        self.by_identity: dict[Node, None] = {}

    def link(self, one: ParsedFile) -> None:
        """Link the references of one file."""
        # Ids are mostly UUIDs, which can be told by their first character.
        found, root = self.found, one.tree.root
        other_ids = {text for text in one.ids if text[:1] not in _STARTS and TYPE_MARK not in text}
        for node in one.nodes:
            attributes = node.attributes
            linked: list[str] | None = None
            for key, text in attributes.items():
                if text[:1] in _STARTS or TYPE_MARK in text or (other_ids and text.partition(" ")[0] in other_ids):
                    if key in _TEXT or _is_text_value(node, key):
                        continue
                    known = found.get((text, root))
                    targets = [known] if known is not None else self.targets(one, text.split())
                    if targets:
                        node.references[key] = targets
                        linked = [*(linked or ()), key]
            for key in linked or ():
                del attributes[key]
        for href in one.hrefs:
            target = self.elsewhere(one, href.text) or self.outside(one, href)
            href.holder.refer(href.tag, target)

    def elsewhere(self, one: ParsedFile, href: str) -> Node | None:
        """The object that an `href` names."""
        fragment = href.rpartition("#")[2]
        named = self.file_at(one, href) if file_of(href) else one
        if named is not None:
            return self.target(named, fragment)
        # The file was renamed or is not here; such an id is unique wherever it is.
        return self.ids.get(fragment) if _UUID(fragment) else None

    def file_at(self, one: ParsedFile, href: str) -> ParsedFile | None:
        """The file that an `href` names, if it belongs to the set."""
        return self.by_path.get(_normal(one.tree.path.parent / file_of(href)))

    def outside(self, one: ParsedFile, href: PendingHref) -> Node:
        """What stands for the target of an `href` that is in no file."""
        file, _, fragment = href.text.rpartition("#")
        is_outside = bool(file_of(href.text)) and self.file_at(one, href.text) is None
        # Names and ids are unique whatever the file is; positions are not, and other models have rules of their own.
        is_local = is_outside and (fragment.startswith("/") or SUFFIX not in file.rpartition("/")[2])
        made = self.proxy(href.text if is_local else fragment)
        if href.type:
            # Evidence for steps, no part of the reference.
            made.attributes.setdefault("class", href.type)
        return made

    def targets(self, one: ParsedFile, texts: list[str]) -> list[Node] | None:
        """The objects that the texts name; None if this is no reference."""
        found = []
        for text in texts:
            is_position = _POSITION(text) is not None
            if text.startswith(("/", "#/")) and not is_position and TYPE_MARK not in text:
                return None
            target = self.target(one, text)
            if target is None:
                if not (TYPE_MARK in text or _UUID(text) or is_position):
                    return None
                target = self.proxy(text)
            found.append(target)
        return found

    def target(self, one: ParsedFile, text: str) -> Node | None:
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

    def by_id(self, one: ParsedFile, text: str) -> Node | None:
        if TYPE_MARK in text:
            return None  # ids of this form are names, and may be out of date
        found = one.ids.get(text) or self.ids.get(text)
        if found is not None:
            self.by_identity[found] = None
        return found

    def named(self, one: ParsedFile, text: str) -> Node | None:
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
            fitting = self.fitting(read[-1], class_name)
            if len(read) > 1:
                fitting = [n for n in fitting if not _is_of_another(n, read[-2])]
            if len(fitting) > 1 and len(read) > 1:
                fitting = [n for n in fitting if n.parent is not None and n.parent.name == read[-2]] or fitting
            if fitting:
                found = fitting[0] if len(fitting) == 1 else next((n for n in fitting if n.root is one.tree.root), fitting[0])
                if not found.type:
                    found.target_class = class_name
                return found
        return None

    def fitting(self, name: str, class_name: str) -> list[Node]:
        """The objects of a name that a reference to such a class can mean."""
        found = [node for node in self.by_name.get(name, ()) if may_be(node, class_name)]
        if found or name != NO_NAME:
            return found
        if class_name not in self.nameless_of:
            self.nameless_of[class_name] = [node for node in self.nameless if is_of(node, local_name(class_name))]
        return self.nameless_of[class_name]

    def at(self, root: Node, text: str) -> Node | None:
        """The object at a position such as `//@swModel/@tasks.0`."""
        node = root
        # The first step is the root: nothing, or its number.
        for step in filter(None, text.strip("/").removeprefix("0").split("/")):
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

    def make_unique(self, notes: StepNotes) -> None:
        """Give names of their own to objects to which references were not by name, where the name does not tell them from others."""
        if not self.by_identity:
            return
        alike: dict[tuple[str, str, str], list[Node]] = {}
        for node in chain(chain.from_iterable(self.by_name.values()), self.nameless):
            alike.setdefault((node.name, node.tag, node.type), []).append(node)
        numbers: dict[str, int] = {}
        for node in self.by_identity:
            same = alike.get((node.name, node.tag, node.type), ())
            if len(same) < 2 or same[0] is node or (node.parent is not None and _is_qualified(node)):
                continue
            old = node.name
            base = old or NO_NAME
            number = numbers.get(base, 2)
            while f"{base}_{number}" in self.by_name:
                number += 1
            numbers[base] = number + 1
            node.attributes["name"] = f"{base}_{number}"
            self.by_name[node.name] = [node]
            notes.renamed(node, "made unique: references were by id, and are by name now", f"{old} -> {node.name}", "name")


def _is_qualified(node: Node) -> bool:
    return node.tag in ("literals", "ports", "features")


def _is_of_another(node: Node, holder: str) -> bool:
    """Whether the name of an object is qualified by its container, and that has another name."""
    return _is_qualified(node) and node.parent is not None and node.parent.name not in ("", holder)


def _is_text_value(node: Node, key: str) -> bool:
    """Whether an attribute is the text of a custom property or parameter extension."""
    if key == "value":
        return node.tag == "parameterExtensions" or local_name(node.type) in _TEXT_VALUES
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
