"""Changes of a system, and sweeps over several values of a property, as a user writes them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from math import prod
from typing import NamedTuple, TypeAlias

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import FREQUENCY, TIME, parse

FORM, EXAMPLE = "OBJECT.KEY=VALUE", "Executor_Task.period=2ms"

#: The first equals sign after a key; one before it belongs to the name of the object.
_QUANTITY = re.compile(r"[\d.]+ [^\W\d]+")
_ASSIGNMENT = r"(?s)(.*?\.\s*\w+\s*)=(.*)"


@dataclass(frozen=True, slots=True)
class Change:
    """A value for one property of an object.

    Attributes
    ----------
    object : name of an object, or of a section of a description; "" if the key alone says what is changed
    key : what is changed, such as `period`
    value : with its unit, as the user wrote it
    """

    object: str
    key: str
    value: str

    @property
    def target(self) -> str:
        """The object and the key, such as "Executor_Task.period"."""
        return f"{self.object}.{self.key}".removeprefix(".")

    def __str__(self) -> str:
        return f"{self.target}={self.value}"


def compact(text: str) -> str:
    """A quantity without the blank before its unit, so that equal ones have equal texts; names stay as they are."""
    return text.replace(" ", "") if _QUANTITY.fullmatch(text) else text


#: Changes as callers give them: `{"Task.period": "2 ms"}` or `["Task.period=2ms"]`.
Changes: TypeAlias = Mapping[str, object] | Iterable[str | Change]


def as_changes(changes: Changes) -> tuple[Change, ...]:
    """Changes in any of the forms that callers give.

    Raises
    ------
    InvalidArgumentError : a text is not of the form of a change.
    """
    if isinstance(changes, Mapping):
        return tuple(
            Change(*split_target(target, target, FORM, EXAMPLE, needs_object=False), str(value))
            for target, value in changes.items()
        )
    if not isinstance(changes, Iterable):
        raise TypeError(f'expected changes such as {{"Task.period": "2 ms"}}, not {changes!r}')
    return tuple(change if isinstance(change, Change) else parse_change(change) for change in one_or_several(changes))


def parse_change(text: str) -> Change:
    """A change written as `OBJECT.KEY=VALUE`.

    Keys have no dots, so those before the last one belong to the name of the object.

    Raises
    ------
    InvalidArgumentError : the text is not of this form.
    """
    target, value = split_assignment(text, FORM, EXAMPLE)
    name, key = split_target(target, text, FORM, EXAMPLE, needs_object=False)
    return Change(name, key, value)


def split_assignment(text: str, form: str, example: str) -> tuple[str, str]:
    """What is before and after the equals sign; raises as `parse_change`."""
    match = re.fullmatch(_ASSIGNMENT, text)
    target, value = (part.strip() for part in (match.groups() if match else text.partition("=")[::2]))
    if not target or not value:
        raise InvalidArgumentError(f"{text!r} is not of the form {form}; an example: {example}")
    return target, value


def split_target(target: str, text: str, form: str, example: str, *, needs_object: bool = True) -> tuple[str, str]:
    """The name of the object and the key, which values of a description can have alone; raises as `parse_change`."""
    name, dot, key = target.rpartition(".")
    if not key or ((dot or needs_object) and not name):
        raise InvalidArgumentError(f"{text!r} does not name an object and a key; expected {form}, e.g. {example}")
    return name, key


SWEEP_FORM, SWEEP_EXAMPLE = "OBJECT.KEY=FROM..TO/STEP or OBJECT.KEY=A,B,C", "Executor_Task.period=1ms..10ms/1ms"
#: More variants than this are a mistake rather than a plan.
MAX_VARIANTS = 1_000_000

_RANGE = r"(?P<start>[^/]+?)\s*\.\.\s*(?P<stop>[^/]+?)\s*/\s*(?P<step>[^/]+)"
_NUMBER = r"(?a)([+-]?\d+)(?:\s*(ticks?))?"
_UNIT = r"[^\d\s]+$"


@dataclass(frozen=True, slots=True)
class Sweep:
    """Values for one property of an object, in the order in which they are tried."""

    object: str
    key: str
    values: Sequence[str]

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", one_or_several(self.values))

    def changes(self) -> Iterator[Change]:
        """A change for each value."""
        return (Change(self.object, self.key, value) for value in self.values)


class _Amount(NamedTuple):
    """A number with a unit; the value is in the internal unit, of which the unit has a number.

    Attributes
    ----------
    kind : only amounts of the same kind can be compared
    """

    value: Fraction
    kind: str
    unit: str
    size: int


#: Sweeps as callers give them: `{"Task.period": ["1 ms", "2 ms"]}` or `["Task.period=1ms..5ms/1ms"]`.
Sweeps: TypeAlias = Mapping[str, Sequence[object]] | Iterable[str | Sweep]


def as_sweeps(sweeps: Sweeps) -> tuple[Sweep, ...]:
    """Sweeps in any of the forms that callers give.

    Raises
    ------
    InvalidArgumentError : a text is not of the form of a sweep, or a list of values is empty.
    """
    if isinstance(sweeps, Mapping):
        return tuple(_listed(target, values) for target, values in sweeps.items())
    return tuple(each if isinstance(each, Sweep) else parse_sweep(each) for each in one_or_several(sweeps))


def _listed(target: str, values: Sequence[object]) -> Sweep:
    if isinstance(values, str):
        return parse_sweep(f"{target}={values}")
    if not values:
        raise InvalidArgumentError(f"{target!r} has no values to try")
    return Sweep(*split_target(target, target, SWEEP_FORM, "Executor_Task.period", needs_object=False), tuple(map(str, values)))


def parse_sweep(text: str) -> Sweep:
    """A sweep written as `OBJECT.KEY=FROM..TO/STEP`, with TO if a step ends there, or as `OBJECT.KEY=A,B,C`.

    Raises
    ------
    InvalidArgumentError : the text has neither form, or the range is empty or too large.
    """
    target, values = split_assignment(text, SWEEP_FORM, SWEEP_EXAMPLE)
    name, key = split_target(target, text, SWEEP_FORM, SWEEP_EXAMPLE, needs_object=False)
    if match := re.fullmatch(_RANGE, values):
        return Sweep(name, key, _steps(text, **match.groupdict()))
    if ".." in values and "," not in values:
        raise InvalidArgumentError(f"{text!r} has no step; expected {SWEEP_FORM}, e.g. {SWEEP_EXAMPLE}")
    listed = tuple(value.strip() for value in values.split(","))
    if not all(listed):
        raise InvalidArgumentError(f"{text!r} has an empty value in its list; expected {SWEEP_FORM}, e.g. {SWEEP_EXAMPLE}")
    return Sweep(name, key, listed)


def variants(sweeps: Sequence[Sweep]) -> Iterator[tuple[Change, ...]]:
    """Each combination of the values of sweeps; the last sweep changes fastest.

    Raises
    ------
    InvalidArgumentError : more than `MAX_VARIANTS`, or two sweeps of the same property.
    """
    count_variants(sweeps)
    return product(*(sweep.changes() for sweep in sweeps))


def count_variants(sweeps: Sequence[Sweep]) -> int:
    """The number of variants; raises as `variants`."""
    count = combinations(sweeps)
    if count > MAX_VARIANTS:
        raise InvalidArgumentError(
            f"the sweeps have {count:,} variants; at most {MAX_VARIANTS:,} are possible, use larger steps"
        )
    return count


def sampled(sweeps: Sequence[Sweep], count: int, seed: int) -> Iterator[tuple[Change, ...]]:
    """Some combinations of the values of sweeps, none twice, at random; in the order of `variants`.

    Equal seeds give equal combinations. If there are not more than `count`, all of them.

    Raises
    ------
    InvalidArgumentError : two sweeps of the same property.
    """
    from random import Random  # imports eight other modules

    total = combinations(sweeps)
    numbers = range(total) if count >= total else sorted(Random(seed).sample(range(total), count))
    return (_variant(sweeps, number) for number in numbers)


def _variant(sweeps: Sequence[Sweep], number: int) -> tuple[Change, ...]:
    """The combination with a number, as `variants` counts from 0."""
    changes = []
    for sweep in reversed(sweeps):
        number, index = divmod(number, len(sweep.values))
        changes.append(Change(sweep.object, sweep.key, sweep.values[index]))
    return tuple(reversed(changes))


def combinations(sweeps: Sequence[Sweep]) -> int:
    """The number of combinations of the values.

    Raises
    ------
    InvalidArgumentError : two sweeps of the same property.
    """
    targets = [f"{sweep.object}.{sweep.key}" for sweep in sweeps]
    for target in targets:
        if targets.count(target) > 1:
            raise InvalidArgumentError(f"{target!r} is swept more than once; write all its values in one sweep")
    return prod(len(sweep.values) for sweep in sweeps)


def _steps(text: str, start: str, stop: str, step: str) -> Sequence[str]:
    try:
        amounts = [_amount(part) for part in (start, stop, step)]
    except ValueError as error:
        raise InvalidArgumentError(f"{text}: {error}") from None
    if len({amount.kind for amount in amounts}) > 1:
        raise InvalidArgumentError(f"{text}: start, end and step are not of the same kind, e.g. all times")
    # All other units are multiples of the finest one, so each value in it has a finite decimal form.
    finest = min(amounts, key=lambda amount: amount.size)
    first, last, width = (amount.value / finest.size for amount in amounts)
    if width <= 0:
        raise InvalidArgumentError(f"{text}: the step {step!r} is not greater than zero")
    if last < first:
        raise InvalidArgumentError(f"{text}: the range ends before it starts")
    count = (last - first) // width + 1
    if count > MAX_VARIANTS:
        raise InvalidArgumentError(
            f"{text}: the range has {count:,} values; at most {MAX_VARIANTS:,} are possible, use a larger step"
        )
    return tuple(f"{_decimal(first + index * width)} {finest.unit}".rstrip() for index in range(count))


def _amount(text: str) -> _Amount:
    """A whole number, ticks, or a quantity with a unit; ValueError for anything else."""
    if match := re.fullmatch(_NUMBER, text):
        unit = "ticks" if match[2] else ""
        return _Amount(Fraction(match[1]), unit, unit, 1)
    found = re.search(_UNIT, text)
    unit = found[0] if found else ""
    dimension = FREQUENCY if unit in FREQUENCY.units else TIME
    value = parse(text, dimension)
    return _Amount(value, dimension.article, unit, dimension.units[unit])


def _decimal(number: Fraction) -> str:
    """A number with a finite decimal form, all its digits."""
    if number.denominator == 1:
        return str(number.numerator)
    digits = next(digits for digits in range(1, 100) if 10**digits % number.denominator == 0)
    whole, rest = divmod(abs(number.numerator) * 10**digits // number.denominator, 10**digits)
    return f"{'-' if number < 0 else ''}{whole}.{rest:0{digits}d}"
