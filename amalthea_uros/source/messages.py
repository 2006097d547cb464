"""Lengths of common messages on the wire: in the common data representation (CDR), without the header of encapsulation."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from amalthea_uros._internal.resources import parsed_yaml

_LENGTHS = {
    **dict.fromkeys(("bool", "byte", "char", "int8", "uint8"), 1),
    **dict.fromkeys(("int16", "uint16"), 2),
    **dict.fromkeys(("int32", "uint32", "float32"), 4),
    **dict.fromkeys(("int64", "uint64", "float64"), 8),
}
_FIELD = re.compile(r"([\w/]+)(\[(\d*)\])?")


@dataclass(frozen=True, slots=True, order=True)
class MessageType:
    """The type of a message, service or action, e.g. `std_msgs/msg/Int32`."""

    package: str
    kind: str
    name: str

    def __str__(self) -> str:
        return f"{self.package}/{self.kind}/{self.name}"

    def part(self, suffix: str) -> MessageType:
        """The request or response of a service."""
        return MessageType(self.package, self.kind, f"{self.name}_{suffix}")


class Length(NamedTuple):
    """The length of a message.

    Attributes
    ----------
    bytes : with empty strings and sequences
    is_fixed : whether there are none
    """

    bytes: int
    is_fixed: bool


def length_of(kind: MessageType) -> Length | None:
    """The length of a message of a type, None if the type is not known."""
    if str(kind) not in _types():
        return None
    length = _after(Length(0, True), str(kind))
    # A structure without fields gets one of a byte: ros2/rosidl, rosidl_generator_c, structure_needs_at_least_one_member.
    return length if length.bytes else Length(1, True)


@cache
def _types() -> dict[str, str]:
    packages = parsed_yaml(files(__package__).joinpath("messages.yaml").read_text(encoding="utf-8"))
    return {f"{package}/{name}": fields for package, types in packages.items() for name, fields in types.items()}


def _after(before: Length, kind: str) -> Length:
    """The length up to the end of a value of a type, which begins after something."""
    if kind in _LENGTHS:
        size = _LENGTHS[kind]
        return Length(_aligned(before.bytes, size) + size, before.is_fixed)
    if kind == "string":
        # Its length, and the zero byte at its end.
        return Length(_aligned(before.bytes, 4) + 4 + 1, False)
    package = kind.rpartition("/")[0]
    for name, brackets, count in _FIELD.findall(_types()[kind]):
        inner = name if "/" in name or name in _LENGTHS or name == "string" else f"{package}/{name}"
        if brackets and not count:
            before = Length(_aligned(before.bytes, 4) + 4, False)
        else:
            for _ in range(int(count or 1)):
                before = _after(before, inner)
    return before


def _aligned(position: int, size: int) -> int:
    return -(-position // size) * size
