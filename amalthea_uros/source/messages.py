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

_LENGTHS = {
    **dict.fromkeys(("bool", "byte", "char", "int8", "uint8"), 1),
    **dict.fromkeys(("int16", "uint16"), 2),
    **dict.fromkeys(("int32", "uint32", "float32"), 4),
    **dict.fromkeys(("int64", "uint64", "float64"), 8),
}
#: What is longer is not sent by a controller.
_LONGEST = 2**20
_FIELD = re.compile(r"([\w/]+)(\[([<=\d]*)\])?")


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


def length_of(kind: MessageType, own: Mapping[str, str] = MappingProxyType({})) -> Length | None:
    """The length of a message of a type, None if the type, or one in it, is not known.

    Parameters
    ----------
    own : the types of the fields of types that the application defines
    """
    types = _types() | dict(own)
    try:
        return _after(Length(0, True), str(kind), types, ())
    except KeyError:
        return None


@cache
def _types() -> dict[str, str]:
    packages = parsed_yaml(files(__package__).joinpath("messages.yaml").read_text(encoding="utf-8"))
    return {f"{package}/{name}": fields for package, types in packages.items() for name, fields in types.items()}


def _after(before: Length, kind: str, types: Mapping[str, str], around: tuple[str, ...]) -> Length:
    """The length up to the end of a value of a type, which begins after something."""
    if kind in _LENGTHS:
        size = _LENGTHS[kind]
        return Length(_aligned(before.bytes, size) + size, before.is_fixed)
    if kind == "string":
        # Its length, and the zero byte at its end.
        return Length(_aligned(before.bytes, 4) + 4 + 1, False)
    package = kind.rpartition("/")[0]
    if kind in around:
        # No type of ROS can contain itself.
        raise KeyError(kind)
    for name, brackets, count in _FIELD.findall(types[kind]):
        inner = name if "/" in name or name in _LENGTHS or name == "string" else f"{package}/{name}"
        if brackets and (not count.isdecimal() or len(count) > 7):
            before = Length(_aligned(before.bytes, 4) + 4, False)
        else:
            for _ in range(int(count or 1)):
                before = _after(before, inner, types, (*around, kind))
                if before.bytes > _LONGEST:
                    raise KeyError(kind)
    # A structure without fields gets one of a byte: ros2/rosidl, rosidl_generator_c, structure_needs_at_least_one_member.
    return before if types[kind] else Length(before.bytes + 1, before.is_fixed)


def _aligned(position: int, size: int) -> int:
    return -(-position // size) * size


#: A line of a definition: a type, which can be bounded and an array, and a name; a constant has a value after that.
_LINE = re.compile(r"([\w/]+)(?:<=\d+)?(\[[<=\d]*\])?\s+(\w+)\s*(=?)")


def defined_types(definitions: Iterable[SourceFile]) -> dict[str, str]:
    """The types of the fields of messages and services, by the names of types, in files `package/msg/Name.msg`."""
    types = {}
    for file in definitions:
        kind, package, name = file.path.parent.name, file.path.parent.parent.name, file.path.stem
        if kind not in ("msg", "srv"):
            kind, package = file.path.suffix[1:], file.path.parent.name
        parts = re.split(r"^-{3}\s*$", file.text.decode("utf-8", "replace"), flags=re.MULTILINE)
        names = [name] if kind == "msg" else [f"{name}_Request", f"{name}_Response"]
        for each, text in zip(names, parts, strict=False):
            types[f"{package}/{kind}/{each}"] = " ".join(_fields(text, package))
    return types


def _fields(text: str, package: str) -> Iterator[str]:
    for line in text.splitlines():
        match = _LINE.match(line.partition("#")[0].strip())
        if match is None or match[4]:
            continue
        yield f"{_qualified(match[1], package)}{match[2] or ''}"


def _qualified(name: str, package: str) -> str:
    if name in _LENGTHS or name == "string":
        return name
    if name == "Header":
        return "std_msgs/msg/Header"
    return f"{package}/msg/{name}" if "/" not in name else "/msg/".join(name.split("/")) if name.count("/") == 1 else name
