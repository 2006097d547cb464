"""Messages that never arrive: without memory for their strings and sequences, or longer than what can be sent."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros._internal.message_types import length_of
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.source.entities import BEST_EFFORT
from amalthea_uros.source.facts import CodeEntity, CodeEntityKind, CodeFacts, CodeHandle
from amalthea_uros.source.program import CodeProgram
from amalthea_uros.source.scope import literal

#: The MTU if nobody sets another one, and what an XRCE message has besides the data of a best-effort publication at least:
#: eProsima/Micro-XRCE-DDS-Client CMakeLists.txt, include/uxr/client/core/session/session.h.
_MTU, _HEADERS = 512, 12
_MTU_OPTION = re.compile(r"UCLIENT_\w+_TRANSPORT_MTU")


def message_flaws(facts: CodeFacts, program: CodeProgram) -> Iterator[Finding]:
    """The findings about messages."""
    text = b"\n".join(file.text for file, _ in program.files).decode("utf-8", "replace")
    for executor in facts.executors.values():
        for handle in executor.handles:
            entity = facts.entities.get(handle.entity)
            if entity is not None and handle.message and _lacks_memory(entity, handle, facts, text):
                message = (
                    f"nothing gives the strings and sequences of '{handle.message}' ({entity.type}) memory: "
                    "messages that need it are not taken, and the callback never runs for them"
                )
                advice = "Call micro_ros_utilities_create_message_memory for it, or set data and capacity, before it is added."
                yield Finding("IMP021", Severity.WARNING, message, handle.place, advice)
    for entity in facts.entities.values():
        yield from _too_long(entity, facts)


def _lacks_memory(entity: CodeEntity, handle: CodeHandle, facts: CodeFacts, text: str) -> bool:
    """Whether a type has strings or sequences, and no text looks as if it gave a variable memory for them."""
    length = length_of(entity.type, facts.types) if entity.type is not None else None
    if length is None or length.is_fixed:
        return False
    name = re.escape(re.split(r"\W", handle.message)[0])
    is_assigned = rf"\b{name}\b[^;]*(\bcapacity\s*=|=\s*micro_ros_string_utilities_)"
    gives = rf"{is_assigned}|\b\w*(memory|assign|Sequence__init|Sequence__create)\w*\s*\([^;]*\b{name}\b"
    # A pointer can lead to memory that is given elsewhere, under another name.
    is_pointer = re.search(rf"\*\s*{name}\b", text) is not None
    return not is_pointer and re.search(gives, text) is None


def _too_long(entity: CodeEntity, facts: CodeFacts) -> Iterator[Finding]:
    length = length_of(entity.type, facts.types) if entity.type is not None else None
    if length is None or entity.reliability != BEST_EFFORT:
        return
    if entity.kind not in (CodeEntityKind.PUBLISHER, CodeEntityKind.SUBSCRIPTION):
        return
    stated = [
        size
        for name, option in facts.options.items()
        if _MTU_OPTION.fullmatch(name) and (size := literal(option.value)) is not None and size >= 0
    ]
    mtu = max(stated, default=_MTU)
    if length.bytes > mtu - _HEADERS:
        message = (
            f"a message of {entity.type} has {length.bytes} B or more, and best effort sends no parts: "
            f"with an MTU of {mtu} B none arrives"
        )
        advice = (
            f"Make it reliable, or set the MTU of the transport to {length.bytes + _HEADERS} B or more and rebuild libmicroros."
        )
        yield Finding("IMP022", Severity.WARNING, message, entity.place, advice)
