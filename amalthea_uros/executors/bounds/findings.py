"""What is worth knowing of executors that spin in loops besides numbers, and what these numbers are based on."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.executors.semantics.loops import busy_polls, longest_wait, min_pace, sleep_of
from amalthea_uros.executors.semantics.readiness import (
    can_defer,
    certain_rate,
    has_backlog,
    messages,
    other_threads,
    shares_session,
    timers,
)
from amalthea_uros.executors.semantics.suspension import SESSION_ASSUMPTION
from amalthea_uros.perf.executors import Executor, HandleKind, LoopKind
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.units import SECOND, Rounding, Time, rounded_time_text, time_text

#: A timer is called late if the sleep of the loop is more than this part of its period.
LATE = Fraction(1, 10)
#: The capacity of a loop is worth knowing if messages use more than this part of it.
NEAR_CAPACITY = Fraction(1, 2)


def note_executors(results: Iterable[ExecutorResult], solved: SolvedSystem) -> None:
    """Report what goes wrong in executors, and the assumptions."""
    notes = solved.context.notes
    for executor, result in zip(solved.context.system.executors, results, strict=True):
        _assume(executor, solved.context.system, notes)
        _note_loop(executor, solved.context.system, result, notes)
        _note_waiting(executor, solved.context.system, notes)
        for handle in result.handles:
            _note_handle(handle, executor, notes)


def _assume(executor: Executor, system: System, notes: AnalysisNotes) -> None:
    notes.assume("executors: the wait set is prepared before the first spin, which allocates memory and takes longer otherwise")
    notes.assume(
        "executors: the buffers of the driver and of the agent have room for all messages that wait; no call returns an error"
    )
    # The sleeps of `spin_some` are counted in ticks where the operating system states how; nothing else is.
    on_time = "waits" if executor.loop.sleep_early else "waits and sleeps"
    notes.assume(f"executors: {on_time} end on time, whatever the ticks of the operating system are")
    if executor.loop.kind is LoopKind.PERIODIC:
        notes.assume("executors: the real-time clock, by which spin_period sleeps, is not set while it spins")
    if has_backlog(executor, system):
        notes.assume("executors: stored messages have different time stamps; with equal ones, they come out in reverse order")
    if shares_session(executor, system.executors):
        notes.assume(f"executors: {SESSION_ASSUMPTION}")


def _note_loop(executor: Executor, system: System, result: ExecutorResult, notes: AnalysisNotes) -> None:
    growing = next((handle for handle in result.handles if handle.response.is_overload), None)
    if growing is not None:
        age = "" if has_backlog(executor, system) else _age_after(60 * SECOND, certain_rate(executor, system), result)
        why = growing.response.reason.removeprefix("overload: ").removesuffix(", so that messages wait longer and longer")
        message = f"messages wait longer and longer in {executor.name!r}: {why}{age}"
        notes.error("EXE012", message, executor)
    elif executor.waiting.messages_per_wait == 1 and messages(executor) and min_pace(executor):
        most, arriving = Fraction(1, min_pace(executor)), certain_rate(executor, system)
        if arriving > most * NEAR_CAPACITY:
            message = (
                f"{executor.name!r} takes at most one message per iteration, so at most {float(most * SECOND):.4g} messages/s "
                f"of all topics; {float(arriving * SECOND):.4g} arrive"
            )
            notes.warning("EXE013", message, executor)
    period = executor.loop.period
    if period is not None and (result.round.most is None or longest_wait(executor) + result.round.most > period):
        longest = "an unknown time" if result.loop.most is None else rounded_time_text(result.loop.most, Rounding.UP)
        message = (
            f"an iteration of {executor.name!r} can take {longest} with its wait, more than the period of {time_text(period)}; "
            "then iterations follow each other without a sleep until the loop has caught up"
        )
        notes.warning("EXE020", message, executor)


def _age_after(time: Time, arriving: Fraction, result: ExecutorResult) -> str:
    """How old the messages are that are served after a time: the n-th arrives after n intervals, and is served after n iterations."""
    served = max(result.loop.least, 1)
    age = time - Fraction(time) / (served * arriving)
    return f"; after {time_text(time)} they are at least {rounded_time_text(age, Rounding.DOWN)} old" if age > 0 else ""


def _note_waiting(executor: Executor, system: System, notes: AnalysisNotes) -> None:
    others = system.executors
    waiting, wait = executor.waiting, time_text(longest_wait(executor))
    guards = [handle.name for handle in executor.handles if handle.kind is HandleKind.GUARD_CONDITION]
    if guards and not waiting.guard_conditions_end_wait and longest_wait(executor):
        names = ", ".join(map(repr, guards))
        message = f"{names} does not wake {executor.name!r}: a trigger is seen after the wait, which lasts up to {wait}"
        notes.warning("EXE018", message, executor)
    # Where something that is kept back ends each wait, no wait is long while a message is stored.
    is_awaited = messages(executor) and longest_wait(executor) and not busy_polls(executor)
    if is_awaited and has_backlog(executor, system) and not waiting.stored_data_ends_wait:
        message = f"a message for {executor.name!r} that is stored already does not end its wait, which lasts up to {wait}"
        notes.warning("EXE017", message, executor)
    if can_defer(executor) and timers(executor):
        waited_for = frozenset[str]().union(*executor.trigger.sets)
        kept = [timer.name for timer in timers(executor) if frozenset((timer.name,)) not in executor.trigger.sets]
        if kept and (waited_for - {*kept} or not executor.trigger.sets):
            message = (
                f"while the trigger condition of {executor.name!r} keeps back {', '.join(map(repr, kept))}, "
                "waits return at once, so that the thread is busy until it is true"
            )
            notes.warning("EXE016", message, executor)
    if shares_session(executor, others):
        sharing = [each.name for each in other_threads(executor, others)]
        longest = max(longest_wait(each) for each in others if each.name in sharing)
        publishers = [handle.name for handle in executor.handles if handle.publications]
        if publishers and longest:
            message = (
                f"publications of {', '.join(map(repr, publishers))} in {executor.name!r} wait for the session "
                f"up to {time_text(longest)}, while {' or '.join(map(repr, sharing))} waits for input"
            )
            notes.warning("EXE022", message, executor)


def _note_handle(handle: HandleResult, executor: Executor, notes: AnalysisNotes) -> None:
    lost = handle.lost
    model = next(each for each in executor.handles if each.name == handle.name)
    if lost is None:
        sleep = sleep_of(executor).upper
        if handle.lateness is not None and handle.interval and sleep > handle.interval * LATE:
            most = handle.lateness.most
            late = "an unknown time" if most is None else rounded_time_text(most, Rounding.UP)
            message = f"{handle.name!r} can be called {late} after it is due, {time_text(sleep)} of which the loop sleeps"
            notes.warning("EXE011", message, model)
        return
    certainly = "loses" if lost.is_certain else "can lose"
    message = f"{handle.name!r} {certainly} {lost.what}: {lost.sequence}"
    match handle.kind:
        case HandleKind.TIMER:
            notes.warning("EXE010", message, model)
        case HandleKind.GUARD_CONDITION:
            notes.warning("EXE023", message, model)
        case _ if lost.is_of_pool:
            notes.warning("EXE014", message, model)
        case _:
            notes.warning("EXE015", message, model)
