"""Conversion of values between `perf` and AMALTHEA, in both directions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from fractions import Fraction
from typing import Any, NamedTuple

from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel import magnitudes
from amalthea_uros.metamodel.classes_enums import DataRateUnit, DataSizeUnit
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import bits, bits_per_second, hertz, picoseconds


class Codec(NamedTuple):
    """Two functions that are inverse to each other; None is a value that is not given.

    Attributes
    ----------
    build : value of perf -> value of a feature
    extract : value of a feature, and the object that has it -> value of perf
    """

    build: Callable[[Any, Building], Any]
    extract: Callable[[Any, Extracting, Element], Any]

    def build_given(self, value: Any, context: Building) -> Any:
        """The value of a feature; None for one that is not given."""
        return None if value is None else self.build(value, context)

    def extract_given(self, value: Any, context: Extracting, element: Element) -> Any:
        """The value of perf; None for one that is not given."""
        return None if value is None else self.extract(value, context, element)


#: Texts, numbers, truth values.
PLAIN = Codec(lambda value, _: value, lambda value, _context, _element: value)

#: Numbers that AMALTHEA holds as floating-point ones.
FLOAT = Codec(lambda value, _: float(value), lambda value, _context, _element: value)


def marked(key: str, default: bool) -> Codec:
    """A truth value as a custom property, for what AMALTHEA has no attribute for; the default is not written."""

    def build(value: bool, _context: Building) -> list[am.CustomProperty]:
        return [] if value is default else [am.CustomProperty(key=key, value=am.BooleanObject(value=value))]

    def extract(properties: Any, _context: Extracting, _element: Element) -> bool:
        given = [item.value.value for item in properties if item.key == key and isinstance(item.value, am.BooleanObject)]
        return not default if (not default) in given else default

    return Codec(build, extract)


def enumeration(pairs: Mapping[StrEnum, StrEnum]) -> Codec:
    """Literals by a table; literals of AMALTHEA that are not in the table become None."""
    back = {literal: value for value, literal in pairs.items()}

    def build(value: StrEnum, context: Building) -> StrEnum | None:
        if value not in pairs:
            context.refuse_literal(value)
        return pairs.get(value)

    return Codec(build, lambda value, _context, _element: back.get(value))


def same_names(model_enum: type[StrEnum], amalthea_enum: type[StrEnum], **others: str) -> Codec:
    """Literals that have the same names on both sides, with exceptions.

    Parameters
    ----------
    others : name of the literal in `perf` -> its name in AMALTHEA
    """
    return enumeration({literal: amalthea_enum[others.get(literal.name, literal.name)] for literal in model_enum})


# Quantities. Values that are not given or whose unit is undefined become None.

_SIZE_UNITS = (DataSizeUnit.B, DataSizeUnit.BIT)
_RATE_UNITS = (
    DataRateUnit.GBIT_PER_SECOND,
    DataRateUnit.MBIT_PER_SECOND,
    DataRateUnit.KBIT_PER_SECOND,
    DataRateUnit.BIT_PER_SECOND,
)


def build_time(value: int | None) -> am.Time | None:
    """Picoseconds in the largest unit that gives a whole number."""
    return None if value is None else magnitudes.time_of(value)


def _build_frequency(value: Fraction | None, context: Building) -> am.Frequency | None:
    if value is None:
        return None
    found = magnitudes.frequency_of(value)
    if found is None:
        context.refuse(None, f"the frequency {value} Hz has no exact decimal representation")
    return found


def _build_size(value: int | None, _context: Building) -> am.DataSize | None:
    if value is None:
        return None
    unit = next(unit for unit in _SIZE_UNITS if value % magnitudes.SIZES[unit] == 0)
    return am.DataSize(value=value // magnitudes.SIZES[unit], unit=unit)


def _build_rate(value: int | None, _context: Building) -> am.DataRate | None:
    if value is None:
        return None
    unit = next(unit for unit in _RATE_UNITS if value % magnitudes.RATES[unit] == 0)
    return am.DataRate(value=value // magnitudes.RATES[unit], unit=unit)


TIME = Codec(lambda value, _: build_time(value), lambda value, _context, _element: picoseconds(value))
FREQUENCY = Codec(_build_frequency, lambda value, _context, _element: hertz(value))
SIZE = Codec(_build_size, lambda value, _context, _element: bits(value))
RATE = Codec(_build_rate, lambda value, _context, _element: bits_per_second(value))


def time_property(key: str) -> Codec:
    """A time as a custom property, for what AMALTHEA has no attribute for."""

    def build(value: int, _context: Building) -> list[am.CustomProperty]:
        return [am.CustomProperty(key=key, value=build_time(value))]

    def extract(properties: Any, _context: Extracting, _element: Element) -> int | None:
        given = (item.value for item in properties if item.key == key)
        return next((picoseconds(value) for value in given if isinstance(value, am.Time)), None)

    return Codec(build, extract)


def _extract_times(values: list[am.Time], _context: Extracting, _element: Element) -> tuple[int, ...] | None:
    times = [picoseconds(value) for value in values]
    return None if None in times else tuple(time for time in times if time is not None)


#: All of them, or none if one is unknown.
TIMES = Codec(lambda values, _: [build_time(value) for value in values], _extract_times)


# What a model does not state

#: AMALTHEA has no class for what is incomplete; the reason is a property of an empty object.
_INCOMPLETE = "incomplete"


def build_reason(reason: str) -> list[am.CustomProperty]:
    """Why an object is incomplete, as its properties."""
    return [am.CustomProperty(key=_INCOMPLETE, value=am.StringObject(value=reason))]


def extract_reason(element: am.IAnnotatable) -> str | None:
    """Why an object is incomplete; None if no property says so."""
    values = (item.value for item in element.custom_properties if item.key == _INCOMPLETE)
    return next((value.value or "" for value in values if isinstance(value, am.StringObject)), None)


# References


def reference(kind: ObjectKind) -> Codec:
    """The name of an object."""

    def build(name: str | None, context: Building) -> Element | None:
        return None if name is None else context.find(kind, name)

    return Codec(build, _name_of)


def references(kind: ObjectKind) -> Codec:
    """The names of objects, in order."""

    def build(names: tuple[str, ...], context: Building) -> list[Element]:
        return [found for name in names if (found := context.find(kind, name)) is not None]

    def extract(values: list[Element], context: Extracting, element: Element) -> tuple[str, ...]:
        return tuple(name for value in values if (name := _name_of(value, context, element)) is not None)

    return Codec(build, extract)


def all_references(kind: ObjectKind) -> Codec:
    """The names of objects, in order; if one of them is not taken into account, all are unknown."""
    some = references(kind)

    def extract(values: list[Element], context: Extracting, element: Element) -> tuple[str, ...] | None:
        found: tuple[str, ...] = some.extract(values, context, element)
        return found if len(found) == len(values) else None

    return Codec(some.build, extract)


def _name_of(value: Element | None, context: Extracting, element: Element) -> str | None:
    if value is None:
        return None
    name = context.names.get(value)
    if name is None or value in context.dropped:
        what = getattr(value, "name", None) or value
        is_there = value.document is not None and value.unresolved is None
        why = "was not extracted" if name else "is not used by the analysis" if is_there else "is not part of the model"
        context.note("EXT003", f"reference ignored: {type(value).__name__} {what!r} {why}", element)
        return None
    return name
