"""A project as the text of an `.iprx` file: canonical, so that equal projects give equal files."""

from __future__ import annotations

from typing import Any
from uuid import UUID

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.inchron.facts import NAMESPACE, features, namespace_of, package_of, prefix_of
from amalthea_uros.inchron.ids import NAMESPACE as NAMESPACE_OF_IDS
from amalthea_uros.inchron.ids import intrinsic_ids
from amalthea_uros.inchron.objects import ProjectObject, default_of, problems
from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind
from amalthea_uros.xmi.emf.escape import escape, impossible_character

_HEADER = '<?xml version="1.0" encoding="UTF-8" standalone="no" ?>\n'


def project_text(model: ProjectObject, namespace: UUID = NAMESPACE_OF_IDS) -> str:
    """The text of the file of a model.

    Parameters
    ----------
    namespace : what the ids of objects depend on, besides names

    Raises
    ------
    WriteError : the metamodel does not allow the project; each reason is a finding.
    """
    link_opposites(model)
    if result := [_finding(item, reason) for item, reason in problems(model)]:
        raise WriteError(result)
    return _ProjectWriter(model, namespace).text()


def link_opposites(model: ProjectObject) -> None:
    """Make references that mirror each other do so: whichever end is stated, both are written."""
    for item in model.walk():
        for name, feature in features(item.kind).items():
            if feature.opposite and feature.kind is FeatureKind.REFERENCE and name in item.values:
                for target in item.values[name] if feature.many else (item.values[name],):
                    if feature.opposite in features(target.kind):
                        _link(target, feature.opposite, item)


def _link(item: ProjectObject, name: str, target: ProjectObject) -> None:
    if not item.feature(name).many:
        item.values.setdefault(name, target)
    elif target not in item[name]:
        item.add(name, target)


def _finding(item: ProjectObject, reason: str) -> Finding:
    named = item
    while not named.name and named.owner is not None:
        named = named.owner
    of = "" if named is item else f"a {item.kind} of "
    message = f"the INCHRON metamodel does not allow {of}{named.kind} {named.name!r}: {reason}"
    remedy = "State in the model what is missing, or a value that fits."
    return Finding("INC002", Severity.ERROR, message, None, remedy, named.name)


class _ProjectWriter:
    def __init__(self, model: ProjectObject, namespace: UUID) -> None:
        self.model = model
        self.ids = intrinsic_ids(model, namespace)
        self.lines: list[str] = []

    def text(self) -> str:
        packages = {package_of(item.kind) for item in self.model.walk()} - {"root"}
        declared = [
            ("xmi", "http://www.omg.org/XMI"),
            ("xsi", "http://www.w3.org/2001/XMLSchema-instance"),
            ("root", NAMESPACE),
        ]
        declared += [(prefix_of(package), namespace_of(package)) for package in sorted(packages)]
        attributes = "".join(f' xmlns:{prefix}="{uri}"' for prefix, uri in declared)
        self.write("model", "ContainerElement", self.model, 1)
        return f'{_HEADER}<root:Root xmi:version="2.0"{attributes}>\n' + "\n".join(self.lines) + "\n</root:Root>\n"

    def write(self, tag: str, declared: str, item: ProjectObject, depth: int) -> None:
        """Write an object as an element."""
        indent = "  " * depth
        attributes = f' xsi:type="{_typed(item.kind)}"' if item.kind != declared else ""
        if item in self.ids:
            attributes += f' intrinsicId="{self.ids[item]}"'
        for name, feature in features(item.kind).items():
            if feature.kind is not FeatureKind.CONTAINMENT and name in item.values:
                attributes += self.attribute(feature, item.values[name])
        parts = list(item.parts())
        lists = self.texts(item)
        if not parts and not lists:
            self.lines.append(f"{indent}<{tag}{attributes}/>")
            return
        self.lines.append(f"{indent}<{tag}{attributes}>")
        self.lines += [f"{indent}  {line}" for line in lists]
        for feature, part in parts:
            self.write(feature.name, feature.type, part, depth + 1)
        self.lines.append(f"{indent}</{tag}>")

    def attribute(self, feature: FeatureFact, value: Any) -> str:
        """An attribute with the blank before it; nothing for a default value."""
        if feature.kind is FeatureKind.REFERENCE:
            text = " ".join(self.ids[target] for target in (value if feature.many else (value,)))
            return f' {feature.name}="{text}"' if text else ""
        if feature.many or value == default_of(feature):
            return ""
        return f' {feature.name}="{escape(_spelled(value))}"'

    def texts(self, item: ProjectObject) -> list[str]:
        """Attributes with several values, as elements."""
        several = ((n, f) for n, f in features(item.kind).items() if f.many and f.kind is FeatureKind.ATTRIBUTE)
        return [f"<{name}>{escape(_spelled(value))}</{name}>" for name, _ in several for value in item[name]]


def _typed(kind: str) -> str:
    return f"{prefix_of(package_of(kind))}:{kind.rpartition('.')[2]}"


def _spelled(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return repr(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    text = str(value)
    if (character := impossible_character(text)) is not None:
        message = f"{text!r} contains the character {character!r}, which XML does not allow"
        raise WriteError([Finding("INC002", Severity.ERROR, message, None, "Rename the object.")])
    return text
