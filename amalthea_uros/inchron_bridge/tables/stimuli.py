"""Stimuli as generators and connections, and the activations that they cause."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import keep_whole
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.tables.activities import next_entry
from amalthea_uros.inchron_bridge.tables.conditions import build_condition
from amalthea_uros.inchron_bridge.tables.distributions import whole_part
from amalthea_uros.perf import distributions
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.activities import Trigger, walk
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.units import Time

SCENARIO = "DefaultScenario"

#: The key of a stimulus of another class than the project has, in the comment of what stands for it.
STIMULUS = "stimulus"

GENERATOR, LIST, INDUCED = (
    f"stimulation.{kind}" for kind in ("RandomStimuliGenerator", "ListBasedGenerator", "InducedListBasedGenerator")
)
DRIVER = "PeriodicDriver"


def build_stimuli(context: Exporting) -> None:
    """Make the generators and connections, without what they activate."""
    scenario = ProjectObject("stimulation.StimulationScenario", name=SCENARIO)
    context.model.add("scenarios", scenario)
    context.model["defaultScenario"] = scenario
    triggered = context.system.activity_classes and {
        activity.stimulus for body in context.system.software.bodies for activity in walk(body) if isinstance(activity, Trigger)
    }
    for stimulus in context.system.stimuli.stimuli:
        made = _stimulus(stimulus, context, scenario, triggered or set())
        context.keep(made, stimulus, "assignments")
        context.register("Stimulus", stimulus.name, made)
    for clock in context.system.stimuli.clocks:
        context.lost(clock, type(clock).__name__, "it is left out")


def _stimulus(stimulus: perf.Stimulus, context: Exporting, scenario: ProjectObject, triggered: set[str]) -> ProjectObject:
    name = stimulus.name
    match stimulus:
        case perf.InterProcess() if name in triggered:
            made = ProjectObject("ActivationConnection", name=name)
            if stimulus.counter is not None:
                keep_whole(made, "counter", stimulus.counter)
            context.model.add("connections", context.register("ActivationConnection", name, made))
            return made
        case perf.Single(time=time):
            made = _generator(LIST, name, context, entries=[context.time(time, name)])
        case perf.Synthetic():
            driver = _random(f"{name}{DRIVER}", stimulus.period, context, name, offset=stimulus.offset)
            scenario.add("generators", driver)
            times = [context.time(time, name) for time in stimulus.times]
            made = _generator(INDUCED, name, context, entries=times, sourceGenerator=driver)
        case perf.Periodic():
            made = _periodic(stimulus, context)
        case perf.RelativePeriodic():
            made = _relative(stimulus, context)
        case perf.Burst():
            pattern = ProjectObject(
                "stimulation.BurstPattern",
                maximumOccurrences=_most(stimulus),
                minimumInterArrivalTime=context.time(stimulus.distance, name),
                patternLength=context.time(stimulus.length, name),
            )
            made = _random(name, stimulus.period, context, name, offset=stimulus.offset)
            made["burstPatternSettings"] = pattern
            if not stimulus.count:
                context.changed(stimulus, "a burst without a number of activations", "with as many as fit into its length")
                keep_whole(made, STIMULUS, stimulus)
        case _:
            made = _other(stimulus, context)
    scenario.add("generators", made)
    return made


def _most(burst: perf.Burst) -> int:
    """How often a burst occurs at most; a number of 0 stands for as often as fits."""
    return burst.count or (burst.length // burst.distance + 1 if burst.distance > 0 else 0)


def _generator(kind: str, name: str, context: Exporting, **features: Any) -> ProjectObject:
    return ProjectObject(kind, name=name, clock=context.find("IdealClock", ""), **features)


def _random(
    name: str,
    period: int,
    context: Exporting,
    holder: str,
    *,
    offset: int | None = None,
    variation: ProjectObject | None = None,
    distance: int | None = None,
    relative: bool = False,
) -> ProjectObject:
    """A generator; quantities are spelled as those of the holder."""
    starts: dict[str, Any] = {}
    if offset is not None and (offset or (holder, 0) in context.units):
        starts = {end: context.time(offset, holder) for end in ("min", "max")}
    return _generator(
        GENERATOR,
        name,
        context,
        period=context.time(period, holder),
        relative=relative,
        startOffsetVariation=ProjectObject("stimulation.StartOffsetVariation", **starts),
        minimumInterArrivalTime=context.time(distance, holder),
        variation=variation,
    )


def _variation(kind: str, context: Exporting, name: str, **times: int) -> ProjectObject:
    return ProjectObject("PeriodVariation", type=kind, **{each: context.time(time, name) for each, time in times.items()})


def _periodic(stimulus: perf.Periodic, context: Exporting) -> ProjectObject:
    name, jitter, variation = stimulus.name, stimulus.jitter, None
    lost = False
    match jitter:
        case None:
            pass
        case distributions.Gauss(deviation=deviation, lower=lower, upper=upper) as gauss:
            bounds = {"min": lower or 0, "max": upper or 0}
            variation = _variation("Normal", context, name, sigma=whole_part(deviation), **bounds)
            lost = bool(gauss.mean) or (lower is None) != (upper is None) or whole_part(deviation) != deviation
        case _:
            low, high = lowest(jitter), highest(jitter)
            lost = not isinstance(jitter, distributions.Uniform)
            variation = _variation("Uniform", context, name, min=low or 0, max=high or 0)
    made = _random(
        name, stimulus.period, context, name, offset=stimulus.offset, variation=variation, distance=stimulus.min_distance
    )
    if lost:
        context.changed(stimulus, "a jitter of another distribution", "uniformly distributed within its bounds, or around 0")
        keep_whole(made, STIMULUS, stimulus)
    return made


def _relative(stimulus: perf.RelativePeriodic, context: Exporting) -> ProjectObject:
    name, distance = stimulus.name, stimulus.distance
    is_exact = True
    match distance:
        case distributions.Gauss(mean=mean, deviation=deviation, lower=lower, upper=upper):
            period = whole_part(mean)
            bounds = {} if lower is None or upper is None else {"min": lower - period, "max": upper - period}
            variation = _variation("Normal", context, name, sigma=whole_part(deviation), **bounds)
            is_exact = (period, whole_part(deviation)) == (mean, deviation) and (lower is None) == (upper is None)
        case _:
            period = lowest(distance) or 0
            width = (highest(distance) or 0) - period
            variation = _variation("Uniform", context, name, max=width)
            is_exact = isinstance(distance, distributions.Uniform)
    made = _random(name, period, context, name, offset=stimulus.offset, variation=variation, relative=True)
    context.keep(made, stimulus, "has_maximum")
    if not is_exact:
        context.changed(
            stimulus, "a distance of another distribution", "uniformly distributed within its bounds, or around its mean"
        )
        keep_whole(made, STIMULUS, stimulus)
    return made


def _other(stimulus: perf.Stimulus, context: Exporting) -> ProjectObject:
    """A stimulus that a project cannot have, as the one that comes closest, or nothing if that is unknown."""
    closest, what, how = substitute(stimulus, context.iterations)
    match closest:
        case perf.RelativePeriodic():
            made = _relative(closest, context)
        case perf.Periodic():
            made = _periodic(closest, context)
        case _:
            made = _generator(LIST, stimulus.name, context)
            context.lost(stimulus, what, "nothing is activated there; only amuros reads it, in a comment")
    if closest is not None:
        context.changed(stimulus, what, how)
    keep_whole(made, STIMULUS, stimulus)
    return made


def substitute(stimulus: perf.Stimulus, iterations: Mapping[str, tuple[Time, Time]]) -> tuple[perf.Stimulus | None, str, str]:
    """The stimulus that comes closest to one that INCHRON has not, None if it is unknown; and the words for the two."""
    kind, known = type(stimulus).__name__, {"name": stimulus.name, "condition": stimulus.condition, "origin": stimulus.origin}
    if stimulus.name in iterations:
        shortest, longest = iterations[stimulus.name]
        distance = distributions.Uniform(lower=shortest, upper=longest)
        how = "as activations between the shortest and the longest iteration"
        return perf.RelativePeriodic(**known, distance=distance), "the iterations of an executor", how  # type: ignore[arg-type]
    if (rate := _highest_rate(stimulus)) is not None:
        closest = perf.Periodic(**known, period=rate[0], min_distance=rate[1])  # type: ignore[arg-type]
        return closest, kind, "as activations at the highest rate that lasts"
    return None, kind, ""


def _highest_rate(stimulus: perf.Stimulus) -> tuple[int, int | None] | None:
    """The least period that lasts, and the least distance; None if they are unknown."""
    match stimulus:
        case perf.ArrivalCurve(points=points):
            periods = [point.lower // (point.occurrences - 1) for point in points if point.occurrences > 1 and point.lower]
            shortest = [point.lower for point in points if point.occurrences == 2]
            return (max(periods), shortest[0] if shortest else None) if periods and max(periods) > 0 else None
        case perf.VariableRate(step=step, rate=rate, scenario=None) if (most := highest(rate)) and most > 0:
            period = whole_part(step / most)
            return (period, None) if period else None
    return None


def add_activations(process: Any, context: Exporting) -> None:
    """Let the stimuli of a process activate it."""
    for name in process.stimuli:
        holder = context.find("Stimulus", name)
        stimulus = context.system.stimuli_by_name.get(name)
        if holder is None or stimulus is None:
            context.need("Stimulus", name, process.name)
            continue
        feature = _feature(holder)
        if feature not in holder.values:
            holder[feature] = ProjectObject("CallGraph")
        item = ProjectObject(
            "ActivateProcess", name=f"Activate{process.name}", target=context.need("Process", process.name, name)
        )
        counter = getattr(stimulus, "counter", None)
        if counter is not None:
            item["period"], item["offset"] = max(1, counter.prescaler), counter.offset
        _sequence(holder[feature], stimulus, context).add("calls", item)


def _sequence(graph: ProjectObject, stimulus: perf.Stimulus, context: Exporting) -> ProjectObject:
    """The sequence of the activations of a stimulus; within a branch if it has a condition."""
    for entry in graph["graphEntries"]:
        result: ProjectObject = entry if entry.kind == "CallSequence" else entry["entries"][0]["graphEntries"][0]
        return result
    if stimulus.condition is None:
        return graph.add("graphEntries", next_entry("CallSequence", context))
    switch = next_entry("Switch", context)
    switch["evaluateConditionsOnEntry"] = True
    entry = switch.add("entries", ProjectObject("SwitchEntry", name="SwitchEntry_0"))
    graph.add("graphEntries", switch)
    return entry.add("graphEntries", next_entry("CallSequence", context))


def add_conditions(context: Exporting) -> None:
    """Make the conditions of stimuli, which are numbered after those of the software, also of stimuli that activate nothing."""
    for stimulus in context.system.stimuli.stimuli:
        if stimulus.condition is not None:
            condition = build_condition(stimulus.condition, context, stimulus)
            holder = context.need("Stimulus", stimulus.name, stimulus.name)
            for switch in holder[_feature(holder)]["graphEntries"] if _feature(holder) in holder.values else ():
                switch["entries"][0]["condition"] = condition


def _feature(holder: ProjectObject) -> str:
    """The feature of a generator or connection with its activations."""
    return "callGraph" if holder.kind == "ActivationConnection" else "targets"
