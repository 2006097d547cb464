"""The sizes that a DBC file states, checked before cantools reads it: it makes a list with an entry for each bit and each number."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

#: A message (name, bytes), a signal (name, first bit, bits), and the multiplexer values with which a signal is present.
_STATED = re.compile(
    r"^[ \t]*(?:BO_[ \t]+\d+[ \t]+(?P<message>\w+)[ \t]*:[ \t]*(?P<bytes>\d+)"
    r"|SG_[ \t]+(?P<signal>\w+)[^:\n\"]*:[ \t]*(?P<first>\d+)[ \t]*\|[ \t]*(?P<bits>\d+)[ \t]*@"
    r"|SG_MUL_VAL_[ \t]+\d+[ \t]+(?P<multiplexed>\w+)[ \t]+\w+[ \t]+(?P<ranges>[-\d, \t]+))",
    re.MULTILINE,
)
_RANGE = re.compile(r"(\d+)[ \t]*-[ \t]*(\d+)")
#: A message of several frames has at most so many bytes (SAE J1939-21, transport protocol).
_LONGEST = 1785
#: Digits of larger numbers; Python refuses to convert some thousands.
_MOST_DIGITS = 18
#: Multiplexer values of all signals together.
_MOST_VALUES = 2**16


class WrongSize(NamedTuple):
    """A size that cannot be: the reason, with line and column counted from 1."""

    message: str
    line: int
    column: int


def wrong_size(text: str) -> WrongSize | None:
    """The first size in a DBC file that cannot be; None if there is none."""
    first = next(_wrong(text), None)
    if first is None:
        return None
    message, at = first
    return WrongSize(message, text.count("\n", 0, at) + 1, at - (text.rfind("\n", 0, at) + 1) + 1)


def _wrong(text: str) -> Iterator[tuple[str, int]]:
    length, message, values = 0, "", 0
    for stated in _STATED.finditer(text):
        if stated["message"] is not None:
            length, message = _number(stated["bytes"]), stated["message"]
            if length > _LONGEST:
                yield (
                    f"the message {message!r} has {stated['bytes'][:_MOST_DIGITS]} bytes; at most {_LONGEST:,} are possible",
                    stated.start("bytes"),
                )
        elif stated["signal"] is not None:
            # A message of 0 bytes is where editors keep signals that are in no message.
            most = 8 * (length or _LONGEST)
            for name, what in (("bits", "has {} bits"), ("first", "begins at bit {}")):
                number = _number(stated[name])
                if number > most or (name == "first" and number == most):
                    what = what.format(stated[name][:_MOST_DIGITS])
                    yield (
                        f"the signal {stated['signal']!r} {what}, but the message {message!r} has {length} bytes",
                        stated.start(name),
                    )
        else:
            values += sum(max(0, _number(last) - _number(first) + 1) for first, last in _RANGE.findall(stated["ranges"]))
            if values > _MOST_VALUES:
                yield f"the signals have more than {_MOST_VALUES:,} values of their multiplexers", stated.start("ranges")


def _number(digits: str) -> int:
    return int(digits) if len(digits) <= _MOST_DIGITS else 10**_MOST_DIGITS
