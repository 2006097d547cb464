"""Rows: a class of a system and a class of a project, and what each field becomes; read in both directions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, fields
from typing import Any, NamedTuple

from amalthea_uros.bridge.basics.json_text import default_value
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.basics.importing import Importing


class RowColumn(NamedTuple):
    """The feature for a field, and the conversion of its value to a project and back; None is left out in both directions."""

    feature: str
    build: Callable[[Any, Exporting], Any] = lambda value, _: value
    extract: Callable[[Any, Importing], Any] = lambda value, _: value


class Row:
    """A class of a system, the class of a project that has its meaning, and the fields that are kept in the comment."""

    def __init__(self, item: type[Any], kind: str, /, kept: tuple[str, ...] = (), **columns: RowColumn | str) -> None:
        self.item = item
        self.kind = kind
        self.kept = kept
        self.columns = {name: RowColumn(each) if isinstance(each, str) else each for name, each in columns.items()}
        self._defaults = {field.name: default_value(field) for field in fields(item)}

    def build(self, source: Any, context: Exporting, **more: Any) -> ProjectObject:
        """The object of a project.

        Parameters
        ----------
        more : features that no field has
        """
        values = {}
        for name, column in self.columns.items():
            value = getattr(source, name)
            if value is not None and value != ():
                values[column.feature] = column.build(value, context)
        made = ProjectObject(self.kind, **{**values, **more})
        context.keep(made, source, *(name for name in self.kept if name not in self.columns))
        return made

    def extract(self, item: ProjectObject, context: Importing, **known: Any) -> Any:
        """The object of a system; None if something is missing that it needs.

        Parameters
        ----------
        known : fields that no feature has
        """
        values: dict[str, Any] = {}
        for name, column in self.columns.items():
            given = item[column.feature]
            value = None if given is None else column.extract(given, context)
            if value is None:
                value = self._defaults[name]
                if value is MISSING:
                    return None
            values[name] = value
        values |= context.fields(item, self.item, self.kept)
        return self.item(**{**values, **known})


def reference(kind: str) -> tuple[Callable[[Any, Exporting], Any], Callable[[Any, Importing], Any]]:
    """A name that becomes a reference to an object of a kind."""
    return (
        lambda name, context: context.need(kind, name, context.holder),
        lambda target, context: context.name_of(kind, target),
    )


def refers(feature: str, kind: str) -> RowColumn:
    """A column with one name."""
    return RowColumn(feature, *reference(kind))


def refers_to_several(feature: str, kind: str) -> RowColumn:
    """A column with several names."""
    build, extract = reference(kind)

    def names(targets: Any, context: Importing) -> Any:
        result = tuple(extract(target, context) for target in targets)
        return None if None in result else result

    return RowColumn(feature, lambda names, context: [build(name, context) for name in names], names)


def choice(feature: str, literals: dict[Any, str]) -> RowColumn:
    """A column with a literal of an enumeration."""
    back = {literal: value for value, literal in literals.items()}
    return RowColumn(feature, lambda value, _: literals[value], lambda literal, _: back.get(literal))
