"""Messages, services and actions that an application defines itself."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from amalthea_uros._internal.message_types import qualified
from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.idl import idl_types

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
        yield f"{qualified(match[1], package)}{match[2] or ''}{match[3] or ''}"
