"""Definitions of messages in OMG IDL, as far as ROS 2 uses it, in the words of `.msg` files."""

from __future__ import annotations

import re

#: Types of IDL -> those of ROS: ros2/rosidl rosidl_parser, https://design.ros2.org/articles/idl_interface_definition.html
_TYPES = {
    "boolean": "bool",
    "octet": "byte",
    "char": "char",
    "int8": "int8",
    "uint8": "uint8",
    "short": "int16",
    "int16": "int16",
    "unsigned short": "uint16",
    "uint16": "uint16",
    "long": "int32",
    "int32": "int32",
    "unsigned long": "uint32",
    "uint32": "uint32",
    "long long": "int64",
    "int64": "int64",
    "unsigned long long": "uint64",
    "uint64": "uint64",
    "float": "float32",
    "double": "float64",
    "string": "string",
}
_NOTHING = re.compile(r"//[^\n]*|/\*.*?(?:\*/|\Z)|^[ \t]*#[^\n]*", re.DOTALL | re.MULTILINE)
_TEXT = re.compile(r'"(?:[^"\\\n]|\\.)*+"?')
_ANNOTATION = re.compile(r"@[\w:]+\s*(?:\([^()]*\))?")
_STRUCT = re.compile(r"module\s+(\w+)\s*\{\s*module\s+(msg|srv)\s*\{(.*)", re.DOTALL)
_TYPEDEF = re.compile(r"\btypedef\s+(.+)", re.DOTALL)
_SEQUENCE = re.compile(r"sequence\s*<\s*(.+?)\s*(?:,\s*(\d+)\s*)?>", re.DOTALL)
_MEMBER = re.compile(r"(.*[\s>])(\w+)\s*(?:\[\s*(\d+)\s*\])?\s*", re.DOTALL)


def idl_types(text: str) -> dict[str, str]:
    """The types of the fields of the structures in a file; one that is not understood leads to an unknown size."""
    plain = _ANNOTATION.sub("", _TEXT.sub("", _NOTHING.sub("", text)))
    outer = _STRUCT.search(plain)
    if outer is None:
        return {}
    package, kind, body = outer.groups()
    aliases = {
        name: f"{field}{array}"
        for statement in body.split(";")[:-1]
        if (found := _TYPEDEF.search(statement)) is not None
        for field, name, array in [_field(found[1])]
    }
    return {
        f"{package}/{kind}/{name}": " ".join(_members(members, aliases))
        for name, members in re.findall(r"struct\s+(\w+)\s*\{([^{}]*)\}", body)
    }


def _members(text: str, aliases: dict[str, str]) -> list[str]:
    fields = []
    for member in filter(str.strip, text.split(";")):
        field, name, array = _field(member)
        if name != "structure_needs_at_least_one_member":
            fields.append(aliases.get(field, f"{field}{array}"))
    return fields


def _field(text: str) -> tuple[str, str, str]:
    """A type as a `.msg` file has it, the name, and the brackets of an array."""
    match = _MEMBER.fullmatch(f" {' '.join(text.split())}")
    if match is None:
        return "unknown", "", ""
    kind, name, count = match[1].strip(), match[2], match[3]
    array = f"[{count}]" if count else ""
    sequence = _SEQUENCE.fullmatch(kind)
    if sequence is not None:
        return _type(sequence[1]), name, f"[<={sequence[2]}]" if sequence[2] else "[]"
    return _type(kind), name, array


def _type(text: str) -> str:
    words = " ".join(text.split())
    bounded = re.fullmatch(r"string\s*<\s*(\d+)\s*>", words)
    if bounded is not None:
        return f"string<={bounded[1]}"
    return _TYPES.get(words, words.replace("::", "/"))
