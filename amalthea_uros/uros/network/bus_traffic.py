"""The messages of an application on its bus, and what queues them.

The agent sends at any time, but never more often than the description says. The controller sends at the end of callbacks; if one runs
in activations of its own task between two messages, too, it does not publish in these.
"""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.events import RunnableChange, RunnableEvent
from amalthea_uros.perf.stimuli import Counter, EventTriggered, Periodic, RelativePeriodic, Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import body_name
from amalthea_uros.uros.network.bus_system import BusTransmission, with_bus
from amalthea_uros.uros.transports.bus_messages import BusMessage
from amalthea_uros.uros.transports.can import CanBus, block_bytes

#: Greater than all identifiers.
_OF_CLIENT = 2**29


def with_traffic(system: System, bus: CanBus, messages: Iterable[BusMessage]) -> System:
    """The system of an application with its bus, which changes nothing of its other processes.

    Messages without an identifier of their own have the one of the client, which loses against the others: they are sent in the order
    in which they were queued.
    """
    transmissions, events = [], []
    for message in messages:
        name = message.name
        if not message.incoming:
            events.append(_end_of_callback(message, name))
        transmissions.append(
            BusTransmission(
                name=name,
                frames=[frame for part in message.parts for frame in block_bytes(part)],
                identifier=_OF_CLIENT if message.identifier is None else message.identifier,
                stimulus=_stimulus(message, name, system),
                origin=message.message.origin,
            )
        )
    return with_bus(system, bus, transmissions, events)


def _end_of_callback(message: BusMessage, name: str) -> RunnableEvent:
    return RunnableEvent(name=name, runnable=body_name(message.message.callback), change=RunnableChange.TERMINATE)


def _stimulus(message: BusMessage, name: str, system: System) -> Stimulus:
    interval = message.message.interval
    if message.incoming:
        return RelativePeriodic(name=name, distance=Constant(interval), has_maximum=False)
    every = runs_per_message(message.message.callback, interval, system)
    return EventTriggered(name=name, events=(name,), counter=Counter(prescaler=every) if every > 1 else None)


def runs_per_message(callback: str, interval: Time, system: System) -> int:
    """How often a callback runs for each message: more than once if it runs in every activation of a task of its own."""
    task = system.processes.get(callback)
    if task is None or any(isinstance(each, Call) and each.counter is not None for each in task.activities):
        return 1
    stimulus = system.stimuli_by_name[task.stimuli[0]]
    return max(1, interval // stimulus.period) if isinstance(stimulus, Periodic) else 1
