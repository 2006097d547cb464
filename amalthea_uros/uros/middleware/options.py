"""The table of the build options of a middleware, `options.yaml` in its folder, and options made of its rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.middleware import PoolSizes
from amalthea_uros.units import MILLISECOND
from amalthea_uros.uros.middleware.profile import Option, OptionRole

#: Bits or picoseconds of a description per unit of an option.
_UNITS = {"": 1, "B": 8, "ms": MILLISECOND}


@dataclass(frozen=True, slots=True, kw_only=True)
class OptionRow(Brief):
    """What is known of a build option; the attributes that options have, too, are explained there.

    Attributes
    ----------
    default : that of the package; None if the option counts only where it is given
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

    def option(self, *, needed: int | None, available: int, is_stated: bool, without_effect: str = "") -> Option:
        """The option of an application."""
        return Option(
            name=self.name,
            package=self.package,
            needed=needed,
            available=available,
            is_stated=is_stated,
            role=self.role,
            unit=self.unit,
            counts=self.counts,
            when_exhausted=self.when_exhausted,
            least=self.least,
            is_power_of_two=self.is_power_of_two,
            words=self.words,
            without_effect=without_effect,
        )


@cache
def option_rows(folder: str) -> Mapping[str, OptionRow]:
    """The build options of a middleware by name, in the order of its table.

    Parameters
    ----------
    folder : the package with its `options.yaml`
    """
    import yaml

    text = resources.files(folder).joinpath("options.yaml").read_text(encoding="utf-8")
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
        for group in yaml.safe_load(text)
        for row in group["options"]
    }
