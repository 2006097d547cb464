"""The execution demand of processes on each kind of core, where the model does not state a single core with a known clock.

Cores of one type and clock are one kind. Where the clock is unknown, or the model has no cores, the demand is counted in ticks: at a
terahertz, a tick takes a picosecond. Without cores, each type that a demand names is a kind, and one stands for all others.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from functools import cached_property

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Execute, WaitEvent, Waiting
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.time_base import MAX_INPUT
from amalthea_uros.timing.demand.model import DemandModel
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.executed import executed, states_execution_time
from amalthea_uros.units import Frequency

#: At this frequency, a tick takes a picosecond.
_TERAHERTZ = Frequency(10**12)


@dataclass(frozen=True, slots=True)
class AlikeCores:
    """Cores of one type and clock.

    Attributes
    ----------
    type : None: any, or not stated
    frequency : None: unknown, so that demand is counted in ticks
    cores : empty if the model has none
    """

    type: str | None
    frequency: Frequency | None
    cores: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class DemandOnCores:
    """The demand of a process on alike cores.

    Attributes
    ----------
    demand : of a job, without the time for which it waits for events; None if it is unknown, for the `reason`
    time_base : units of the demand per picosecond, or per tick if the clock is unknown
    """

    on: AlikeCores
    demand: MultiframeDemand | None
    time_base: int
    reason: str = ""


@dataclass
class DemandOnAnyCores:
    """The demand of the processes of a system on each kind of core.

    Attributes
    ----------
    stated : converts activities to demand where cores and clocks are stated
    """

    stated: DemandModel
    _kinds: dict[frozenset[str], Sequence[AlikeCores]] = field(default_factory=dict)

    def of(self, process: Process, cores: Collection[str]) -> Iterator[DemandOnCores]:
        """The demand of a process on each kind of core.

        Parameters
        ----------
        cores : on which it may run; empty: on any
        """
        model = self._counting
        allowed = frozenset(cores or model.system.cores)
        if not self.stated.system.cores:
            named = _named_types(process, model.system)
            allowed = frozenset(name for name, core in model.system.cores.items() if core.type is None or core.type in named)
        if allowed not in self._kinds:
            self._kinds[allowed] = self._alike(allowed)
        for kind in self._kinds[allowed]:
            yield self._on(kind, model.system.processes[process.name])

    def waits(self, process: Process, how: Collection[Waiting | None] = (None, *Waiting)) -> bool:
        """Whether a process waits for events, in one of some ways; None: it is not stated."""
        activities = executed(process.activities, self.stated.system)
        return any(isinstance(each, WaitEvent) and each.waiting in how for each in activities)

    @cached_property
    def _counting(self) -> DemandModel:
        """The same for demands without waits, in ticks where no clock is stated, and on hypothetical cores where there are none."""
        system = self.stated.system
        if not system.cores:
            system = _with_hypothetical_cores(system)
        unknown = {core: _TERAHERTZ for core in system.cores if self._frequency(core) is None}
        settings = self.stated.settings
        frequencies = {**settings.frequencies, **unknown}
        return DemandModel(system, self.stated.notes, replace(settings, frequencies=frequencies), ignores_waits=True)

    def _frequency(self, core: str) -> Frequency | None:
        return self.stated.frequency(core) if core in self.stated.system.cores else None

    def _alike(self, cores: Collection[str]) -> Sequence[AlikeCores]:
        by_kind: dict[tuple[str | None, Frequency | None], list[str]] = {}
        for name, core in self._counting.system.cores.items():
            if name in cores:
                by_kind.setdefault((core.type, self._frequency(name)), []).append(name)
        return [AlikeCores(core_type, frequency, tuple(names)) for (core_type, frequency), names in by_kind.items()]

    def _on(self, alike: AlikeCores, process: Process) -> DemandOnCores:
        model = self._counting
        time_base = model.time_base(alike.cores[0])
        shown = alike if self.stated.system.cores else replace(alike, cores=())
        try:
            if not states_execution_time(process, model.system):
                raise UnknownError("it has no execution time, and neither have the runnables that it calls")
            demands = [model.of_process(process, core) for core in alike.cores]
            if any(demand.worst > MAX_INPUT for demand in demands):
                raise UnknownError("its execution time exceeds the supported range of times")
            # Alike cores can be at different distances from a memory.
            if len({(demand.best, demand.worst, demand.mean_worst, demand.mean) for demand in demands}) > 1:
                raise UnknownError("its accesses take longer on some of these cores than on others")
        except UnknownError as error:
            return DemandOnCores(shown, None, time_base, str(error))
        return DemandOnCores(shown, demands[0], time_base)


def _named_types(process: Process, system: System) -> frozenset[str]:
    """The types of cores that the demands of a process name."""
    demands = (each.demand for each in executed(process.activities, system) if isinstance(each, Execute))
    return frozenset(core_type for demand in demands for core_type, _ in demand.by_core_type)


def _with_hypothetical_cores(system: System) -> System:
    """The system with a core of each type that any demand names, and one of no type."""
    types = sorted({name for process in system.processes.values() for name in _named_types(process, system)})
    cores = tuple(Core(name=f"core of type {each}" if each else "core", type=each, clock="clock") for each in (None, *types))
    structure = Structure(name="hypothetical", cores=cores)
    return replace(system, hardware=Hardware(clocks=(Clock(name="clock"),), structures=(structure,)))
