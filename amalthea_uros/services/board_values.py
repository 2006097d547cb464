"""What the first `app.yaml` for a board says: values of its platform, as text of the file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.loops import LoopSection
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.transports import TransportSection
from amalthea_uros.units import MICROSECOND, MILLISECOND, SECOND, Time, frequency_text, time_text


def looping_values(board: str) -> Mapping[str, str] | None:
    """The clock, the loop and the transport of a board whose executor spins in a loop; None if that of the board does not."""
    application = Application(nodes=[NodeSection(name="robot")])
    named = Description(amuros=1, name=board, hardware=HardwareSection(platform=board), application=application)
    whole = complete(named, Path()).description
    loop, frequency = whole.middleware.executor.loop, whole.hardware.frequency
    if loop is None:
        return None
    return {
        "frequency": "240 MHz" if frequency is None else frequency_text(frequency),
        "loop": _mapping({key: time_text(getattr(loop, key)) for key in LoopSection.model_fields if loop.states(key)}),
        "calls": _calls(loop),
        "transport": _transport(whole.middleware.transport),
    }


def _calls(loop: LoopSection) -> str:
    """What the loop calls, in C."""
    if loop.spin_some is not None:
        sleep = f" usleep({loop.sleep // MICROSECOND});" if loop.sleep else ""
        return f"for (;;) {{ rclc_executor_spin_some(&executor, {_nanoseconds(loop.spin_some)});{sleep} }}"
    if loop.spin_period is not None:
        return f"rclc_executor_spin_period(&executor, {_nanoseconds(loop.spin_period)})"
    return "rclc_executor_spin(&executor)"


def _nanoseconds(time: Time) -> str:
    return f"RCL_S_TO_NS({time // SECOND})" if time % SECOND == 0 else f"RCL_MS_TO_NS({time // MILLISECOND})"


def _transport(transport: TransportSection) -> str:
    if transport.serial is not None:
        return f"serial: {_mapping({'baud_rate': str(transport.serial.baud_rate)})}"
    if transport.usb_cdc is not None:
        return "usb_cdc: {latency: {min: 0, max: 1 ms}} # until the host polls"
    return ""


def _mapping(values: Mapping[str, str]) -> str:
    return f"{{{', '.join(f'{key}: {value}' for key, value in values.items())}}}"
