"""Error frames: what the controller says about the bus, and frames that it lost (`linux/can/error.h`)."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.problems import Place, Problems

#: Bits of the class; the second byte says which problem a controller has.
_CLASSES = {
    0x001: "timeout of a transmission",
    0x002: "lost arbitration",
    0x004: "problem of the controller",
    0x008: "violation of the protocol",
    0x010: "problem of the transceiver",
    0x020: "no acknowledgement",
    0x040: "bus off",
    0x080: "bus error",
    0x100: "restarted after bus off",
    0x200: "error counters",
}
_CONTROLLER = 0x004
_RECEIVE_OVERFLOW = 0x01


def is_receive_overflow(classes: int, data: bytes) -> bool:
    """Whether the controller has lost received frames."""
    return bool(classes & _CONTROLLER and len(data) > 1 and data[1] & _RECEIVE_OVERFLOW)


def report_error(problems: Problems, classes: int, data: bytes, place: Place) -> None:
    """Report an error frame."""
    if is_receive_overflow(classes, data):
        message = "the receive buffer of the controller was full, so frames are missing"
        problems.add("CAN003", Severity.WARNING, message, place, _LOST_ADVICE)
        return
    names = ", ".join(name for bit, name in _CLASSES.items() if classes & bit)
    problems.add(
        "CAN004",
        Severity.WARNING,
        f"error frame: {names}" if names else "error frame",
        place,
        "Check the wiring, the bit rate and the load of the bus.",
    )


def report_lost(problems: Problems, place: Place) -> None:
    """Report frames that the recorder has lost."""
    message = "frames were dropped while recording; nothing is known of that time"
    problems.add("CAN003", Severity.WARNING, message, place, _LOST_ADVICE)


_LOST_ADVICE = "Record with a larger buffer (candump -r), with filters, or on a less busy computer."
