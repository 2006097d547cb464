"""Tasks and threads of operating systems that run functions of the sources."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from amalthea_uros.source.entities import callback_of
from amalthea_uros.source.facts import Thread
from amalthea_uros.source.scope import Expression
from amalthea_uros.source.syntax import descendants, text_of
from amalthea_uros.source.walk import CodeWalk, FunctionCall

#: Of a stack of FreeRTOS that is counted in words.
_WORD = 4
#: CMSIS-RTOS2, ARM-software/CMSIS_5 CMSIS/RTOS2/Include/cmsis_os2.h.
_CMSIS_PRIORITIES = {
    "osPriorityIdle": 1,
    "osPriorityLow": 8,
    "osPriorityBelowNormal": 16,
    "osPriorityNormal": 24,
    "osPriorityAboveNormal": 32,
    "osPriorityHigh": 40,
    "osPriorityRealtime": 48,
}


class _ThreadForm(NamedTuple):
    """Positions of the arguments of a function that creates a thread; None: it has none."""

    entry: int
    name: int | None = None
    stack: int | None = None
    priority: int | None = None
    core: int | None = None
    attributes: int | None = None
    rtos: str = ""


FORMS: Mapping[str, _ThreadForm] = {
    "xTaskCreate": _ThreadForm(0, 1, 2, 4, rtos="freertos"),
    "xTaskCreateStatic": _ThreadForm(0, 1, 2, 4, rtos="freertos"),
    "xTaskCreatePinnedToCore": _ThreadForm(0, 1, 2, 4, 6, rtos="freertos"),
    "osThreadNew": _ThreadForm(0, attributes=2, rtos="freertos"),
    "K_THREAD_DEFINE": _ThreadForm(2, 0, 1, 6, rtos="zephyr"),
    "k_thread_create": _ThreadForm(3, 0, 2, 7, rtos="zephyr"),
    "pthread_create": _ThreadForm(2, 0),
}


def thread_of(call: FunctionCall, walk: CodeWalk, in_words: bool) -> Thread | None:
    """The thread that a call creates.

    Parameters
    ----------
    in_words : whether stacks of `xTaskCreate` are counted in words, as FreeRTOS does, and ESP-IDF does not
    """
    form = FORMS[call.name]
    entry = call.argument(form.entry)
    callback = callback_of(entry, walk) if entry is not None else None
    if callback is None:
        return None
    attributes = _attributes(call.argument(form.attributes)) if form.attributes is not None else {}
    name, stack, priority, core = (
        attributes.get(key) or (call.argument(index) if index is not None else None)
        for key, index in (("name", form.name), ("stack_size", form.stack), ("priority", form.priority), ("core", form.core))
    )
    factor = _WORD if in_words and call.name in ("xTaskCreate", "xTaskCreateStatic") else 1
    size = stack.number if stack is not None else None
    return Thread(
        name=(name.string or (name.name if form.rtos != "freertos" else None) if name is not None else None) or callback.name,
        entry=callback.function,
        place=call.place,
        stack=size * factor if size is not None and size > 0 else None,
        priority=_priority(priority),
        core=core.number if core is not None else None,
    )


def _attributes(given: Expression | None) -> dict[str, Expression]:
    """The members of the structure that describes a thread of CMSIS-RTOS2."""
    found: dict[str, Expression] = {}
    if given is not None:
        own = given.resolved
        for pair in descendants(own.node):
            designator, value = pair.child_by_field_name("designator"), pair.child_by_field_name("value")
            if pair.type == "initializer_pair" and designator is not None and value is not None:
                found[text_of(designator).lstrip(".")] = own.at(value)
    return found


def _priority(given: Expression | None) -> int | None:
    if given is None:
        return None
    if given.resolved.name in _CMSIS_PRIORITIES:
        return _CMSIS_PRIORITIES[given.resolved.name]
    number = given.number
    return number if number is not None and number >= 0 else None
