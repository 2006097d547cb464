"""One change of a system, as a user writes it."""

from __future__ import annotations

import re
from dataclasses import dataclass

from amalthea_uros.errors import InvalidArgumentError

FORM, EXAMPLE = "OBJECT.KEY=VALUE", "Executor_Task.period=2ms"

#: The first equals sign after a key; one before it belongs to the name of the object.
_ASSIGNMENT = re.compile(r"(.*?\.\s*\w+\s*)=(.*)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Change:
    """A value for one property of an object.

    Attributes
    ----------
    object : name of a process, runnable, core, clock, scheduler, stimulus, mode label, message, label or channel
    key : what is changed, such as `period`
    value : with its unit, as the user wrote it
    """

    object: str
    key: str
    value: str

    @property
    def target(self) -> str:
        """The object and the key, such as "Executor_Task.period"."""
        return f"{self.object}.{self.key}"

    def __str__(self) -> str:
        return f"{self.target}={self.value}"


def parse_change(text: str) -> Change:
    """A change written as `OBJECT.KEY=VALUE`.

    Keys have no dots, so those before the last one belong to the name of the object.

    Raises
    ------
    InvalidArgumentError : the text is not of this form.
    """
    target, value = split_assignment(text, FORM, EXAMPLE)
    name, key = split_target(target, text, FORM, EXAMPLE)
    return Change(name, key, value)


def split_assignment(text: str, form: str, example: str) -> tuple[str, str]:
    """What is before and after the equals sign; raises as `parse_change`."""
    match = _ASSIGNMENT.fullmatch(text)
    target, value = (part.strip() for part in (match.groups() if match else text.partition("=")[::2]))
    if not target or not value:
        raise InvalidArgumentError(f"{text!r} is not of the form {form}; an example: {example}")
    return target, value


def split_target(target: str, text: str, form: str, example: str) -> tuple[str, str]:
    """The name of the object and the key; raises as `parse_change`."""
    name, _, key = target.rpartition(".")
    if not name or not key:
        raise InvalidArgumentError(f"{text!r} does not name an object and a key; expected {form}, e.g. {example}")
    return name, key
