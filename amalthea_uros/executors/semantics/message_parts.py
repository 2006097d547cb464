"""How many parts a message is sent in."""

from __future__ import annotations

from amalthea_uros.perf.activities import Trigger, walk
from amalthea_uros.perf.network import Transmission
from amalthea_uros.perf.system import System


def parts(acknowledgement: Transmission, system: System) -> int:
    """How many parts of a message are acknowledged one by one."""
    stimuli = set(system.processes[acknowledgement.name].stimuli)
    counts = (
        sum(isinstance(each, Trigger) and each.stimulus in stimuli for each in walk(body)) for body in system.software.bodies
    )
    return max(1, *counts)
