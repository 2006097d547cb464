"""What a picture or graph of a system shows: its processes on their cores, and what connects them."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.software import Isr, Process
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess, Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.report.wording.cells import activation_text
from amalthea_uros.timing.context import ProcessPlacement, TimingContext
from amalthea_uros.timing.dataflow.chains import unfold
from amalthea_uros.timing.dataflow.links import LinkKind, reads, writes
from amalthea_uros.timing.dataflow.routes import routes_of_paths


@dataclass(frozen=True, slots=True)
class Flow:
    """What goes from one process to others.

    Attributes
    ----------
    kind : data, a trigger, an OS event, a server call, or a topic
    names : of labels, channels, stimuli and so on that all targets have in common
    """

    kind: LinkKind
    source: str
    names: tuple[str, ...]
    targets: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FlowSource:
    """What comes from outside: a stimulus that is not periodic, or a channel that no process fills.

    Attributes
    ----------
    targets : the processes that it activates or feeds
    """

    name: str
    targets: tuple[str, ...]
    is_stimulus: bool


@dataclass(frozen=True, slots=True)
class ChainPath:
    """The processes along a chain, of its first route; empty for the `reason`."""

    name: str
    processes: tuple[str, ...]
    reason: str = ""


@dataclass(frozen=True)
class SystemFlows:
    """A system as its pictures show it.

    Attributes
    ----------
    context : where processes run, and how they are connected
    """

    system: System
    context: TimingContext

    @classmethod
    def of(cls, system: System, analysis: Analysis | None = None) -> SystemFlows:
        """Those of a system; its analysis has followed the activities already."""
        return cls(system, analysis.solution.context if analysis is not None else TimingContext.of_scheduling(system))

    @cached_property
    def cores(self) -> dict[str | None, tuple[Process, ...]]:
        """The processes of each core that has some, the most urgent first; None: those with no core, or several ones."""
        found: dict[str | None, list[Process]] = {core: [] for core in (*self.system.cores, None)}
        for process in self.system.processes.values():
            found.setdefault(self.placement(process.name).core, []).append(process)
        return {core: tuple(sorted(own, key=self._urgency)) for core, own in found.items() if own}

    def placement(self, process: str) -> ProcessPlacement:
        """The core and the priority of a process."""
        return self.context.placement(process)

    def _urgency(self, process: Process) -> tuple[bool, float]:
        priority = self.placement(process.name).priority
        return not isinstance(process, Isr), float("inf") if priority is None else -priority

    @cached_property
    def flows(self) -> tuple[Flow, ...]:
        """The flows between processes: one for all data that go from a process to the same others."""
        targets: dict[tuple[LinkKind, str, str], dict[str, None]] = {}
        for link in () if self.problem else self.context.dataflow.direct():
            targets.setdefault((link.kind, link.source, link.name), {})[link.target] = None
        names: dict[tuple[LinkKind, str, tuple[str, ...]], list[str]] = {}
        for (kind, source, name), found in targets.items():
            names.setdefault((kind, source, tuple(found)), []).append(name)
        return tuple(Flow(kind, source, tuple(own), found) for (kind, source, found), own in names.items())

    @cached_property
    def problem(self) -> str:
        """Why the flows are unknown, if they are: a process executes too many activities to be followed."""
        try:
            for process in self.system.processes:
                self.context.dataflow.by_name(process, writes)
        except UnknownError as error:
            return str(error)
        return ""

    @cached_property
    def sources(self) -> tuple[FlowSource, ...]:
        """What comes from outside; periodic activations are not listed, because they are said at the process."""
        return (*self._stimuli(), *self._messages())

    def _stimuli(self) -> Iterable[FlowSource]:
        for stimulus in self.system.stimuli.stimuli:
            targets = tuple(each.name for each in self.system.processes.values() if stimulus.name in each.stimuli)
            if targets and not isinstance(stimulus, Periodic | InterProcess | EventTriggered):
                yield FlowSource(stimulus.name, targets, is_stimulus=True)

    def _messages(self) -> Iterable[FlowSource]:
        dataflow, processes = self.context.dataflow, self.system.processes
        for channel in () if self.problem else self.system.channels.values():
            if not any(channel.name in dataflow.by_name(name, writes) for name in processes):
                targets = tuple(name for name in processes if channel.name in dataflow.by_name(name, reads))
                if targets:
                    yield FlowSource(channel.name, targets, is_stimulus=False)

    @cached_property
    def chains(self) -> tuple[ChainPath, ...]:
        """The event chains, as the processes that they pass."""
        return tuple(self._path(name) for name in self.system.chains)

    def _path(self, name: str) -> ChainPath:
        try:
            ways = routes_of_paths(unfold(self.system.chains[name], self.context.system)[0], self.context.dataflow)
        except UnknownError as error:
            return ChainPath(name, (), str(error))
        route, *_ = next(iter(ways.values()))
        passed = [occurrence.process.name for occurrence in route.occurrences]
        return ChainPath(
            name, tuple(process for process, before in zip(passed, [None, *passed], strict=False) if process != before)
        )

    def activation(self, process: str) -> str:
        """What activates a process, in a few words."""
        stimuli = self.system.stimuli_by_name
        found = [activation_text(stimuli[name]) for name in self.system.processes[process].stimuli if name in stimuli]
        return ", ".join(found) or "not activated"
