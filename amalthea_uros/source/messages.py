"""Lengths of common messages on the wire: in the common data representation (CDR), without the header of encapsulation."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.resources import parsed_yaml
from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.idl import idl_types

_LENGTHS = {
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


def length_of(kind: MessageType, own: Mapping[str, str] = MappingProxyType({})) -> Length | None:
    """The length of a message of a type, None if the type, or one in it, is not known.

    Parameters
    ----------
    own : the types of the fields of types that the application defines
    """
    types = _types() | dict(own)
    try:
        return _after(Length(0, 0, True), str(kind), None, types, ())
    except KeyError:
        return None


@cache
def _types() -> dict[str, str]:
    packages = parsed_yaml(files(__package__).joinpath("messages.yaml").read_text(encoding="utf-8"))
    return {f"{package}/{name}": fields for package, types in packages.items() for name, fields in types.items()}


def _after(before: Length, kind: str, bound: int | None, types: Mapping[str, str], around: tuple[str, ...]) -> Length:
    """The length up to the end of a value of a type, which begins after something.

    Parameters
    ----------
    bound : of the characters of a string
    """
    if kind in _LENGTHS:
        return before.with_number(_LENGTHS[kind])
    if kind == "string":
        # Its length, and the zero byte at its end.
        return before.with_number(4).with_bytes(1, None if bound is None else bound + 1)
    if kind in around:
        # No type of ROS can contain itself.
        raise KeyError(kind)
    for name, characters, brackets, is_bound, count in _FIELD.findall(types[kind]):
        if max(len(characters), len(count)) > _DIGITS:
            raise KeyError(kind)
        inner = _qualified(name, kind.rpartition("/")[0].partition("/")[0])
        end = int(characters) if characters else None
        before = _elements(before, inner, end, (brackets, is_bound, count), types, (*around, kind))
    # A structure without fields gets one of a byte: ros2/rosidl, rosidl_generator_c, structure_needs_at_least_one_member.
    return before if types[kind] else before.with_number(1)


def _elements(
    before: Length,
    kind: str,
    bound: int | None,
    array: tuple[str, str, str],
    types: Mapping[str, str],
    around: tuple[str, ...],
) -> Length:
    """The length after a field: one value, an array, or a sequence, whose elements are as many as its bound at most."""
    brackets, is_bound, count = array
    is_sequence = bool(brackets) and (bool(is_bound) or not count)
    if not is_sequence:
        for _ in range(int(count or 1)):
            before = _after(before, kind, bound, types, around)
            if before.bytes > _LONGEST:
                raise KeyError(kind)
        return before
    empty = before.with_number(4).with_bytes(0, 0 if count else None)
    _after(empty, kind, bound, types, around)
    longest = empty
    for _ in range(int(count or 0)):
        longest = _after(longest, kind, bound, types, around)
        if longest.bytes > _LONGEST:
            raise KeyError(kind)
    return Length(empty.bytes, longest.most, False)


def _aligned(position: int, size: int) -> int:
    return -(-position // size) * size


#: A line of a definition: a type, which can be bounded and an array, and a name; a constant has a value after that.
_LINE = re.compile(r"([\w/]+)(<=\d+)?(\[[<=\d]*\])?\s+(\w+)\s*(=?)")


#: What the parts of a file are called, in their order.
_PARTS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
#: The messages of an action have more than what is defined: ros2/rosidl_defaults, rosidl_adapter, action_msgs.
_AROUND = {"_Goal": "uint8[16] {}", "_Result": "int8 {}", "_Feedback": "uint8[16] {}"}


def defined_types(definitions: Iterable[SourceFile]) -> dict[str, str]:
    """The types of the fields of messages, services and actions, by the names of types, in files `package/msg/Name.msg`."""
    types: dict[str, str] = {}
    for file in definitions:
        text = file.text.decode("utf-8", "replace")
        if file.path.suffix == ".idl":
            types |= idl_types(text)
            continue
        kind, package, name = file.path.parent.name, file.path.parent.parent.name, file.path.stem
        if kind not in _PARTS:
            kind, package = file.path.suffix[1:], file.path.parent.name
        parts = re.split(r"^-{3}\s*$", text, flags=re.MULTILINE)
        for suffix, part in zip(_PARTS[kind], parts, strict=False):
            fields = " ".join(_fields(part, package))
            types[f"{package}/{kind}/{name}{suffix}"] = _AROUND.get(suffix, "{}").format(fields).strip()
    return types


def _fields(text: str, package: str) -> Iterator[str]:
    for line in text.splitlines():
        match = _LINE.match(line.partition("#")[0].strip())
        if match is None or match[5]:
            continue
        yield f"{_qualified(match[1], package)}{match[2] or ''}{match[3] or ''}"


def _qualified(name: str, package: str) -> str:
    if name in _LENGTHS or name == "string":
        return name
    if name == "Header":
        return "std_msgs/msg/Header"
    if "/" not in name:
        return f"{package}/msg/{name}"
    return "/msg/".join(name.split("/")) if name.count("/") == 1 else name
