"""Changes that could shorten a latency of an event chain, in the order in which they are tried."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain as joined
from itertools import zip_longest

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.explanations import CauseKind, ChainExplanation
from amalthea_uros.design.changes.change import Change, compact
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.description.advice import suggestions
from amalthea_uros.design.description.origin import DescriptionOrigin
from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import unknown_phases
from amalthea_uros.units import Time, frequency_text, time_text

#: Where no periods are offered, also these parts of a period: the harmonic ones next to it.
_DIVISORS = (2, 5, 10)
#: Keys of values that are also tried together, because each limits what the other one gains: a sleep takes at least a tick, and a
#: driver that sends a chunk in each tick sends no more of them on a faster line.
_LIMITING_EACH_OTHER = {("tick", "sleep"), ("write", "baud_rate")}
#: LET is left out: a job reads at its release and writes at the end of its period, so none reads later or writes earlier than now.
_NOT_LATER = (Communication.IMPLICIT, Communication.EXPLICIT)


@dataclass(frozen=True, slots=True, kw_only=True)
class ImprovingChange:
    """A change to try.

    Attributes
    ----------
    text : in words, with the values before and after
    changes : of the system or its description; two if priorities are exchanged, more if changes are combined
    communication : of all label accesses; None if it stays
    is_stated : whether the changes are those of a description
    count : of the changes that are made together, which also help one by one
    """

    text: str
    changes: tuple[Change, ...] = ()
    communication: Communication | None = None
    is_stated: bool = False
    count: int = 1

    @property
    def is_combined(self) -> bool:
        """Whether several changes are made together."""
        return self.count > 1

    @property
    def options(self) -> tuple[str, ...]:
        """The options with which `amuros analyze` analyses the changed system."""
        how = () if self.communication is None else ("--communication", str(self.communication).lower())
        return (*(part for change in self.changes for part in ("--set", str(change))), *how)

    def with_communication(self, configuration: Configuration) -> Configuration:
        """A configuration with the communication, if that changes."""
        if self.communication is None:
            return configuration
        return configuration._replace(settings=replace(configuration.settings, communication=self.communication))


def candidates(
    explanation: ChainExplanation,
    analysis: Analysis,
    present: Configuration,
    offered: Sequence[Time],
    source: DescriptionOrigin | None = None,
) -> list[ImprovingChange]:
    """The changes to try, of each sort in turn, so that a limit of their number cuts all sorts.

    Parameters
    ----------
    offered : the periods that tasks can have; empty if they can have any
    """
    processes = _by_share(explanation, analysis)
    sorts = (
        () if source is None else _of_description(source, _cores(present.system)),
        _periods(processes, analysis.solution.context.system, offered),
        _priorities(processes, analysis),
        _offsets(explanation, analysis.solution.context.system),
        # The execution times of a description are those at the present clock.
        _clocks(processes, analysis) if source is None else (),
        _communication(explanation, present),
    )
    every = joined.from_iterable(zip_longest(*sorts))
    return [each for each in every if each is not None]


def _by_share(explanation: ChainExplanation, analysis: Analysis) -> list[str]:
    """The processes of the chain, those with the largest share of the latency first."""
    shares: dict[str, Time] = {}
    for hop in explanation.hops:
        shares[hop.process] = shares.get(hop.process, 0) + hop.wait + hop.run
    system = analysis.solution.context.system
    for process in ChainEvaluator(analysis.solution).processes(system.chains[explanation.chain.name]):
        shares.setdefault(process, 0)
    return sorted(shares, key=lambda name: -shares[name])


def _periodic(process: str, system: System) -> Periodic | None:
    """The only stimulus of a process, if it is periodic."""
    match [system.stimuli_by_name.get(name) for name in system.processes[process].stimuli]:
        case [Periodic() as stimulus]:
            return stimulus
    return None


def _periods(processes: Sequence[str], system: System, offered: Sequence[Time]) -> Iterator[ImprovingChange]:
    in_use = {each.period for name in system.processes if (each := _periodic(name, system)) is not None}
    messages = {each.name for each in system.network.transmissions}
    for name in processes:
        stimulus = _periodic(name, system)
        if stimulus is None or name in messages:
            continue  # messages come as often as somebody else sends them
        parts = {stimulus.period // divisor for divisor in _DIVISORS if stimulus.period % divisor == 0}
        for period in sorted(set(offered) or in_use | parts, reverse=True):
            if period < stimulus.period:
                yield _of_process(name, "period", time_text(stimulus.period), time_text(period))


def _priorities(processes: Sequence[str], analysis: Analysis) -> Iterator[ImprovingChange]:
    """A higher priority on its core: that of another process in exchange, or one above all others."""
    for name in processes:
        own = analysis.processes[name]
        if own.priority is None:
            continue
        others = [each for each in analysis.processes if each.processor == own.processor and each.is_isr == own.is_isr]
        above = sorted(
            (each for each in others if each.priority is not None and each.priority > own.priority),
            key=lambda each: (each.priority, each.name),
        )
        for each in above:
            exchanged = (Change(name, "priority", str(each.priority)), Change(each.name, "priority", str(own.priority)))
            yield ImprovingChange(text=f"exchange the priorities of {name} and {each.name}", changes=exchanged)
        if above:
            yield _of_process(name, "priority", str(own.priority), str((above[-1].priority or 0) + 1))


def _offsets(explanation: ChainExplanation, system: System) -> Iterator[ImprovingChange]:
    """Release a job of the worst case just when its input is there, if all releases are known."""
    if unknown_phases(system):
        return
    for hop in explanation.hops[1:]:
        stimulus = _periodic(hop.process, system)
        wait = sum(each.time for each in hop.wait_causes if each.kind is CauseKind.NEXT_JOB)
        if stimulus is not None and wait % stimulus.period:
            offset = (stimulus.offset - wait) % stimulus.period
            yield _of_process(hop.process, "offset", time_text(stimulus.offset), time_text(offset))


def _clocks(processes: Sequence[str], analysis: Analysis) -> Iterator[ImprovingChange]:
    wires = analysis.solution.context.system.network.wire_cores
    for core in dict.fromkeys(analysis.processes[name].processor for name in processes):
        if core in wires:
            continue  # their drivers also wait in ticks, which no other bit rate makes shorter
        frequency = analysis.processors[core].frequency if core is not None else None
        if core is not None and frequency is not None:
            yield _of_process(core, "frequency", frequency_text(frequency), frequency_text(2 * frequency))


def _cores(system: System) -> list[str]:
    """The cores of the controller: those that stand for wires or belong to others are not available."""
    wires = system.network.wire_cores
    return [name for name in system.cores if name not in wires]


def _of_description(source: DescriptionOrigin, cores: Sequence[str]) -> Iterator[ImprovingChange]:
    every = list(suggestions(source.keys, cores))
    for each in every:
        yield ImprovingChange(text=each.text, changes=(each.change,), is_stated=True)
        for other in every:
            if (other.change.key, each.change.key) in _LIMITING_EACH_OTHER:
                changes = (other.change, each.change)
                yield ImprovingChange(text=f"{other.text}, {each.text}", changes=changes, is_stated=True, count=2)


def _communication(explanation: ChainExplanation, present: Configuration) -> Iterator[ImprovingChange]:
    stated = present.settings.communication
    now = explanation.chain.communication if stated is None else str(stated).lower()
    before = now if now in map(str.lower, Communication) else "as modelled"
    for each in _NOT_LATER:
        if str(each).lower() != now:
            yield ImprovingChange(text=f"communication {before} -> {str(each).lower()}", communication=each)


def _of_process(name: str, key: str, before: str, after: str) -> ImprovingChange:
    return ImprovingChange(text=f"{key} of {name} {before} -> {after}", changes=(Change(name, key, compact(after)),))
