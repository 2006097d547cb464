"""Reading of `.iprx` files: plain XML, or a ZIP with it.

What the metamodel does not know is left out with a finding; a value that is not of its type and a reference that leads nowhere are
errors, because whatever stood for them would change what the project means.
"""

from __future__ import annotations

from pathlib import Path
from xml.parsers import expat

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.inchron.facts import NAMESPACE, features, is_a, metamodel, only_class
from amalthea_uros.inchron.objects import ProjectObject, parsed
from amalthea_uros.inchron.project import Project
from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind
from amalthea_uros.metamodel.source import FileText, SourceText
from amalthea_uros.xmi.emf.files import read_text
from amalthea_uros.xmi.emf.problems import MAX_DEPTH, has_doctype, line_at, location, malformed, too_deep

SUFFIX = ".iprx"

_TYPE = "http://www.w3.org/2001/XMLSchema-instance type"
_FAMILY = NAMESPACE.rpartition("/")[0]


def is_project_name(path: Path) -> bool:
    """Whether the name of a file is that of a project."""
    return path.suffix.lower() == SUFFIX


def read_project(path: Path) -> Project:
    """The project of a file.

    Raises
    ------
    ReadError : the file cannot be read, is no project, or contains values that are wrong; carries a finding for each.
    """
    return _Reader(path, read_text(path)).project()


def parse_project(path: Path, text: str) -> Project:
    """The project of a text; raises as `read_project`."""
    return _Reader(path, FileText(text)).project()


