"""Messages that never arrive: without memory for their strings and sequences, or longer than what can be sent."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros._internal.message_types import length_of
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.source.entities import BEST_EFFORT
from amalthea_uros.source.facts import CodeEntity, CodeEntityKind, CodeFacts
from amalthea_uros.source.program import CodeProgram
from amalthea_uros.source.scope import literal

#: The MTU if nobody sets another one, and what an XRCE message has besides the data of a best-effort publication at least:
#: eProsima/Micro-XRCE-DDS-Client CMakeLists.txt, include/uxr/client/core/session/session.h.
_MTU, _HEADERS = 512, 12
_MTU_OPTION = re.compile(r"UCLIENT_\w+_TRANSPORT_MTU")

_WORD = re.compile(r"\w+")
_POINTER = re.compile(r"\*\s*(\w+)")
_CALL = re.compile(r"\b(\w++)\s*+\(")
#: Names of functions that give what they are called with memory, and what a member gets with it.
_GIVING = re.compile(r"memory|assign|Sequence__init|Sequence__create")
_ASSIGNED = re.compile(r"(?=\bcapacity\s*+=|=\s*+micro_ros_string_utilities_)")


def message_flaws(facts: CodeFacts, program: CodeProgram) -> Iterator[Finding]:
    """The findings about messages."""
    needy = [
        (entity, handle)
        for executor in facts.executors.values()
        for handle in executor.handles
        if (entity := facts.entities.get(handle.entity)) is not None and handle.message and _needs_memory(entity, facts)
    ]
    given = _with_memory(program) if needy else set()
    for entity, handle in needy:
        if re.split(r"\W", handle.message)[0] not in given:
            message = (
                f"nothing gives the strings and sequences of '{handle.message}' ({entity.type}) memory: "
                "messages that need it are not taken, and the callback never runs for them"
            )
            advice = "Call micro_ros_utilities_create_message_memory for it, or set data and capacity, before it is added."
            yield Finding("IMP021", Severity.WARNING, message, handle.place, advice)
    for entity in facts.entities.values():
        yield from _too_long(entity, facts)


def _needs_memory(entity: CodeEntity, facts: CodeFacts) -> bool:
    """Whether a type has strings or sequences."""
    length = length_of(entity.type, facts.types) if entity.type is not None else None
    return length is not None and not length.is_fixed


def _with_memory(program: CodeProgram) -> set[str]:
    """The variables to which the text of a statement seems to give memory, and pointers, which can lead to any; "" is one of them."""
    found = {""}
    text = b"\n".join(file.text for file, _ in program.files).decode("utf-8", "replace")
    for statement in text.split(";"):
        found.update(_POINTER.findall(statement))
        calls = (call for call in _CALL.finditer(statement) if _GIVING.search(call[1]) is not None)
        if (call := next(calls, None)) is not None:
            found.update(_WORD.findall(statement, call.end()))
        assigned = max((match.start() for match in _ASSIGNED.finditer(statement)), default=0)
        found.update(_WORD.findall(statement, 0, assigned))
    return found


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
