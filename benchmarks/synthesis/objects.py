"""Objects of an AMALTHEA model without typed classes, and their XML as APP4MC writes it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, TypeAlias
from urllib.parse import quote_plus

from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from amalthea_uros.metamodel.versions import VersionFacts

Value: TypeAlias = "str | bool | int | float | Object | list[Object]"

_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", '"': "&quot;", "\n": "&#xA;", "\r": "&#xD;", "\t": "&#x9;"})
_HEADER = '<?xml version="1.0" encoding="UTF-8"?>\n'
_NAMESPACES = (
    ' xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:am="{}"'
)


class Object:
    """One object: its class, the number of the file that holds it, and the values of its features by name."""

    __slots__ = ("cls", "document", "unique_name", "values")

    def __init__(self, cls: str, document: int, owners: Iterable[str], values: dict[str, Value]) -> None:
        self.cls = cls
        self.document = document
        self.unique_name = unique_name(cls, [*owners, str(values.get("name", ""))])
        self.values = values

    def add(self, feature: str, *children: Object) -> None:
        """Appends to a feature of many values."""
        known = self.objects(feature)
        known.extend(children)
        self.values[feature] = known

    def objects(self, feature: str) -> list[Object]:
        """The children or the targets of a feature."""
        match self.values.get(feature, []):
            case list(several):
                return several
            case Object() as one:
                return [one]
            case other:
                raise TypeError(f"{self.cls}.{feature} is {other!r}")

    @property
    def name(self) -> str:
        """The name as it stands in the file."""
        return str(self.values["name"])


def unique_name(cls: str, names: Iterable[str]) -> str:
    """The id of an object: its encoded names and its class."""
    return f"{'/'.join(_encoded(name) or 'no-name' for name in names)}?type={cls}"


def _encoded(name: str) -> str:
    """`name` as Java's URLEncoder writes it, which differs from Python's form encoding in two characters."""
    return quote_plus(name, safe="*").replace("~", "%7E")


@dataclass(frozen=True, slots=True)
class _Row:
    name: str
    kind: FeatureKind
    type: str
    default: str | None
    typed_href: bool


@dataclass(frozen=True, slots=True)
class _Shape:
    referable: bool
    rows: tuple[_Row, ...]
    names: frozenset[str]


class Writer:
    """Gives the XML of objects: everything about order, defaults and types comes from the facts of one version."""

    def __init__(self, facts: VersionFacts) -> None:
        self._facts = facts
        self._shape = cache(self._declared)

    def text(self, root: Object) -> str:
        """The whole file of a root object."""
        lines = [_HEADER]
        self._write(lines, root, "am:Amalthea" + _NAMESPACES.format(self._facts.namespace), root.cls, "")
        return "".join(lines)

    def _declared(self, cls: str) -> _Shape:
        rows = tuple(self._row(feature) for feature in self._facts.features(cls) if feature.stored)
        return _Shape("IReferable" in self._facts.supertypes(cls), rows, frozenset(row.name for row in rows))

    def _row(self, feature: FeatureFact) -> _Row:
        typed_href = feature.kind is FeatureKind.REFERENCE and self._facts.classes[feature.type].abstract
        return _Row(feature.name, feature.kind, feature.type, _written_default(feature), typed_href)

    def _write(self, lines: list[str], element: Object, tag: str, declared: str, indent: str) -> None:
        shape = self._shape(element.cls)
        if not shape.names.issuperset(element.values):
            raise ValueError(f"{self._facts.version}: {element.cls} has no {set(element.values) - shape.names}")
        attributes = [tag]
        if element.cls != declared:
            attributes.append(f'xsi:type="am:{element.cls}"')
        if shape.referable:
            attributes.append(f'xmi:id="{element.unique_name}"')
        children: list[tuple[_Row, Object]] = []
        for row in shape.rows:
            value = element.values.get(row.name, row.default)
            if value is None or value == []:
                continue
            if row.kind is FeatureKind.ATTRIBUTE:
                attributes.append(f'{row.name}="{_literal(value)}"')
                continue
            targets = element.objects(row.name)
            if row.kind is FeatureKind.REFERENCE and all(target.document == element.document for target in targets):
                attributes.append(f'{row.name}="{" ".join(target.unique_name for target in targets)}"')
            else:
                children.extend((row, target) for target in targets)
        if not children:
            lines.append(f"{indent}<{' '.join(attributes)}/>\n")
            return
        lines.append(f"{indent}<{' '.join(attributes)}>\n")
        for row, child in children:
            if row.kind is FeatureKind.CONTAINMENT:
                self._write(lines, child, row.name, row.type, indent + "  ")
            else:
                lines.append(f"{indent}  {_href(row, child)}\n")
        lines.append(f"{indent}</{tag.partition(' ')[0]}>\n")


def _href(row: _Row, target: Object) -> str:
    typed = f' xsi:type="am:{target.cls}"' if row.typed_href else ""
    return f'<{row.name}{typed} href="amlt:/#{target.unique_name}"/>'


def _literal(value: Value) -> str:
    """The text of a value; floats stay between 0.001 and 1e7, where Java and Python agree."""
    return str(value).lower() if isinstance(value, bool) else str(value).translate(_ESCAPES)


def _written_default(feature: FeatureFact) -> str | None:
    """The literal that stands in the file for an unset attribute with an explicit default."""
    if feature.default is None:
        return None
    match feature.type:
        case "Address":
            return hex(int(feature.default))
        case "EFloat":
            return str(float(feature.default))
    return feature.default
