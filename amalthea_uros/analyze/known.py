"""What is known of the processes of a system: where they run, what they cost, how they arrive; and why something is not known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from amalthea_uros.analyze.arrivals import Arrivals
from amalthea_uros.analyze.cost import Cost
from amalthea_uros.analyze.demand import Demands, UnknownDemandError
from amalthea_uros.analyze.notes import Notes
from amalthea_uros.analyze.placement import Placed, Placement, UnplacedError
from amalthea_uros.analyze.propagation import Propagation, UnknownArrivalsError
from amalthea_uros.analyze.task import Response
from amalthea_uros.perf.system import System
from amalthea_uros.units import Frequency


@dataclass(slots=True)
class Known:
    """What is known of processes, by their names.

    Attributes
    ----------
    frequencies : of cores, instead of what the system says
    scale : factor on all execution times
    costs : in grains of the core
    reasons : why the response time of a process is not known
    disturbed : (core, whether by interrupts) -> who may run there in a way for which there is no analysis
    """

    system: System
    frequencies: dict[str, Frequency]
    scale: Fraction
    notes: Notes = field(default_factory=Notes)
    placed: dict[str, Placed] = field(default_factory=dict)
    costs: dict[str, Cost] = field(default_factory=dict)
    arrivals: dict[str, Arrivals] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    disturbed: dict[tuple[str, bool], str] = field(default_factory=dict)

    @property
    def demands(self) -> Demands:
        """The demand of processes."""
        return Demands(self.system, self.notes, self.frequencies, self.scale)

    def give_up(self, name: str, reason: str) -> None:
        """Note that the response time of a process is not known."""
        self.reasons.setdefault(name, reason)

    def place(self) -> None:
        """Find core, priority and cost of each process."""
        placement = Placement(self.system, self.notes)
        for allocation in self.system.mapping.tasks:
            try:
                placed = placement.task(allocation)
                if placed.process.name in self.placed:
                    self.give_up(placed.process.name, "it is allocated more than once")
                self.placed[placed.process.name] = placed
            except UnplacedError as error:
                self.give_up(allocation.task, str(error))
                scheduler = self.system.schedulers.get(allocation.scheduler)
                self._disturb(allocation.cores or (scheduler.cores if scheduler else ()), False, allocation.task)
        for isr in self.system.mapping.isrs:
            try:
                self.placed[isr.isr] = placement.isr(isr.isr, isr.controller, isr.priority)
            except UnplacedError as error:
                self.give_up(isr.isr, str(error))
                controller = self.system.interrupt_controllers.get(isr.controller)
                self._disturb(controller.cores if controller else (), True, isr.isr)
        for name in self.system.processes:
            if name not in self.placed:
                self.give_up(name, "it is not allocated to a scheduler")
        self._find_costs()

    def _disturb(self, cores: Iterable[str], is_isr: bool, name: str) -> None:
        for core in cores:
            self.disturbed.setdefault((core, is_isr), name)

    def _find_costs(self) -> None:
        demands = self.demands
        for name, placed in self.placed.items():
            try:
                self.costs[name] = demands.cost(placed.process, placed.core)
            except UnknownDemandError as error:
                self.notes.warning("ANA004", f"the demand of {name!r} is not known: {error}", placed.process)
                self.give_up(name, str(error))

    def find_arrivals(self, propagation: Propagation, responses: Mapping[str, Response]) -> None:
        """Find the arrivals of each process, given the response times so far."""
        self.arrivals = {}
        for name, placed in self.placed.items():
            try:
                self.arrivals[name] = propagation.arrivals(placed.process, responses)
            except UnknownArrivalsError as error:
                self.notes.warning("ANA005", f"the arrivals of {name!r} are not known: {error}", placed.process)
                self.give_up(name, str(error))

    def on_core(self, core: str) -> list[Placed]:
        """The processes of a core, those first that are served first."""
        return sorted((p for p in self.placed.values() if p.core == core), key=lambda p: p.rank, reverse=True)

    def usable(self, here: list[Placed], core: str) -> list[Placed]:
        """The processes above everything of which too little is known; the reasons of the others are noted."""
        found: list[Placed] = []
        culprit: str | None = None
        for placed in here:
            name = placed.process.name
            culprit = culprit or self.disturbed.get((core, True))
            if not placed.is_isr:
                culprit = culprit or self.disturbed.get((core, False))
            if culprit is not None:
                self.give_up(name, f"too little is known of {culprit!r}, which may come before it")
            elif name in self.costs and name in self.arrivals:
                found.append(placed)
            else:
                culprit = name
        return found
