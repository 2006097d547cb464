"""The execution times that am2inc reads."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import Ticks, TicksEntry
from amalthea_uros.metamodel.element import Element


def is_read(value: Element) -> bool:
    """Whether a value is the default of Ticks or, if there is none, the first extended entry."""
    holder = value.container
    if isinstance(holder, TicksEntry):
        ticks = holder.container
        return isinstance(ticks, Ticks) and ticks.default is None and ticks.extended[0] is holder
    return isinstance(holder, Ticks)
