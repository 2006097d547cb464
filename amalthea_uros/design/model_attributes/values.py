"""Texts of values of a model, as files and people write them: numbers, words, quantities in the units of the file, names of objects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import StrEnum
from fractions import Fraction
from typing import Any, NamedTuple

from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.design.changes.key import UNSET
from amalthea_uros.design.model_attributes.keys import ModelKey
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import FREQUENCIES, RATES, SIZES, TIMES
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.naming import qualified_name
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.names import listed
from amalthea_uros.units import BIT_RATE, DATA_SIZE, FREQUENCY, TIME, Dimension, number_text, parse
from amalthea_uros.xmi.emf.plan import plans


class Assigned(NamedTuple):
    """A value for a feature of an object."""

    element: Element
    feature: str
    value: Any


class _Units(NamedTuple):
    """How quantities of a class are read: their dimension, and the sizes of the units of files, the largest first."""

    dimension: Dimension
    sizes: Mapping[Any, int]
    is_whole: bool


_VOLTAGE = Dimension("a voltage", {"uV": 1, "mV": 10**3, "V": 10**6}, "5 V")
_VOLTAGES = {unit: _VOLTAGE.units[unit.value] for unit in (am.VoltageUnit.V, am.VoltageUnit.MV, am.VoltageUnit.UV)}
_QUANTITIES: dict[type[Element], _Units] = {
    am.Time: _Units(TIME, TIMES, is_whole=True),
    am.Frequency: _Units(FREQUENCY, FREQUENCIES, is_whole=False),
    am.DataSize: _Units(DATA_SIZE, SIZES, is_whole=True),
    am.DataRate: _Units(BIT_RATE, RATES, is_whole=True),
    am.Voltage: _Units(_VOLTAGE, _VOLTAGES, is_whole=False),
}


def shown(key: ModelKey) -> str:
    """The present value as text."""
    if key.part is not None:
        return _shown_part(key.part)
    value = key.holder.__dict__.get(key.feature.name)
    if value is None or (key.feature.many and not value):
        return UNSET
    if key.feature.data_type is not None:
        return key.feature.data_type.format(value)
    return ", ".join(_reference_text(item) for item in (value if key.feature.many else [value]))


def _shown_part(part: Element) -> str:
    if type(part) not in _QUANTITIES:
        return UNSET if (value := getattr(part, "value", None)) is None else str(value).lower() if value is True else str(value)
    value, unit = getattr(part, "value", None), getattr(part, "unit", None)
    number = "" if value is None else number_text(Fraction(repr(value)) if isinstance(value, float) else value)
    return " ".join(filter(None, (number, "" if unit is None else _spelled(unit)))) or UNSET


def _spelled(unit: StrEnum) -> str:
    return unit.value.replace("PerSecond", "/s")


def _reference_text(target: Element) -> str:
    return str(target.__dict__.get("name") or qualified_name(target))


def assigned(key: ModelKey, text: str, model: Model) -> Iterator[Assigned]:
    """The values that a text sets.

    Raises
    ------
    ValueError : the text is no value of the key; says why, or what is possible.
    """
    feature, holder = key.feature, key.holder
    if feature.data_type is not None:
        yield Assigned(holder, feature.name, _attribute(holder, feature.xml_name, feature.data_type, text))
    elif feature.is_reference:
        names = [name for name in map(str.strip, text.split(",")) if name] if feature.many else [text.strip()]
        matches = [_target(name, feature.target, model) for name in names]
        yield Assigned(holder, feature.name, matches if feature.many else matches[0])
    elif (quantity := type(key.part) if key.part is not None else feature.target) in _QUANTITIES:
        value, unit = _quantity(text, _QUANTITIES[quantity], getattr(key.part, "unit", None))
        if key.part is None:
            yield Assigned(holder, feature.name, quantity(value=value, unit=unit))
        else:
            yield Assigned(key.part, "value", value)
            yield Assigned(key.part, "unit", unit)
    else:
        assert key.part is not None
        document = holder.document
        plan = plans(document.facts_version).of(type(key.part).__name__) if document is not None else None
        assert plan is not None
        (inner,) = plan.features
        yield Assigned(key.part, "value", _attribute(key.part, inner.xml_name, inner.data_type, text))


def _attribute(holder: Element, xml_name: str, data_type: Any, text: str) -> Any:
    """A number, a text, a truth value or a literal, within the limits of the version."""
    if issubclass(data_type.python_type, StrEnum):
        words = {word.value.casefold().replace("_", "").replace("-", ""): word.value for word in data_type.python_type}
        text = words.get(text.casefold().replace("_", "").replace("-", "").replace(" ", ""), text)
    value = data_type.parse(text)
    document = holder.document
    assert document is not None
    declared = facts(document.facts_version)
    feature = declared.feature(type(holder).__name__, xml_name)
    limit = declared.numbers.get(feature.type) if feature is not None else None
    if limit is not None and (value < limit.minimum or (limit.exclusive and value == limit.minimum)):
        raise ValueError(f"{text} is not {'greater than' if limit.exclusive else 'at least'} {limit.minimum}")
    return value


def _quantity(text: str, units: _Units, present: StrEnum | None) -> tuple[Any, Any]:
    """A number and its unit: that of the file if the number can be stated in it, otherwise that of the text or a smaller one."""
    amount = parse(text, units.dimension)
    written = text.strip().lstrip("+-0123456789.eE ")
    given = next((unit for unit in units.sizes if unit is not None and _spelled(unit) == written), None)
    for unit in (present, given, *units.sizes):
        if unit not in units.sizes:
            continue
        number = amount / units.sizes[unit]
        if units.is_whole and number.denominator == 1:
            return number.numerator, unit
        if not units.is_whole and Fraction(repr(float(number))) == number:
            return float(number), unit
    raise ValueError(f"{text!r} cannot be stated exactly in any unit")


def _target(name: str, target: type[Element], model: Model) -> Element:
    """The object of a class with a name, or with its qualified name where several have the same one."""
    every = [each for each in model.all(target) if isinstance(each.__dict__.get("name"), str)]
    matches = [each for each in every if each.__dict__["name"] == name] or [
        each for each in every if qualified_name(each) == name
    ]
    if len(matches) == 1:
        return matches[0]
    kind = target.__name__
    if matches:
        choices = list(dict.fromkeys(qualified_name(each) for each in matches))
        raise ValueError(f"several objects ({kind}) are called {name!r}: {listed(choices)}; choose one")
    names = list(dict.fromkeys(str(each.__dict__["name"]) for each in every))
    advice = did_you_mean(name, names) or (f"known: {listed(names)}" if names else "the model has none")
    raise ValueError(f"{name!r} is not the name of a {kind}; {advice}")


def checked(key: ModelKey, target: str, text: str, model: Model) -> list[Assigned]:
    """The values that a text sets; InvalidArgumentError with the name of the key if it is no value of it."""
    try:
        return list(assigned(key, text, model))
    except ValueError as error:
        raise InvalidArgumentError(f"{target}={text}: {error}") from None
