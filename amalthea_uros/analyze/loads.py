"""The load of cores, which overloads are certain, and what of it is ignored or lost."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from amalthea_uros._internal.graphs import reached
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.processes import ProcessorResult
from amalthea_uros.executors.semantics.loops import busy_threads
from amalthea_uros.perf.network import Purpose
from amalthea_uros.perf.software import Task
from amalthea_uros.perf.stimuli import RelativePeriodic
from amalthea_uros.timing.activation.load import CoreLoad
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.job_paths import JobDemand
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.demand.overheads import COUNTED
from amalthea_uros.timing.jobs.executed import depends_on_messages, states_mean
from amalthea_uros.timing.response import Response
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, ScheduledProcess
from amalthea_uros.units import percent_text

LONG_RUN = "load in the long run"


def processor_results(solution: Solution) -> Iterator[ProcessorResult]:
    """The load of each core; unknown if the demand or activation of a process that can run on it is unknown."""
    context = solution.context
    known = {
        core
        for core in context.system.cores
        if solution.is_closed(core) and all(solution.is_known(item.name) for item in context.on_core(core))
    }
    certain: Mapping[str, Fraction] = {}
    if len(known) < len(context.system.cores):
        certain = solution.certain_loads_of(allocated_cores(context.system))
    for core in context.system.cores:
        best, mean, worst = _loads(core, solution) if core in known else (None, None, _of_busy(core, solution))
        yield ProcessorResult(
            name=core,
            frequency=context.demand_model.frequency(core),
            best=best,
            mean=mean,
            worst=worst,
            at_least=certain.get(core, Fraction(0)) if worst is None else _certain_load(context.on_core(core), core, solution),
        )


def _of_busy(core: str, solution: Solution) -> Fraction | None:
    """The worst-case load of a core on which nothing is unknown but threads that never sleep: all that others leave of it."""
    here = [item.name for item in solution.context.on_core(core)]
    unknown = {name for name in here if not solution.is_known(name)}
    if not unknown or unknown - busy_threads(solution.context.system).keys() or not solution.is_closed(core):
        return None
    return max(Fraction(1), _load([name for name in here if name not in unknown], core, solution).worst)


def _certain_overload(name: str, solution: Solution) -> Response | None:
    """The response time of a process that could not be analysed, but whose priority is overloaded for certain.

    The processes of this priority or higher need more than the whole core in the long run (Liu, Layland 1973). That holds whatever
    their response times are if only they trigger each other: what a process of lower priority triggers comes as late as that does.
    If one of them falls behind and triggers fewer jobs, then all that is below it falls behind, too.
    """
    context = solution.context
    item = context.scheduled.get(name)
    if item is None or not solution.is_known(name) or item.equal_priority is not EqualPriority.FIFO:
        return None
    if solution.certain_loads.get(item.core, 0) <= 1:
        return None  # a part of the processes of a core needs no more than all of them
    level = [other for other in context.on_core(item.core) if other.rank >= item.rank]
    names = {other.name for other in level}
    causing = reached(names, context.activations.triggering)
    if any(other.server is not None for other in level) or not names.issuperset(causing):
        return None
    load = solution.certain_loads_of(dict.fromkeys(names, frozenset((item.core,)))).get(item.core, Fraction(0))
    if load <= 1:
        return None
    reason = f"overload: tasks at this priority or higher need at least {percent_text(load, 1)} % of the core"
    best = solution.bcet(name)
    return Response(worst=None, best=best, method=LONG_RUN, source="Liu, Layland 1973", reason=reason, is_overload=True)


def without_doubtful_overload(name: str, solution: Solution) -> Response | None:
    """The response time of a process; without bound, but not overloaded for certain, if what overloads it may exclude each other."""
    found, context = solution.responses.get(name), solution.context
    if found is None:
        return _certain_overload(name, solution)
    if not found.is_overload or name not in context.scheduled:
        return found
    item = context.scheduled[name]
    here = [other for other in context.on_core(item.core) if other.rank >= item.rank and solution.is_known(other.name)]
    rates = (_demand(other.name, context).mean_worst * solution.event_models[other.name].rate for other in here)
    together = _load((other.name for other in here), item.core, solution)
    are_suppressed = any(solution.event_models[other.name].can_be_suppressed for other in here)
    if together.certain * context.time_base(name) == sum(rates, Fraction(0)) and not are_suppressed:
        return found
    if _certain_load(here, item.core, solution) > 1:
        return replace(
            found, reason=f"overload: tasks at this priority or higher need {percent_text(together.worst, 1)} % of the core"
        )
    if together.worst <= 1:
        return replace(found, is_overload=False, reason=f"{found.reason}, if what excludes each other is added up")
    return replace(found, is_overload=False, reason=f"{found.reason}, unless modes exclude a part of it")


def share_of_core(name: str, solution: Solution) -> Fraction | None:
    """The worst-case share of its core that a process needs in the long run; None if its demand or its activations are unknown."""
    context = solution.context
    if name not in context.demands:
        return None
    events = solution.event_models.get(name) or context.activations_at_once(name)
    return None if events is None else _demand(name, context).mean_worst * events.rate / context.time_base(name)


def _loads(core: str, solution: Solution) -> tuple[Fraction, Fraction | None, Fraction]:
    """The best, mean and worst load of a core; no mean if conditions or messages decide on jobs, or times have none."""
    context = solution.context
    here = context.on_core(core)
    names = [item.name for item in here]
    load, regular = _load(names, core, solution), _never_suppressed(names, solution)
    if regular != names:
        return _load(regular, core, solution).best, None, load.worst
    causing = reached(names, context.activations.triggering)
    if solution.sent_again.keys() & causing:
        # How much is lost at least, and on average, is not known.
        return _load(names, core, solution, solution.rates_without_losses).best, None, load.worst
    polling = any(item.name in context.waiting and context.waiting[item.name].polls for item in here)
    has_mean = (
        not polling
        and all(states_mean(item.process, context.system) for item in here)
        and not any(depends_on_messages(name, context.system) for name in causing)
    )
    return load.best, load.mean if has_mean else None, load.worst


def _load(names: Iterable[str], core: str, solution: Solution, rates: Mapping[str, Fraction] | None = None) -> JobDemand:
    """The load of a core by some of its processes.

    Parameters
    ----------
    rates : of activations that no process triggers; None for those of the solution
    """
    context = solution.context
    demands = {name: _demand(name, context) for name in names}
    # What triggers the processes of a core need not be on it.
    model = context.executing if context.waiting else context.demand_model
    return CoreLoad(core, demands, context.activations, model).load(solution.external_rates if rates is None else rates)


def _demand(name: str, context: TimingContext) -> MultiframeDemand:
    """The demand of a job of a process with what its scheduler needs to decide when it is activated, and with what it polls."""
    waiting, decision = context.waiting.get(name), context.decisions.get(name)
    own = context.demands[name] if waiting is None or waiting.polls else waiting.demand
    return own if decision is None else MultiframeDemand((*own.frames, *decision.frames))


def _certain_load(items: Iterable[ScheduledProcess], core: str, solution: Solution) -> Fraction:
    """The worst load of processes of a core, without what modes may exclude for ever, and what rounds of executors need.

    Nor does it contain activations that conditions may suppress.
    """
    names = (item.name for item in items if item.name not in solution.context.with_uncertain_activations)
    return _load(_never_suppressed(names, solution), core, solution).certain


def _never_suppressed(names: Iterable[str], solution: Solution) -> list[str]:
    """The processes of which no condition can suppress activations."""
    return [name for name in names if not solution.event_models[name].can_be_suppressed]


def note_ignored(solution: Solution) -> None:
    """Report what the analysis does not take into account."""
    _note_regular_frames(solution)
    system, notes = solution.context.system, solution.context.notes
    overheads = {overhead.name: overhead for overhead in system.os.overheads}
    for operating_system in system.os.systems:
        overhead = overheads.get(operating_system.overhead or "")
        for service, _ in overhead.services if overhead else ():
            if service not in COUNTED:
                message = f"the overhead of {service!r} in {operating_system.name!r} is ignored"
                notes.warning("ANA006", message, overhead)
    for name, response in solution.responses.items():
        process = solution.context.scheduled[name].process
        if isinstance(process, Task) and response.worst is not None and name in solution.losing:
            jobs, limit = solution.event_models[name].eta_plus(response.worst), process.activation_limit
            message = (
                f"{name!r} can have {jobs} pending activations, more than its activation limit {limit}; the others are lost"
            )
            notes.warning("ANA007", message, process)


def _note_regular_frames(solution: Solution) -> None:
    """Report which foreign frames are assumed to be on time; a DBC file states no jitter."""
    system = solution.context.system
    stimuli = {stimulus.name: stimulus for stimulus in system.stimuli.stimuli}
    regular = [
        each.name
        for each in system.network.transmissions
        if each.purpose is Purpose.FOREIGN
        and any(isinstance(stimuli.get(name), RelativePeriodic) for name in system.processes[each.name].stimuli)
    ]
    if regular:
        names = ", ".join(regular)
        solution.context.notes.assume(f"foreign frames without a stated jitter never come earlier than their period: {names}")
