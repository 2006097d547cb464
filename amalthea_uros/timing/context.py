"""What is known of the processes of a system: where they run, what they cost, how they arrive; and why something is not known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby

from amalthea_uros.analyze.propagation import Propagation, UnknownArrivalsError
from amalthea_uros.analyze.requirements import upper_response_limits
from amalthea_uros.analyze.response_times.blocking import semaphores_of
from amalthea_uros.analyze.response_times.kernel import LIMIT
from amalthea_uros.analyze.response_times.task import Response
from amalthea_uros.perf.os import Scheduler
from amalthea_uros.perf.system import System
from amalthea_uros.timing.demand import Demands
from amalthea_uros.timing.event_models.base import Arrivals, Periodic
from amalthea_uros.timing.multiframe import Cost
from amalthea_uros.timing.notes import Notes, UnknownDemandError
from amalthea_uros.timing.scheduling import Placed, Placement, Server, UnplacedError
from amalthea_uros.timing.settings import Settings

#: Sums of some such times still fit into 64 bits.
LONGEST = LIMIT // 64


@dataclass
class Known:
    """What is known of processes, by their names.

    Attributes
    ----------
    costs : in grains of the core
    decisions : what a scheduler takes to decide at the arrival of a task, where that is stated; the same again at its end is in `costs`
    reasons : why the response time of a process is not known
    unsettled : processes whose response time and arrivals make each other grow
    disturbed : (core, whether by interrupts) -> who may run there in a way for which there is no analysis
    """

    system: System
    settings: Settings
    notes: Notes = field(default_factory=Notes)
    placed: dict[str, Placed] = field(default_factory=dict)
    servers: dict[str, Server] = field(default_factory=dict)
    costs: dict[str, Cost] = field(default_factory=dict)
    decisions: dict[str, Cost] = field(default_factory=dict)
    arrivals: dict[str, Arrivals] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    unsettled: set[str] = field(default_factory=set)
    disturbed: dict[tuple[str, bool], str] = field(default_factory=dict)

    @cached_property
    def demands(self) -> Demands:
        """The demand of processes."""
        return Demands(self.system, self.notes, self.settings)

    def give_up(self, name: str, reason: str) -> None:
        """Note that the response time of a process is not known."""
        self.reasons.setdefault(name, reason)

    def place(self) -> None:
        """Find core, priority and cost of each process."""
        placement = Placement(self.system, self.notes, upper_response_limits(self.system), self.servers)
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
        self._give_up_remote_semaphores()

    def _disturb(self, cores: Iterable[str], is_isr: bool, name: str) -> None:
        for core in cores:
            self.disturbed.setdefault((core, is_isr), name)

    def _find_costs(self) -> None:
        demands = self.demands
        for name, placed in self.placed.items():
            try:
                cost = demands.cost(placed.process, placed.core)
                scheduler = self._deciding(name, placed.core)
                if scheduler is not None:
                    decision = demands.decision(scheduler, placed.core)
                    self.decisions[name] = decision
                    cost = Cost((*cost.parts, *decision.parts))
                if cost.worst > LONGEST:
                    raise UnknownDemandError("it takes longer than can be counted")
                self.costs[name] = cost
            except UnknownDemandError as error:
                self.notes.warning("ANA004", f"the demand of {name!r} is not known: {error}", placed.process)
                self.give_up(name, str(error))

    def _deciding(self, task: str, core: str) -> Scheduler | None:
        """The scheduler that decides on a core when a task arrives and ends, if that costs anything."""
        allocation = next((allocation for allocation in self.system.mapping.tasks if allocation.task == task), None)
        scheduler = self.system.schedulers.get(allocation.scheduler) if allocation is not None else None
        if scheduler is None or not scheduler.overhead:
            return None
        if scheduler.executing_core not in (None, core):
            message = f"the cost of decisions of {scheduler.name!r} on another core is not taken into account"
            self.notes.warning("ANA006", message, scheduler)
            return None
        return scheduler

    def find_arrivals(self, propagation: Propagation, responses: Mapping[str, Response]) -> None:
        """Find the arrivals of each process, given the response times so far."""
        self.arrivals = {}
        for name, placed in self.placed.items():
            if name in self.unsettled:
                continue
            try:
                arrivals = propagation.arrivals(placed.process, responses)
                if isinstance(arrivals, Periodic) and arrivals.jitter * self.demands.grains(placed.core) > LONGEST:
                    raise UnknownArrivalsError("its jitter is longer than can be counted")
                self.arrivals[name] = arrivals
            except UnknownArrivalsError as error:
                self.notes.warning("ANA005", f"the arrivals of {name!r} are not known: {error}", placed.process)
                self.give_up(name, str(error))

    def _give_up_remote_semaphores(self) -> None:
        """Processes that wait for other cores, or for other servers, have no bound here."""
        users: dict[str, list[Placed]] = {}
        for placed in self.placed.values():
            for name in semaphores_of(placed, self.demands):
                users.setdefault(name, []).append(placed)
        for name, here in users.items():
            if len({(placed.core, placed.server) for placed in here}) > 1:
                for placed in here:
                    message = f"{placed.name!r} may wait for other cores or servers at {name!r}, for which there is no analysis"
                    self.notes.warning("ANA003", message, placed.process)
                    self.give_up(placed.name, f"it may wait for other cores or servers at {name!r}")
                    self.costs.pop(placed.name, None)

    def on_core(self, core: str) -> list[Placed]:
        """The processes of a core."""
        return [placed for placed in self.placed.values() if placed.core == core]

    def served(self, core: str, server: str | None) -> list[Placed | Server]:
        """What lives on a core itself or on the budget of a server, those first that are served first."""
        everything: list[Placed | Server] = [*self.placed.values(), *self.servers.values()]
        found = [item for item in everything if item.core == core and item.server == server]
        return sorted(found, key=lambda item: item.rank, reverse=True)

    def usable(self, here: Sequence[Placed | Server], core: str) -> list[Placed | Server]:
        """Those above everything of which too little is known; the reasons of the others are noted."""
        found: list[Placed | Server] = []
        culprit: str | None = None
        for (is_isr, _), group in groupby(here, key=lambda item: (_is_isr(item), item.rank)):
            level = list(group)
            culprit = culprit or self.disturbed.get((core, True))
            if not is_isr:
                culprit = culprit or self.disturbed.get((core, False))
            unknown = next((item.name for item in level if isinstance(item, Placed) and not self._is_known(item)), None)
            culprit = culprit or unknown
            if culprit is None:
                found += level
            else:
                for item in level:
                    self.give_up_on(item, f"too little is known of {culprit!r}, which may come before it")
        return found

    def _is_known(self, placed: Placed) -> bool:
        return placed.name in self.costs and placed.name in self.arrivals

    def give_up_on(self, item: Placed | Server, reason: str) -> None:
        """Note that the response times of a process, or of all on the budget of a server, are not known."""
        if isinstance(item, Placed):
            self.give_up(item.name, reason)
        else:
            for inner in self.served(item.core, item.name):
                self.give_up_on(inner, reason)


def _is_isr(item: Placed | Server) -> bool:
    return isinstance(item, Placed) and item.is_isr
