"""Executors of one session exclude each other.

With several threads, the one that waits for input holds the mutex of the session and of the transport for the rest of its timeout;
others can neither receive nor publish meanwhile (eProsima/Micro-XRCE-DDS-Client#311).
"""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.system import System
from amalthea_uros.timing.executors.answers import Written, answering
from amalthea_uros.timing.executors.sending import suspension_of
from amalthea_uros.timing.executors.wait import greatest_wait
from amalthea_uros.units import Time

ASSUMPTION = "threads get the mutex of a session in the order in which they ask for it, and execute at once while they hold it"


def held_by_others(executor: Executor, system: System, sending: Mapping[str, Span], written: Written) -> Time | None:
    """How long the other executors of its session can keep it from an executor that asks for it; None if that is not known."""
    total: Time = 0
    for other in system.executors:
        if executor.session is None or other.session != executor.session or other.name == executor.name:
            continue
        reading = answering(other, system, sending, written).most
        if reading is None:
            return None
        found = [greatest_wait(other) + reading]
        for handle in other.handles:
            most = suspension_of(handle, system, sending, 0).most
            if most is None:
                return None
            found.append(most)
        total += max(found)
    return total
