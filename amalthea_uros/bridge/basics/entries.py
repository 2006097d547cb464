"""Tables that map classes of perf to classes of AMALTHEA, and fields to features."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import MISSING, fields
from functools import partial
from typing import Any, NamedTuple

from amalthea_uros.bridge.basics.codecs import PLAIN, Codec
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.json_text import default_value
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.perf.named import Named


class FeatureColumn(NamedTuple):
    """The feature of AMALTHEA for a field of perf, by its Python name, and the conversion of its values."""

    feature: str
    codec: Codec = PLAIN


#: What a field becomes: a value of the feature of the same name, of another one, or one that is copied from another one.
Columns = dict[str, Codec | tuple[str, Codec] | str]


def _column(field: str, given: Codec | tuple[str, Codec] | str) -> FeatureColumn:
    if isinstance(given, Codec):
        return FeatureColumn(field, given)
    return FeatureColumn(given) if isinstance(given, str) else FeatureColumn(*given)


class ClassEntry:
    """A class of perf and the corresponding class of AMALTHEA; each column is a field of perf and what it becomes.

    A value that is not given in AMALTHEA becomes the default of the field; if there is no default, the object is incomplete, which is
    a finding.
    """

    def __init__(
        self, model_class: type[Any], amalthea_class: type[Element], /, **columns: Codec | tuple[str, Codec] | str
    ) -> None:
        self.model_class = model_class
        self.amalthea_class = amalthea_class
        self.columns = {name: _column(name, given) for name, given in columns.items()}
        self.is_named = issubclass(model_class, Named)
        declared = {field.name: field for field in fields(model_class)}
        self.has_origin = "origin" in declared
        self.is_activity = "locate" in declared
        self._defaults = {name: default_value(declared[name]) for name in columns}
        features = features_of(amalthea_class)
        self._extracted = tuple(
            (
                name,
                column.feature,
                () if features[column.feature].many else None,
                None if column.codec is PLAIN else column.codec.extract,
                self._defaults[name],
            )
            for name, column in self.columns.items()
        )
        self._xml_names = {column.feature: features[column.feature].xml_name for column in self.columns.values()}

    def create(self, item: Any, context: Building) -> Element:
        """The object of AMALTHEA with only its name, as a target of references."""
        element = self.amalthea_class(name=item.name)
        context.register(item, element)
        return element

    def fill(self, element: Element, item: Any, context: Building) -> Element:
        """Set all features."""
        if self.is_named:
            context.at(item)
        known = context.known_features(self.amalthea_class)
        for name, column in self.columns.items():
            value = getattr(item, name)
            if value is None or value == () or value == "":
                continue
            # A feature that the version does not have is omitted if it has the default value; other values are refused by the writer.
            if self._xml_names[column.feature] in known or value != self._defaults[name]:
                setattr(element, column.feature, column.codec.build(value, context))
        return element

    def build(self, item: Any, context: Building) -> Any:
        """The object of AMALTHEA for one that is not a target of references."""
        return self.fill(self.amalthea_class(), item, context)

    def extract(self, element: Element, context: Extracting) -> Any:
        """The object of perf; None, with a finding, if a required value is missing."""
        found = self.complete(element, context)
        if found is None:
            context.drop(element)
        return found

    def complete(self, element: Element, context: Extracting, *, strictly: bool = False) -> Any:
        """The object of perf; None, with a finding, if a required value is missing.

        Parameters
        ----------
        strictly : a value that is given but cannot be read is not replaced by the default
        """
        values = self.values(element, context, strictly=strictly)
        if values is None:
            return None
        if self.is_named:
            values["name"] = context.names[element]
        if self.has_origin:
            values["origin"] = partial(context.location, element)
        if self.is_activity:
            values["locate"] = partial(context.location, element)
        return self.model_class(**values)

    def values(self, element: Element, context: Extracting, *, strictly: bool = False) -> dict[str, Any] | None:
        """The fields of perf for the columns; None, with a finding, if a required value is missing."""
        values: dict[str, Any] = {}
        features = element.__dict__  # quicker than by the descriptors, which also make a list for each unset feature
        for name, feature, unset, extract, default in self._extracted:
            given = features.get(feature, unset)
            value = None if given is None else given if extract is None else extract(given, context, element)
            if value is None:
                value = default
                if value is MISSING or (strictly and given is not None):
                    flaw = "has no" if given is None else "has an incomplete"
                    what = self._xml_names[feature]
                    context.note("EXT004", f"{type(element).__name__} is incomplete: it {flaw} {what}", element)
                    return None
            values[name] = value
        return values


class ClassTable:
    """Entries for the alternatives of one type."""

    def __init__(self, *entries: ClassEntry) -> None:
        self.by_model_class: Mapping[type[Any], ClassEntry] = {entry.model_class: entry for entry in entries}
        self.by_amalthea_class: Mapping[type[Element], ClassEntry] = {entry.amalthea_class: entry for entry in entries}

    def create_all(self, items: Iterable[Any], context: Building) -> list[Element]:
        """Objects whose features are set later, by `fill`."""
        return [self.by_model_class[type(item)].create(item, context) for item in items]

    def fill(self, elements: Iterable[Element], items: Iterable[Any], context: Building) -> None:
        """Set the features of objects that were created by `create_all`."""
        for element, item in zip(elements, items, strict=True):
            self.by_model_class[type(item)].fill(element, item, context)

    def build(self, item: Any, context: Building) -> Any:
        """The object of AMALTHEA."""
        return self.by_model_class[type(item)].build(item, context)

    def extract(self, element: Element, context: Extracting) -> Any:
        """The object of perf; None if there is no counterpart."""
        entry = self.by_amalthea_class.get(type(element))
        if entry is None:
            context.leave_out(element)
            context.drop(element)
            return None
        return entry.extract(element, context)

    def extract_all(self, elements: Iterable[Element], context: Extracting) -> tuple[Any, ...]:
        """The objects of perf; those without counterpart are left out."""
        return tuple([item for element in elements if (item := self.extract(element, context)) is not None])

    def extract_each(self, elements: Iterable[Element], context: Extracting) -> tuple[Any, ...] | None:
        """The objects of perf; None if one of them is incomplete."""
        found = tuple(self.extract(element, context) for element in elements)
        return None if None in found else found


def part(table: ClassTable) -> Codec:
    """An object within another one."""
    return Codec(table.build, lambda value, context, _element: table.extract(value, context))


def parts(table: ClassTable) -> Codec:
    """Objects within another one, in order; those that are incomplete are left out."""
    return Codec(
        lambda items, context: [table.build(item, context) for item in items],
        lambda values, context, _element: table.extract_all(values, context),
    )


def all_parts(table: ClassTable) -> Codec:
    """Objects within another one, in order; if one of them is incomplete, all are unknown."""
    return Codec(parts(table).build, lambda values, context, _element: table.extract_each(values, context))
