"""Types of messages, and their lengths on the wire: in the common data representation (CDR), without the header of encapsulation."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.resources import yaml_data

LENGTHS = {
    **dict.fromkeys(("bool", "byte", "char", "int8", "uint8"), 1),
    **dict.fromkeys(("int16", "uint16"), 2),
    **dict.fromkeys(("int32", "uint32", "float32"), 4),
    **dict.fromkeys(("int64", "uint64", "float64"), 8),
}
#: What is longer is not sent by a controller.
_LONGEST = 2**20
_DIGITS = 7
_FIELD = re.compile(r"([\w/]+)(?:<=(\d+))?(\[(<=)?(\d*)\])?")


@dataclass(frozen=True, slots=True, order=True)
class MessageType:
    """The type of a message, service or action, e.g. `std_msgs/msg/Int32`."""

    package: str
    kind: str
    name: str

    def __str__(self) -> str:
        return f"{self.package}/{self.kind}/{self.name}"

    def part(self, suffix: str) -> MessageType:
        """The request or response of a service, or the goal, result or feedback of an action."""
        return MessageType(self.package, self.kind, f"{self.name}_{suffix}")


class LengthBounds(NamedTuple):
    """The longest strings, in characters, and sequences, in elements, of a message whose type does not bound them; None: unknown."""

    string: int | None = None
    sequence: int | None = None


_WITHOUT_BOUNDS = LengthBounds()


class Length(NamedTuple):
    """The length of a message.

    Attributes
    ----------
    bytes : with empty strings and sequences
    most : with the longest ones; None if one has no bound
    is_fixed : whether there are none
    """

    bytes: int
    most: int | None
    is_fixed: bool

    def with_number(self, size: int) -> Length:
        """The length up to the end of a number after this one."""
        most = None if self.most is None else _aligned(self.most, size) + size
        return Length(_aligned(self.bytes, size) + size, most, self.is_fixed)

    def with_bytes(self, least: int, most: int | None) -> Length:
        """The length up to the end of bytes that a string or a sequence has after this one."""
        return Length(self.bytes + least, None if self.most is None or most is None else self.most + most, False)


def length_of(
    kind: MessageType, own: Mapping[str, str] = MappingProxyType({}), bounds: LengthBounds = _WITHOUT_BOUNDS
) -> Length | None:
    """The length of a message of a type, None if the type, or one in it, is not known.

    Parameters
    ----------
    own : the types of the fields of types that the application defines
    bounds : of strings and sequences that the type does not bound
    """
    types = _types() | dict(own)
    try:
        return _after(Length(0, 0, True), str(kind), None, _Known(types, bounds), ())
    except KeyError:
        return None


def unbounded_parts(kind: MessageType, own: Mapping[str, str] = MappingProxyType({})) -> tuple[str, ...]:
    """The parts of a type without an end: `string`, `sequence`, both or nothing; nothing of a type that is not known."""

    def most(**bounds: int) -> int | None:
        length = length_of(kind, own, LengthBounds(**bounds))
        return 0 if length is None else length.most

    if most() is not None:
        return ()
    return tuple(part for part, other in (("string", "sequence"), ("sequence", "string")) if most(**{other: 1}) is None)


class _Known(NamedTuple):
    types: Mapping[str, str]
    bounds: LengthBounds


@cache
def _types() -> dict[str, str]:
    packages = yaml_data(Path(__file__).with_name("message_types.yaml"))
    return {f"{package}/{name}": fields for package, types in packages.items() for name, fields in types.items()}


def _after(before: Length, kind: str, bound: int | None, known: _Known, around: tuple[str, ...]) -> Length:
    """The length up to the end of a value of a type, which begins after something.

    Parameters
    ----------
    bound : of the characters of a string
    """
    if kind in LENGTHS:
        return before.with_number(LENGTHS[kind])
    if kind == "string":
        # Its length, and the zero byte at its end.
        end = known.bounds.string if bound is None else bound
        return before.with_number(4).with_bytes(1, None if end is None else end + 1)
    if kind in around:
        # No type of ROS can contain itself.
        raise KeyError(kind)
    for name, characters, brackets, is_bound, count in _FIELD.findall(known.types[kind]):
        if max(len(characters), len(count)) > _DIGITS:
            raise KeyError(kind)
        inner = qualified(name, kind.rpartition("/")[0].partition("/")[0])
        end = int(characters) if characters else None
        before = _elements(before, inner, end, (brackets, is_bound, count), known, (*around, kind))
    # A structure without fields gets one of a byte: ros2/rosidl, rosidl_generator_c, structure_needs_at_least_one_member.
    return before if known.types[kind] else before.with_number(1)


def _elements(
    before: Length,
    kind: str,
    bound: int | None,
    array: tuple[str, str, str],
    known: _Known,
    around: tuple[str, ...],
) -> Length:
    """The length after a field: one value, an array, or a sequence, whose elements are as many as its bound at most."""
    brackets, is_bound, count = array
    is_sequence = bool(brackets) and (bool(is_bound) or not count)
    if not is_sequence:
        for _ in range(int(count or 1)):
            before = _after(before, kind, bound, known, around)
            if before.bytes > _LONGEST:
                raise KeyError(kind)
        return before
    most = int(count) if count else known.bounds.sequence
    empty = before.with_number(4).with_bytes(0, None if most is None else 0)
    _after(empty, kind, bound, known, around)
    longest = empty
    for _ in range(most or 0):
        longest = _after(longest, kind, bound, known, around)
        if longest.bytes > _LONGEST:
            raise KeyError(kind)
    return Length(empty.bytes, longest.most, False)


def _aligned(position: int, size: int) -> int:
    return -(-position // size) * size


def qualified(name: str, package: str) -> str:
    """The full name of the type of a field in a message of a package."""
    if name in LENGTHS or name == "string":
        return name
    if name == "Header":
        return "std_msgs/msg/Header"
    if "/" not in name:
        return f"{package}/msg/{name}"
    return "/msg/".join(name.split("/")) if name.count("/") == 1 else name
