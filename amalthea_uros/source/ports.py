"""Functions of operating systems and of ports to boards that start threads, or set the transport."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from amalthea_uros.diagnostics import Location
from amalthea_uros.source.boards import serial_of_board
from amalthea_uros.source.entities import callback_of
from amalthea_uros.source.facts import CodeTransport, Stated, Thread
from amalthea_uros.source.program import CodeProgram
from amalthea_uros.source.scope import Expression
from amalthea_uros.source.syntax import descendants, text_of
from amalthea_uros.source.walk import CodeWalk, FunctionCall

#: In picoseconds.
MICROSECOND, MILLISECOND, SECOND = 10**6, 10**9, 10**12

#: Of a stack of FreeRTOS that is counted in words.
WORD = 4
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
#: The first version, of which FreeRTOS gets the distance to the lowest one: STM32Cube Middlewares, CMSIS_RTOS/cmsis_os.c.
_FIRST_CMSIS_PRIORITIES = {name: number for number, name in enumerate(_CMSIS_PRIORITIES)}


class _ThreadForm(NamedTuple):
    """Positions of the arguments of a function that creates a thread, such as what its entry is given; None: it has none."""

    entry: int
    argument: int
    name: int | None = None
    stack: int | None = None
    priority: int | None = None
    core: int | None = None
    attributes: int | None = None
    rtos: str = ""


FORMS: Mapping[str, _ThreadForm] = {
    "xTaskCreate": _ThreadForm(0, 3, 1, 2, 4, rtos="freertos"),
    "xTaskCreateStatic": _ThreadForm(0, 3, 1, 2, 4, rtos="freertos"),
    "xTaskCreatePinnedToCore": _ThreadForm(0, 3, 1, 2, 4, 6, rtos="freertos"),
    "xTaskCreateStaticPinnedToCore": _ThreadForm(0, 3, 1, 2, 4, 7, rtos="freertos"),
    # Of Arduino for ESP32, and of FreeRTOS for several cores, of which it takes a set.
    "xTaskCreateUniversal": _ThreadForm(0, 3, 1, 2, 4, 6, rtos="freertos"),
    "xTaskCreateAffinitySet": _ThreadForm(0, 3, 1, 2, 4, rtos="freertos"),
    "osThreadNew": _ThreadForm(0, 1, attributes=2, rtos="freertos"),
    # What it is given comes with osThreadCreate.
    "osThreadDef": _ThreadForm(1, 5, 0, 4, 2, rtos="freertos"),
    "K_THREAD_DEFINE": _ThreadForm(2, 3, 0, 1, 6, rtos="zephyr"),
    # Of the firmware of the Crazyflie.
    "STATIC_MEM_TASK_CREATE": _ThreadForm(1, 3, 2, priority=4, rtos="freertos"),
    "k_thread_create": _ThreadForm(3, 4, 0, 2, 7, rtos="zephyr"),
    "pthread_create": _ThreadForm(2, 3, 0),
}


#: Those that count stacks in words, except in ESP-IDF.
_IN_WORDS = ("xTaskCreate", "xTaskCreateStatic", "xTaskCreateAffinitySet", "osThreadDef")


def thread_of(call: FunctionCall, walk: CodeWalk, unit: int | None) -> Thread | None:
    """The thread that a call creates.

    Parameters
    ----------
    unit : in which stacks of `xTaskCreate` are counted, in bytes: words of FreeRTOS, but not in ESP-IDF; None if that is unknown
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
    factor = unit if call.name in _IN_WORDS else 1
    size = stack.number if stack is not None else None
    return Thread(
        name=(
            name.string or (name.name if form.rtos != "freertos" or call.name == "osThreadDef" else None)
            if name is not None
            else None
        )
        or callback.name,
        entry=callback.function,
        place=call.place,
        stack=size * factor if size is not None and factor is not None and size > 0 else None,
        priority=_priority(priority, _FIRST_CMSIS_PRIORITIES if call.name == "osThreadDef" else _CMSIS_PRIORITIES),
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


def _priority(given: Expression | None, named: Mapping[str, int]) -> int | None:
    if given is None:
        return None
    if given.resolved.name in named:
        return named[given.resolved.name]
    number = given.number
    return number if number is not None and number >= 0 else None


#: Functions that set a network; the bit rate of the link is not in the code.
_UDP = (
    "set_microros_wifi_transports",
    "set_microros_native_ethernet_transports",
    "set_microros_native_ethernet_udp_transports",
    "rmw_uros_options_set_udp_address",
)
_SERIAL = ("set_microros_transports", "set_microros_serial_transports")
SETTERS = frozenset({*_UDP, *_SERIAL, "rmw_uros_set_custom_transport"})
#: The rate at which `set_microros_transports` of micro_ros_arduino opens the line: src/default_transport.cpp.
_ARDUINO = 115200


def transport_of(
    calls: Iterable[FunctionCall], program: CodeProgram, build: Stated | None, port: str, board: str
) -> CodeTransport | None:
    """The transport that the first call of a function for it sets; None if there is none.

    Parameters
    ----------
    build : what files of the build system say, which counts first
    board : as PlatformIO or amuros calls it; "" if unknown
    """
    every = list(calls)
    call = next((each for each in every if each.name in SETTERS), None)
    place = build.place if build is not None else call.place if call is not None else None
    if place is None:
        return None
    keys = {_key(each, port, board) for each in every if each.name in SETTERS and each.uncertain}
    if build is None and len(keys) > 1:
        note = "by a condition that the sources do not decide"
        return CodeTransport(key=None, values=(), note=note, place=place)
    key = build.value if build is not None else _key(call, port, board) if call is not None else None
    rate = _baud_rate(every, program)
    if call is not None and call.name == "set_microros_transports":
        rate = rate or _ARDUINO
    match key:
        case "udp":
            return CodeTransport(
                key=key, values=(("bitrate", None),), note="bit rate of the link of the controller", place=place
            )
        case "usb_cdc":
            return CodeTransport(key=key, values=(), note="full speed", place=place)
        case "serial":
            return _serial(rate, place)
    is_serial = call is not None and call.name in _SERIAL
    note = (
        f"usb_cdc if Serial is a USB port of the board itself, else serial{f' with {rate} symbols per second' if rate else ''}"
    )
    return CodeTransport(key=None, values=(), note=note if is_serial else "custom transport", place=place)


def _key(call: FunctionCall, port: str, board: str) -> str | None:
    """The wire of a call that sets the transport, as `app.yaml` calls it; None if the code does not say it."""
    given = call.argument(0)
    if call.name in _UDP:
        return "udp"
    if call.name in _SERIAL:
        line = given.name if given is not None else "Serial"
        return "usb_cdc" if line == "SerialUSB" else "serial" if line != "Serial" else serial_of_board(board)
    names = " ".join(argument.text for argument in call.arguments).lower()
    if re.search(r"\bh?(fd)?can\d*\b", names) is not None:
        # How the messages are cut to frames is up to the application.
        return None
    is_framed = given is not None and given.resolved.text in ("true", "1")
    if is_framed or any(word in names for word in ("serial", "uart", "usb", "cdc")):
        if port == "pico-sdk":
            # Standard input and output, by USB or by a UART as the build says.
            return None
        return "usb_cdc" if "usb" in names or "cdc" in names else "serial"
    return "udp" if "udp" in names else None


def _serial(rate: int | None, place: Location) -> CodeTransport:
    value = str(rate) if rate is not None else None
    return CodeTransport(key="serial", values=(("baud_rate", value),), note="symbols per second, as the agent has", place=place)


def _baud_rate(calls: Iterable[FunctionCall], program: CodeProgram) -> int | None:
    """The rate that the code sets anywhere, if it sets only one."""
    begun = (each.argument(0) for each in calls if each.name.endswith("Serial.begin"))
    rates = {given.number for given in begun if given is not None}
    for file, root in program.files:
        for node in descendants(root):
            name = node.child_by_field_name("designator") or node.child_by_field_name("left")
            value = node.child_by_field_name("value") or node.child_by_field_name("right")
            if name is not None and value is not None and text_of(name).endswith((".baud_rate", ".BaudRate")):
                rates.add(Expression(program, value, file).number)
    return next(iter(rates)) if len(rates) == 1 else None
