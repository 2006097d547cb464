"""Callbacks that wait for acknowledgements although no wire says how long these take.

In executors that spin in loops, publications say so themselves; messages on wires of the system, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.perf.network import Wait
from amalthea_uros.perf.system import System
from amalthea_uros.uros.application import body_name
from amalthea_uros.uros.callbacks import Callback
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.publications import publications


def waits_outside(callbacks: Iterable[Callback], system: System, profile: Profile) -> Iterator[Wait]:
    """The waits of callbacks that no executor in a loop runs, for acknowledgements of messages that no wire of the system has.

    Parameters
    ----------
    system : with its executors and its wires
    """
    loops = {executor.name for executor in system.executors}
    wired = {transmission.name for transmission in system.network.transmissions if transmission.waits}
    for callback in callbacks:
        if callback.in_executor and callback.executor in loops:
            continue
        for each in publications(callback, profile):
            if each.waits and each.transmission not in wired:
                yield Wait(runnable=body_name(callback.name), topic=each.topic, timeout=each.timeout)
