"""The transport to the agent that sources set."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.source.facts import CodeTransport
from amalthea_uros.source.program import CodeProgram
from amalthea_uros.source.scope import Expression
from amalthea_uros.source.syntax import descendants, text_of
from amalthea_uros.source.walk import FunctionCall

#: Functions that set a network; the bit rate of the link is not in the code.
_UDP = ("set_microros_wifi_transports", "set_microros_native_ethernet_transports", "rmw_uros_options_set_udp_address")
_SERIAL = ("set_microros_transports", "set_microros_serial_transports")
SETTERS = frozenset({*_UDP, *_SERIAL, "rmw_uros_set_custom_transport"})
#: The rate at which `set_microros_transports` of micro_ros_arduino opens the line: src/default_transport.cpp.
_ARDUINO = 115200


def transport_of(calls: Iterable[FunctionCall], program: CodeProgram) -> CodeTransport | None:
    """The transport that the first call of a function for it sets; None if there is none."""
    every = list(calls)
    call = next((each for each in every if each.name in SETTERS), None)
    if call is None:
        return None
    if call.name in _UDP:
        return CodeTransport(
            key="udp", values=(("bitrate", None),), note="bit rate of the link of the controller", place=call.place
        )
    rate = _baud_rate(every, program)
    if call.name in _SERIAL:
        rate = rate or (_ARDUINO if call.name == "set_microros_transports" else None)
        return _serial(rate, call)
    framed = call.argument(0)
    names = " ".join(argument.text for argument in call.arguments).lower()
    is_framed = framed is not None and framed.resolved.text in ("true", "1")
    if is_framed or any(word in names for word in ("serial", "uart", "usb", "cdc")):
        is_usb = "usb" in names or "cdc" in names
        return CodeTransport(key="usb_cdc", values=(), note="full speed", place=call.place) if is_usb else _serial(rate, call)
    if "udp" in names:
        return CodeTransport(
            key="udp", values=(("bitrate", None),), note="bit rate of the link of the controller", place=call.place
        )
    return CodeTransport(key=None, values=(), note="custom transport", place=call.place)


def _serial(rate: int | None, call: FunctionCall) -> CodeTransport:
    value = str(rate) if rate is not None else None
    return CodeTransport(
        key="serial", values=(("baud_rate", value),), note="symbols per second, as the agent has", place=call.place
    )


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
