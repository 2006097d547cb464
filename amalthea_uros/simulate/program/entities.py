"""The entities of a system in a trace, and their numbers."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.network import Wire
from amalthea_uros.perf.software import Isr
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import arriving
from amalthea_uros.trace.table import Entity, EntityKind


@dataclass(slots=True)
class EntityNumbers:
    """The entities of a system, in a fixed order."""

    system: System
    all: tuple[Entity, ...] = field(init=False)
    _numbers: dict[Entity, int] = field(init=False)

    def __post_init__(self) -> None:
        self.all = tuple(dict.fromkeys(_entities(self.system)))
        self._numbers = {entity: number for number, entity in enumerate(self.all)}

    def number(self, kind: EntityKind, name: str) -> int:
        """The number of an entity."""
        return self._numbers[Entity(kind, name)]

    def process(self, name: str) -> int:
        """The number of a process."""
        is_isr = isinstance(self.system.processes[name], Isr)
        return self.number(EntityKind.ISR if is_isr else EntityKind.TASK, name)


def losses_name(wire: Wire) -> str:
    """The name of the stimulus that stands for the losses on a wire in a trace."""
    return f"losses on {wire.name}"


def _entities(system: System) -> Iterator[Entity]:
    for name, process in system.processes.items():
        yield Entity(EntityKind.ISR if isinstance(process, Isr) else EntityKind.TASK, name)
    yield from (Entity(EntityKind.CORE, name) for name in system.cores)
    yield from (Entity(EntityKind.SCHEDULER, name) for name in system.schedulers)
    yield from (Entity(EntityKind.STIMULUS, name) for name in (*system.stimuli_by_name, *arriving(system)))
    yield from (Entity(EntityKind.STIMULUS, losses_name(wire)) for wire in system.network.wires if wire.losses)
    yield from (Entity(EntityKind.RUNNABLE, name) for name in system.runnables)
    yield from (Entity(EntityKind.LABEL, name) for name in system.labels)
    yield from (Entity(EntityKind.SEMAPHORE, semaphore.name) for semaphore in system.os.semaphores)
    yield from (Entity(EntityKind.OS_EVENT, event.name) for event in system.software.os_events)
    yield from (Entity(EntityKind.CHAIN, name) for name in system.chains)
