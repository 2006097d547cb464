"""What is not observed because a process that it depends on is not simulated: what is seen of it is no behaviour of the system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.limits import Stated
from amalthea_uros.perf.constraints import DataAgeConstraint, LatencyConstraint, OrderConstraint, Requirement
from amalthea_uros.perf.events import Event
from amalthea_uros.simulate.program.watches import event_names, simple_events
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import sequences, unfold
from amalthea_uros.timing.dataflow.links import reads, writes
from amalthea_uros.timing.jobs.positions import ActivityPosition

#: Why nothing was observed of a requirement on a process that is not simulated.
LIMITED_PROCESS_LEFT_OUT = "the process that it limits is not simulated"


@dataclass(frozen=True)
class NotSimulated:
    """The effect of processes that are not simulated.

    Attributes
    ----------
    names : of these processes
    """

    context: TimingContext
    names: frozenset[str]

    @cached_property
    def _touched(self) -> Mapping[str, str]:
        """The processes that they can touch, each with one of them."""
        return self.context.touching.closure(name for name in self.context.system.processes if name in self.names)

    def doubt_about(self, process: str) -> str:
        """Why what is seen of a process is no behaviour of the system; "" if it is one."""
        origin = self._touched.get(process)
        return "" if origin is None else consequence_of(origin)

    def doubt_about_limits(self) -> Mapping[str, str]:
        """The same for requirements and constraints, by their names."""
        return {name: consequence_of(origin) for name, origin in self._origins.items()}

    @cached_property
    def _origins(self) -> Mapping[str, str]:
        """By the names of requirements and constraints: a process that is not simulated, on which they depend."""
        if not self.names:
            return {}
        constraints, found = self.context.system.constraints, dict[str, str]()
        for each in (*constraints.requirements, *constraints.constraints, *constraints.data_ages, *constraints.orders):
            origins = (self._touched.get(name) for name in self._limited(each))
            origin = next((origin for origin in origins if origin is not None), None)
            if origin is not None:
                found.setdefault(each.name, origin)
        return found

    def _limited(self, limiting: Stated) -> Iterator[str]:
        """The processes of which something is limited; all if that is unknown."""
        try:
            match limiting:
                case Requirement(process=process, runnable=runnable):
                    yield from (process,) if process is not None else self._executing((runnable or "",))
                case DataAgeConstraint(label=label):
                    yield from self._accessing(label)
                case OrderConstraint(groups=groups):
                    yield from self._executing(name for group in groups for name in group)
                case LatencyConstraint(chain=chain):
                    yield from self._on_events(self._events_of_chain(chain))
                case _:
                    yield from self._on_events(simple_events(event_names(limiting, self.context.system), self.context.system))
        except UnknownError:
            yield from self.context.system.processes

    def _on_events(self, events: Iterable[Event]) -> Iterator[str]:
        for event in events:
            process = getattr(event, "process", None)
            if process is not None:
                yield process
            else:
                yield from (occurrence.process.name for occurrence in self.context.dataflow.events.of(event))

    def _events_of_chain(self, name: str) -> Iterator[Event]:
        system = self.context.system
        if name in system.chains:
            unfolded, _ = unfold(system.chains[name], system)
            yield from (system.events_by_name[event] for way in sequences(unfolded) for event in way)

    def _executing(self, runnables: Iterable[str]) -> Iterator[str]:
        wanted = frozenset(runnables)
        return (p.process.name for p in self._positions() if getattr(p.activity, "runnable", None) in wanted)

    def _accessing(self, label: str) -> Iterator[str]:
        return (p.process.name for p in self._positions() if label in (*writes(p), *reads(p)))

    def _positions(self) -> Iterator[ActivityPosition]:
        return self.context.dataflow.events.all_positions()


def consequence_of(origin: str) -> str:
    """Why what depends on a process that is not simulated is not observed."""
    return f"depends on {origin!r}, which is not simulated"
