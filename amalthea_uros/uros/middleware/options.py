"""The table of the build options of a middleware, `options.yaml` in its folder, and options made of its rows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import Any, Self

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.resources import yaml_data
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.middleware import Middleware, PoolSizes
from amalthea_uros.units import MILLISECOND
from amalthea_uros.uros.application.notes import Notes

#: Bits or picoseconds of a description per unit of an option.
_UNITS = {"": 1, "B": 8, "ms": MILLISECOND}


class OptionRole(StrEnum):
    """What depends on the value of a build option."""

    POOL = "pool"  # how many things can be created
    QUEUE = "queue"  # how many messages can wait; more of them are lost
    ROOM = "room"  # how long a name can be
    SETTING = "setting"  # times and sizes that the figures depend on


#: Roles of options that count entities and waiting messages.
COUNTED = (OptionRole.POOL, OptionRole.QUEUE)


@dataclass(frozen=True, slots=True, kw_only=True)
class OptionRow(Brief):
    """What is known of a build option of the middleware.

    Attributes
    ----------
    package : the package whose build takes it, for `colcon.meta`
    default : that of the package; None if the option counts only where it is given
    unit : such as "B" or "ms"; "" for a number of things
    counts : what it counts, for a comment
    when_exhausted : what happens when the application needs more
    least : smallest value that the build takes
    is_power_of_two : whether the build takes powers of two only
    words : values that are words, by their numbers; () if they are numbers
    """

    name: str
    package: str
    default: int | None = None
    role: OptionRole = OptionRole.POOL
    unit: str = ""
    counts: str = ""
    when_exhausted: str = ""
    least: int = 0
    is_power_of_two: bool = False
    words: tuple[str, ...] = ()

    def stated(self, limits: PoolSizes) -> int | None:
        """The value that a description states, as the build takes it: sizes rounded down, times rounded up."""
        value: Any = getattr(limits, self.name, None)
        if value is None:
            return None
        if self.words:
            return int(value) if isinstance(value, bool) else self.words.index(value)
        amount: int = value
        return amount // _UNITS[self.unit] if self.unit == "B" else -(-amount // _UNITS[self.unit])

    def described(self, value: int) -> Any:
        """A value of the build as a description would state it."""
        if self.words:
            word = self.words[value]
            return word in ("ON", "1") if len(self.words) == 2 else word
        return value * _UNITS[self.unit]

    def number(self, text: str) -> int | None:
        """The value that a text stands for; None if it stands for none."""
        if self.words:
            synonyms = {"ON": 1, "TRUE": 1, "YES": 1, "1": 1, "OFF": 0, "FALSE": 0, "NO": 0, "0": 0}
            switch = synonyms.get(text.upper()) if len(self.words) == 2 else None
            return self.words.index(text) if text in self.words else switch
        digits = text.removeprefix("-")
        # A length that no value of an option has; converting more digits takes long.
        return int(text) if digits.isascii() and digits.isdecimal() and len(digits) <= 12 else None


@dataclass(frozen=True, slots=True, kw_only=True)
class Option(OptionRow):
    """A build option with what the application needs of it.

    Attributes
    ----------
    needed : smallest value with which the application works, a lower bound for a queue; None if it has no use for it
    available : the value that the description states, or else the default
    is_stated : whether the description states it
    without_effect : why the value that is stated has no effect; "" if it has
    """

    needed: int | None
    available: int
    is_stated: bool
    without_effect: str = ""

    @classmethod
    def of(cls, row: OptionRow, *, needed: int | None, available: int, is_stated: bool, without_effect: str = "") -> Self:
        """The option of a row of the table."""
        known = {name: getattr(row, name) for name in OptionRow.__annotations__}
        return cls(**known, needed=needed, available=available, is_stated=is_stated, without_effect=without_effect)

    @property
    def is_exceeded(self) -> bool:
        """Whether the application needs a greater or a different value."""
        if self.needed is None:
            return False
        return self.needed != self.available if self.words else self.needed > self.available

    @property
    def smallest(self) -> int | None:
        """The smallest value that the build takes and with which the application works; None if it has no use for it."""
        if self.needed is None:
            return None
        value = max(self.needed, self.least)
        return 1 << (value - 1).bit_length() if self.is_power_of_two else value

    def text(self, value: int) -> str:
        """A value as the build takes it."""
        return self.words[value] if self.words else str(value)


@cache
def option_rows(folder: Path) -> Mapping[str, OptionRow]:
    """The build options of a middleware by name, in the order of its table.

    Parameters
    ----------
    folder : that of the middleware, with its `options.yaml`
    """
    return {
        row["name"]: OptionRow(
            **(
                row
                | {
                    "package": group["package"],
                    "words": tuple(row.get("words", ())),
                    "role": OptionRole(row.get("role", "pool")),
                }
            )
        )
        for group in yaml_data(folder / "options.yaml")
        for row in group["options"]
    }


def check_options(options: Iterable[Option], middleware: Middleware, notes: Notes) -> None:
    """Report options that are too small, and values that the build refuses or ignores; see `storage` for those of waiting messages."""
    for option in options:
        if option.without_effect:
            _report_without_effect(option, middleware, notes)
        elif option.is_power_of_two and option.available & (option.available - 1):
            _report_no_power_of_two(option, middleware, notes)
        elif option.is_exceeded and option.role is OptionRole.POOL:
            _report_pool(option, middleware, notes)
        elif option.is_exceeded and option.role is OptionRole.ROOM:
            _report_name(option, middleware, notes)


def _report_pool(option: Option, middleware: Middleware, notes: Notes) -> None:
    """Without an entity the application does not start."""
    default = "" if option.is_stated else " by default"
    message = f"{option.name} is {option.available}{default}, but the application needs {option.needed}"
    advice = f"{option.when_exhausted} Set {option.name} to {option.needed} or more in the build and under 'limits'."
    report = notes.error if option.is_stated else notes.warning
    report("UR120", message, _location(option, middleware), advice)


def _report_no_power_of_two(option: Option, middleware: Middleware, notes: Notes) -> None:
    lower = 1 << (option.available.bit_length() - 1)
    message = f"{option.name} is {option.available}, which is not a power of two: the build stops with an error"
    notes.warning("UR126", message, _location(option, middleware), f"Set it to {2 * lower}, or to {lower} if that is enough.")


def _report_name(option: Option, middleware: Middleware, notes: Notes) -> None:
    default = "" if option.is_stated else " by default"
    message = f"{option.name} is {option.available}{default}, but the application needs {option.needed} {option.counts}"
    advice = f"{option.when_exhausted} Use a shorter name, or set {option.name} to {option.needed} or more."
    report = notes.error if option.is_stated else notes.warning
    report("UR127", message, _location(option, middleware), advice)


def _report_without_effect(option: Option, middleware: Middleware, notes: Notes) -> None:
    message = f"{option.name} has no effect: {option.without_effect}"
    notes.warning("UR128", message, _location(option, middleware), "Remove it here and in the build.")


def _location(option: Option, middleware: Middleware) -> Location | None:
    return middleware.limits.location(option.name)
