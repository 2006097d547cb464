"""The periods of the tasks to which event-driven callbacks are mapped.

The rules are those of S. R. Bappanadu, "Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle Control Unit",
University of Stuttgart, 2022, section 4.3: the task of a callback runs at least as often as messages arrive, so that none is lost; its
period is longer than the execution time, so that a job ends within its period; and the executor runs at least as often as the fastest
of these tasks. Of the periods that satisfy the rules, the longest one costs least.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.demand import DemandConverter

_SET_BY_USER = "set in app.yaml"


@dataclass(frozen=True, slots=True, kw_only=True)
class PeriodChoice:
    """The period of a task, and the reason for it.

    Attributes
    ----------
    executor : that serves the callback of the task, or the task itself if it is an executor
    """

    task: str
    executor: str
    period: Time
    reason: str


@dataclass(frozen=True, slots=True)
class PeriodCandidates:
    """The task periods to choose from.

    Attributes
    ----------
    periods : longest first; empty if any period is allowed
    executor_period : if it is set; no task may have a shorter period
    """

    periods: tuple[Time, ...]
    executor_period: Time | None

    def for_callback(self, callback: Callback) -> Sequence[Time]:
        """The periods to try for a callback, longest first."""
        return self.periods or (callback.min_interval,)


def period_candidates(middleware: Middleware, executor: ExecutorSection) -> PeriodCandidates:
    """The task periods that the middleware allows for callbacks that an executor serves."""
    return PeriodCandidates(tuple(sorted(set(middleware.task_periods), reverse=True)), executor.period)


def violated_rule(callback: Callback, period: Time, wcet: Time, candidates: PeriodCandidates) -> str | None:
    """What is wrong with a task period, to be read after "it is"; None if it satisfies all rules."""
    is_timer = callback.kind is HandleKind.TIMER
    what = "timer period" if is_timer else "minimum message interval" if callback.jitter else "message interval"
    due = f"{what} of {time_text(callback.min_interval)}"
    if period > callback.min_interval:
        return f"longer than the {due}"
    if period <= wcet:
        return f"not longer than the execution time of {time_text(wcet)}"
    if is_timer and callback.nominal_interval % period:
        return f"not a divisor of the {due}"
    if candidates.executor_period is not None and period < candidates.executor_period:
        return f"shorter than the executor period of {time_text(candidates.executor_period)}"
    return None


def choose_task_period(
    callback: Callback, candidates: PeriodCandidates, converter: DemandConverter, notes: Notes
) -> PeriodChoice | None:
    """The period of a callback's own task; None, with a finding, if no candidate satisfies the rules."""
    wcet = converter.wcet(callback.section.execution_time)
    if callback.section.task_period is not None:
        return _check_task_period(callback, callback.section.task_period, wcet, candidates, notes)
    violations: dict[str, list[str]] = {}
    for period in candidates.for_callback(callback):
        violation = violated_rule(callback, period, wcet, candidates)
        if violation is None:
            reason = _reason(callback, candidates) + _when_it_runs(callback, period)
            return PeriodChoice(task=callback.name, executor=callback.executor, period=period, reason=reason)
        violations.setdefault(violation, []).append(time_text(period))
    reasons = "; ".join(f"{', '.join(periods)} ({violation})" for violation, periods in violations.items())
    message = f"no available task period fits {callback.name!r}: {reasons}"
    notes.error("UR101", message, callback.origin, "Add a period that fits to 'task_periods', or change the callback.")
    return None


def _check_task_period(
    callback: Callback, period: Time, wcet: Time, candidates: PeriodCandidates, notes: Notes
) -> PeriodChoice:
    """The period that is set for a callback's own task, with findings about the rules that it violates."""
    location = callback.section.location("task_period")
    subject = f"the task period {time_text(period)} of {callback.name!r}"
    violation = violated_rule(callback, period, wcet, candidates)
    if candidates.periods and period not in candidates.periods:
        available = ", ".join(map(time_text, reversed(candidates.periods)))
        advice = f"Use one of {available}; or add {time_text(period)} to 'task_periods'."
        notes.error("UR102", f"{subject} is not one of 'task_periods'", location, advice)
    elif violation is not None:
        advice = "Set another period, or remove 'task_period' to have one chosen."
        notes.error("UR102", f"{subject} is {violation}", location, advice)
    return PeriodChoice(
        task=callback.name, executor=callback.executor, period=period, reason=_SET_BY_USER + _when_it_runs(callback, period)
    )


def _when_it_runs(callback: Callback, period: Time) -> str:
    """In which activations of its task a callback runs, if that is activated more often than the callback is due."""
    every = callback.nominal_interval // period
    if every < 2:
        return ""
    return f"; runs in one of {every} activations" if callback.runs_when_due else "; runs in every activation"


def _reason(callback: Callback, candidates: PeriodCandidates) -> str:
    source = "the timer period of" if callback.kind is HandleKind.TIMER else "messages every"
    reason = f"keeps up with {source} {time_text(callback.nominal_interval)}"
    return f"longest available period that {reason}" if candidates.periods else reason


def check_callbacks_in_executor(callbacks: Iterable[Callback], converter: DemandConverter, notes: Notes) -> None:
    """Report callbacks in the executor whose execution time is not shorter than their interval."""
    for callback in callbacks:
        wcet = converter.wcet(callback.section.execution_time)
        if wcet >= callback.nominal_interval:
            message = f"{callback.name!r} is due every {time_text(callback.nominal_interval)}, but executes for up to {time_text(wcet)}"
            location = callback.section.location("execution_time")
            notes.error("UR107", message, location, "Reduce its execution time, or run it less often.")


def choose_executor_period(
    executor: ExecutorSection,
    candidates: PeriodCandidates,
    tasks: Iterable[PeriodChoice],
    inside: Iterable[Callback],
    notes: Notes,
) -> PeriodChoice | None:
    """The period of the executor; it may not exceed the period of any task that it notifies or callback that it runs.

    Parameters
    ----------
    tasks : the callbacks' own tasks
    inside : the callbacks that run in the executor
    """
    limits = [(choice.period, f"the task of {choice.task}") for choice in tasks]
    limits += [(callback.nominal_interval, callback.name) for callback in inside]
    shortest, fastest = min(limits)
    if executor.period is not None:
        if executor.period > shortest:
            message = f"the executor period {time_text(executor.period)} is longer than the {time_text(shortest)} of {fastest}"
            advice = f"Set a period of {time_text(shortest)} or less."
            notes.error("UR103", message, executor.location("period"), advice)
        return PeriodChoice(task=executor.name, executor=executor.name, period=executor.period, reason=_SET_BY_USER)
    period = next((period for period in candidates.periods or (shortest,) if period <= shortest), None)
    if period is None:
        message = f"no available task period is short enough for the executor: {fastest} needs {time_text(shortest)} or less"
        advice = f"Add a period of {time_text(shortest)} or less to 'task_periods'."
        notes.error("UR103", message, executor.location(), advice)
        return None
    return PeriodChoice(task=executor.name, executor=executor.name, period=period, reason=f"keeps up with {fastest}")
