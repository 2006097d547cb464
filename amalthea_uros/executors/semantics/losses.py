"""The losses of wires in words."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.perf.network import Direction, Losses, Wire
from amalthea_uros.units import time_text

_PERCENT = 10**7


def losses_text(wire: Wire, losses: Losses) -> str:
    """The assumption about the messages that a wire loses."""
    which = "" if len(losses.directions) == len(Direction) else f" {losses.directions[0]}"
    if losses.window:
        return f"{wire.name!r} loses at most {counted(losses.count, 'message')}{which} in any {time_text(losses.window)}"
    percent = f"{losses.per_billion / _PERCENT:.7f}".rstrip("0").rstrip(".")
    return f"{wire.name!r} loses each message{which} with a probability of {percent} %"