class _Reader:
    """One run.

    Attributes
    ----------
    stack : the open elements: objects, texts of attributes with several values, or None for what is left out
    """

    def __init__(self, path: Path, file: FileText) -> None:
        self.path = path
        self.file = file
        self.source = SourceText(file)
        self.prefixes: dict[str, str] = {}
        self.stack: list[ProjectObject | tuple[FeatureFact, list[str]] | None] = []
        self.names: list[tuple[str, int]] = []
        self.root: ProjectObject | None = None
        self.ids: dict[str, list[ProjectObject]] = {}
        self.references: list[tuple[ProjectObject, FeatureFact, str]] = []
        self.errors: list[Finding] = []
        self.unknown: dict[str, tuple[int, int]] = {}
        self.parser = expat.ParserCreate("utf-8", " ")
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.characters
        self.parser.StartNamespaceDeclHandler = self.declare
        self.parser.StartDoctypeDeclHandler = self.doctype

    def project(self) -> Project:
        """Read everything."""
        try:
            self.parser.Parse(self.file.utf8, True)
        except expat.ExpatError as error:
            opened = None
            if self.names:
                name, offset = self.names[-1]
                opened = name, line_at(self.file, offset)
            raise malformed(self.path, self.file, error, self.parser.ErrorByteIndex, opened) from None
        self.resolve()
        model = self.root["model"] if self.root is not None and not self.errors else None
        if not self.errors and (model is None or model.kind != "Model"):
            self.error("the project has no model", 0)
        if self.errors or model is None:
            raise ReadError(self.errors)
        findings = [self.left_out(name, *result) for name, result in self.unknown.items()]
        return Project(path=self.path, model=model, source=self.source, findings=tuple(findings))

    def error(self, message: str, offset: int, attribute: str = "") -> None:
        """Add an error."""
        where = location(self.path, self.source, offset, attribute)
        self.errors.append(Finding("INC001", Severity.ERROR, message, where, "Correct it, or export the project again."))

    def left_out(self, name: str, count: int, offset: int) -> Finding:
        """The finding for what the metamodel does not know."""
        times = f" ({count} times, this is the first)" if count > 1 else ""
        where = location(self.path, self.source, offset)
        return Finding("INC006", Severity.WARNING, f"{name} is not part of the INCHRON metamodel and left out{times}", where)

    def leave_out(self, name: str) -> None:
        """Count something that the metamodel does not know."""
        count, offset = self.unknown.get(name, (0, self.parser.CurrentByteIndex))
        self.unknown[name] = count + 1, offset

    def declare(self, prefix: str | None, uri: str) -> None:
        """Note a namespace."""
        self.prefixes[prefix or ""] = uri

    def doctype(self, *_arguments: object) -> None:
        """Refuse a document type."""
        raise has_doctype(self.path, self.file, self.parser.CurrentByteIndex)

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Begin an element."""
        offset = self.parser.CurrentByteIndex
        if len(self.stack) > MAX_DEPTH:
            raise too_deep(self.path, self.file, offset)
        self.names.append((tag.rpartition(" ")[2], offset))
        if not self.stack:
            self.begin(tag)
            return
        holder = self.stack[-1]
        feature = features(holder.kind).get(tag) if isinstance(holder, ProjectObject) else None
        if not isinstance(holder, ProjectObject) or feature is None:
            if isinstance(holder, ProjectObject):
                self.leave_out(f"{holder.kind}.{tag}")
            self.stack.append(None)
        elif feature.kind is FeatureKind.CONTAINMENT:
            self.stack.append(self.part(holder, feature, attributes))
        else:
            self.stack.append((feature, []))

    def begin(self, tag: str) -> None:
        """The root element."""
        namespace, _, name = tag.rpartition(" ")
        if name != "Root" or not namespace.startswith(_FAMILY):
            self.error(f"not an INCHRON project: the root element is {name!r}", self.parser.CurrentByteIndex)
            self.stack.append(None)
            return
        if namespace != NAMESPACE:
            self.leave_out(f"what version {namespace.rpartition('/')[2]} has beyond {NAMESPACE.rpartition('/')[2]}")
        self.root = ProjectObject("root.Root")
        self.stack.append(self.root)

    def part(self, holder: ProjectObject, feature: FeatureFact, attributes: dict[str, str]) -> ProjectObject | None:
        """An object within another one; None if its class is unknown or does not fit."""
        offset = self.parser.CurrentByteIndex
        kind = self.kind(attributes[_TYPE]) if _TYPE in attributes else feature.type
        if kind not in metamodel().classes or not is_a(kind, feature.type):
            self.leave_out(attributes.get(_TYPE, kind))
            return None
        if metamodel().classes[kind].abstract:
            concrete = only_class(kind)
            if concrete is None:
                self.error(f"{feature.name} does not state its class, such as xsi:type", offset)
                return None
            kind = concrete
        item = ProjectObject(kind)
        item.offset = offset
        if feature.many:
            holder.add(feature.name, item)
        else:
            holder[feature.name] = item
        for name, text in attributes.items():
            if " " not in name:
                self.attribute(item, name, text)
        return item

    def kind(self, typed: str) -> str:
        """The class that an attribute `xsi:type` names."""
        prefix, _, name = typed.rpartition(":")
        uri = self.prefixes.get(prefix, "")
        path = uri.removeprefix(_FAMILY).strip("/").split("/")[1:]
        package = "root" if not path else ".".join(path[1:])
        return f"{package}.{name}" if package else name

    def attribute(self, item: ProjectObject, name: str, text: str) -> None:
        """An attribute or a reference."""
        feature = features(item.kind).get(name)
        if feature is None or feature.kind is FeatureKind.CONTAINMENT:
            self.leave_out(f"{item.kind}.{name}")
        elif name == "intrinsicId":
            self.ids.setdefault(text, []).append(item)
        elif feature.kind is FeatureKind.REFERENCE:
            self.references.append((item, feature, text))
        else:
            self.value(item, feature, text)

    def value(self, item: ProjectObject, feature: FeatureFact, text: str) -> None:
        """Set an attribute."""
        try:
            result = parsed(feature.type, text)
        except ValueError as error:
            self.error(f"{feature.name} of {item.kind} {item.name!r}: {error}", item.offset, feature.name)
            return
        if feature.many:
            item.values.setdefault(feature.name, []).append(result)
        else:
            item[feature.name] = result

    def characters(self, text: str) -> None:
        """Text within an element."""
        if self.stack and isinstance(self.stack[-1], tuple):
            self.stack[-1][1].append(text)

    def end(self, _tag: str) -> None:
        """End an element."""
        result = self.stack.pop()
        self.names.pop()
        holder = self.stack[-1] if self.stack else None
        if isinstance(result, tuple) and isinstance(holder, ProjectObject):
            feature, texts = result
            if feature.kind is FeatureKind.REFERENCE:
                self.references.append((holder, feature, "".join(texts)))
            else:
                self.value(holder, feature, "".join(texts).strip())

    def resolve(self) -> None:
        """Let references refer to objects."""
        for item, feature, text in self.references:
            targets = [self.target(item, feature, each) for each in text.split()]
            result = [target for target in targets if target is not None]
            if feature.many:
                item[feature.name] = list(dict.fromkeys([*item[feature.name], *result]))
            elif len(targets) > 1:
                self.error(
                    f"{feature.name} of {item.kind} {item.name!r} refers to {len(targets)} objects", item.offset, feature.name
                )
            elif result:
                item[feature.name] = result[0]

    def target(self, item: ProjectObject, feature: FeatureFact, identity: str) -> ProjectObject | None:
        """The object with an id."""
        result = self.ids.get(identity, [])
        if len(result) == 1 and is_a(result[0].kind, feature.type):
            return result[0]
        reason = (
            "no object has that id"
            if not result
            else "several objects have that id"
            if len(result) > 1
            else f"it is a {result[0].kind}"
        )
        shown = identity[:40]
        self.error(f"{feature.name} of {item.kind} {item.name!r} refers to {shown!r}: {reason}", item.offset, feature.name)
        return None
