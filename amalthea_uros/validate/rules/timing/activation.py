"""When processes are activated."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.errors import UnknownError
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.perf.events import EventSet
from amalthea_uros.timing.activation.releases import response_time_limits
from amalthea_uros.timing.dataflow.chains import events_of
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.units import Time, time_text
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing
from amalthea_uros.validate.quantities import bounds
from amalthea_uros.validate.rule import SystemProblem, model_rule, system_rule
from amalthea_uros.validate.system_context import SystemContext
from amalthea_uros.validate.wording import joined, listed


@model_rule("TIM-PERIOD", am.Stimulus)
def _check_period(element: am.Stimulus, context: Context) -> Iterator[str]:
    match element:
        case am.PeriodicStimulus() | am.PeriodicSyntheticStimulus() | am.PeriodicBurstStimulus():
            if not (picoseconds(element.recurrence) or 0) > 0:
                yield f"stimulus {element.name!r} has no positive recurrence with a unit"
            if isinstance(element, am.PeriodicStimulus) and element.jitter is not None and None in bounds(element.jitter):
                yield f"the jitter of stimulus {element.name!r} has no lower or no upper bound"
        case am.RelativePeriodicStimulus():
            if not (bounds(element.next_occurrence)[0] or 0) > 0:
                yield f"stimulus {element.name!r} has no positive minimum distance with a unit"
        case am.ArrivalCurveStimulus():
            if not any(_limits(entry) for entry in element.entries):
                yield f"stimulus {element.name!r} has no positive lower time border with a unit for two or more occurrences"
        case am.VariableRateStimulus(scenario=None):
            if not (picoseconds(element.step) or 0) > 0 or not (bounds(element.occurrences_per_step)[1] or 0) > 0:
                yield f"the maximum number of occurrences per step of stimulus {element.name!r} is unknown"
        case am.CustomStimulus():
            why = f": {element.description}" if element.description else ""
            yield f"the activation pattern of custom stimulus {element.name!r} is unknown{why}"


def _limits(entry: am.ArrivalCurveEntry) -> bool:
    """Whether an entry defines a minimum time between occurrences."""
    return entry.effective("number_of_occurrences") > 1 and (picoseconds(entry.lower_time_border) or 0) > 0


@model_rule("TIM-STIMULUS", am.Process)
def _check_stimulus(element: am.Process, context: Context) -> Iterator[str]:
    if isinstance(element, am.Task | am.ISR) and not any(_occurs(stimulus, context) for stimulus in element.stimuli):
        if element.stimuli:
            yield f"{element.name!r} is never activated: nothing triggers {listed(element.stimuli)}"
        else:
            yield f"{element.name!r} is never activated: it has no stimulus"


def _occurs(stimulus: am.Stimulus, context: Context) -> bool:
    """Whether a stimulus comes from the environment, or is triggered by the model."""
    match stimulus:
        case am.InterProcessStimulus(unresolved=None):
            return stimulus in context.once(_triggered)
        case am.EventStimulus(unresolved=None):
            return bool(stimulus.triggering_events)
    return True


def _triggered(context: Context) -> set[am.Stimulus]:
    """The stimuli that a process triggers."""
    triggers = (trigger for trigger in context.all(am.InterProcessTrigger) if executing(trigger, context))
    return {trigger.stimulus for trigger in triggers if trigger.stimulus is not None}


@system_rule("TIM-ACTIVATION-LIMIT")
def _check_activation_limit(context: SystemContext) -> Iterator[SystemProblem]:
    system = context.system
    for task in system.software.tasks:
        for stimulus in (system.stimuli_by_name[name] for name in task.stimuli if name in system.stimuli_by_name):
            events = event_model_of(stimulus, system)
            count = events.eta_plus(1) if events is not None else 1
            if count > task.activation_limit:
                message = (
                    f"{stimulus.name!r} may activate {task.name!r} {count} times at once, "
                    f"but its activation limit is {task.activation_limit}"
                )
                yield SystemProblem(task, message)


@system_rule("TIM-DEADLINE")
def _check_deadline(context: SystemContext) -> Iterator[SystemProblem]:
    for name, deadline in _deadlines(context).items():
        process, rate = context.system.processes.get(name), context.rates.get(name)
        if process is not None and rate and deadline * rate > 1:
            message = (
                f"the deadline of {name!r} is {time_text(deadline)}, longer than the {time_text(1 / rate)} between activations"
            )
            yield SystemProblem(process, message)


def _deadlines(context: SystemContext) -> dict[str, Time]:
    """The shortest deadline of each process, by requirements and by its scheduler."""
    found = response_time_limits(context.system)
    for allocation in context.system.mapping.tasks:
        if allocation.deadline is not None:
            found[allocation.task] = min(allocation.deadline, found.get(allocation.task, allocation.deadline))
    return found


@system_rule("TIM-SEPARATE-CLOCKS")
def _check_separate_clocks(context: SystemContext) -> Iterator[SystemProblem]:
    for chain in context.system.events.chains:
        controllers = (_controller(event, context) for event in events_of(chain, context.system))
        found = sorted({controller for controller in controllers if controller is not None})
        if len(found) > 1:
            names = joined(map(repr, found))
            yield SystemProblem(chain, f"{chain.name!r} goes through {names}, which have no common clock")


def _controller(name: str, context: SystemContext) -> str | None:
    """The controller in which an event occurs; None if that may be several, or is unknown."""
    event = context.system.events_by_name.get(name)
    if event is None or isinstance(event, EventSet):
        return None
    try:
        processes = {occurrence.process.name for occurrence in context.dataflow.events.of(event)}
    except UnknownError:
        return None
    found = {context.controllers.get(core) for process in processes for core in context.cores.get(process, ())}
    return found.pop() if len(found) == 1 else None
