"""Event-driven callbacks mapped to periodic tasks.

The rules are those of S. R. Bappanadu, "Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle Control Unit",
University of Stuttgart, 2022, section 4.3: the task of a callback runs at least as often as messages come, so that none is lost; its
period is greater than the execution time, so that a job ends within its period; and the executor runs at least as often as the
fastest of these tasks. Among the periods that satisfy the rules the longest one costs least.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from amalthea_uros.spec.middleware import Executor, Middleware
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.callbacks import Callback, Kind
from amalthea_uros.uros.demand import Profile
from amalthea_uros.uros.notes import Notes


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """The period of a task, and why it is that one."""

    task: str
    period: Time
    reason: str


@dataclass(frozen=True, slots=True)
class Offer:
    """The task periods on offer.

    Attributes
    ----------
    periods : longest first; empty: every period
    fastest : period of the executor, if the author states it; no task may be faster
    """

    periods: tuple[Time, ...]
    fastest: Time | None

    def candidates(self, callback: Callback) -> Sequence[Time]:
        """Periods to try for a callback, longest first."""
        return self.periods or (callback.interval,)


def offer_of(middleware: Middleware) -> Offer:
    """What the middleware offers."""
    return Offer(tuple(sorted(set(middleware.task_periods), reverse=True)), middleware.executor.period)


def objection(callback: Callback, period: Time, execution_time: Time, offer: Offer) -> str | None:
    """Why a callback cannot run in a task of a period; None if it can."""
    if period > callback.interval:
        what = "the timer expires" if callback.kind is Kind.TIMER else "a message comes"
        return f"{what} every {time_text(callback.interval)}"
    if period <= execution_time:
        return f"it executes for up to {time_text(execution_time)}"
    if callback.kind is Kind.TIMER and callback.interval % period:
        return f"it does not divide the timer's {time_text(callback.interval)}"
    if offer.fastest is not None and period < offer.fastest:
        return f"the executor runs every {time_text(offer.fastest)} only"
    return None


def choose(callback: Callback, offer: Offer, profile: Profile, notes: Notes) -> Choice | None:
    """The period of a callback's own task; None, with a note, if there is none."""
    execution_time = profile.longest(callback.section.execution_time)
    if callback.section.task_period is not None:
        return _check(callback, callback.section.task_period, execution_time, offer, notes)
    candidates = offer.candidates(callback)
    for period in candidates:
        if objection(callback, period, execution_time, offer) is None:
            return Choice(task=callback.name, period=period, reason=_reason(callback, period, offer))
    tried = "; ".join(f"not {time_text(p)}: {objection(callback, p, execution_time, offer)}" for p in candidates)
    message = f"no task period on offer fits {callback.name!r}: {tried}"
    notes.error("UR101", message, callback.origin, "Offer another one in 'task_periods', or change the callback.")
    return None


def _check(callback: Callback, period: Time, execution_time: Time, offer: Offer, notes: Notes) -> Choice:
    """The period that the author chose, with notes on what speaks against it."""
    place = callback.section.location("task_period")
    reason = objection(callback, period, execution_time, offer)
    if offer.periods and period not in offer.periods:
        on_offer = ", ".join(map(time_text, reversed(offer.periods)))
        notes.error("UR102", f"the task period {time_text(period)} is not on offer", place, f"On offer are {on_offer}.")
    elif reason is not None:
        notes.error("UR102", f"{callback.name!r} cannot run in a task of {time_text(period)}: {reason}", place)
    return Choice(task=callback.name, period=period, reason="chosen by the author")


def _reason(callback: Callback, period: Time, offer: Offer) -> str:
    what = "timer" if callback.kind is Kind.TIMER else "messages"
    every = f"{what} every {time_text(callback.interval)}"
    return f"{every}, longest period on offer that fits" if offer.periods else every


def check_inside(callbacks: Iterable[Callback], profile: Profile, notes: Notes) -> None:
    """Note callbacks inside the executor that take as long as the time until they are due again."""
    for callback in callbacks:
        execution_time = profile.longest(callback.section.execution_time)
        if execution_time >= callback.interval:
            due = f"is due every {time_text(callback.interval)}"
            message = f"{callback.name!r} {due}, but executes for up to {time_text(execution_time)}"
            place = callback.section.location("execution_time")
            notes.error("UR107", message, place, "Shorten it, or let it be due less often.")


def choose_executor(
    executor: Executor, offer: Offer, own_tasks: Iterable[Choice], inside: Iterable[Callback], notes: Notes
) -> Choice | None:
    """The period of the executor: no task that gets work from it may be faster."""
    limits = [(choice.period, f"the task of {choice.task}") for choice in own_tasks]
    limits += [(callback.interval, callback.name) for callback in inside]
    least, who = min(limits)
    if executor.period is not None:
        if executor.period > least:
            message = f"the executor runs every {time_text(executor.period)}, slower than {who} with {time_text(least)}"
            notes.error("UR103", message, executor.location("period"), f"Give it a period of {time_text(least)} or less.")
        return Choice(task=executor.name, period=executor.period, reason="chosen by the author")
    period = next((period for period in offer.periods or (least,) if period <= least), None)
    if period is None:
        message = f"no task period on offer is short enough for the executor: {who} needs {time_text(least)} or less"
        notes.error("UR103", message, executor.location(), "Offer a shorter one in 'task_periods'.")
        return None
    return Choice(task=executor.name, period=period, reason=f"as fast as {who}")
