"""The results for all executors that spin in loops: the response times of their callbacks, by the kind of handle.

Let L be the longest cycle without a wait, W the longest wait, and E the time from when it is fixed what is ready to the end of a
callback.

- A timer: once it is due, waits end at once. In the worst case what is ready was fixed just before, so that it is called after one
  cycle: L + E. That a wait can end up to 1 ms before the timer is due, without a call, is no longer than that.
- A guard condition: a trigger does not end the wait, so that it is seen after one cycle and the wait: L + W + E.
- An item of a loop, such as a ping: nothing releases it, so that its time counts from the beginning of its iteration: E.
- A message: after n cycles, see `queue`: n L + E, or n (L + W) + E if messages can be stored before the iteration that takes them, or
  what `storage` has for that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.plural import counted
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.bounds.losses import (
    loss_of_timer,
    loss_of_triggers,
    slots_of_pool,
    stored_messages,
    with_lost_messages,
)
from amalthea_uros.executors.bounds.queue import Delay, certain_overload, delay_of
from amalthea_uros.executors.bounds.solved_system import METHOD, SolvedSystem
from amalthea_uros.executors.bounds.storage import Storage, storage_of
from amalthea_uros.executors.results import ExecutorResult, HandleResult, TimePart
from amalthea_uros.executors.semantics.loops import longest_wait, why_not_woken
from amalthea_uros.executors.semantics.readiness import is_message, sharing, starts_alone
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, LoopKind
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

SOURCE = "proof in docs/proofs/executor-cycle.md; ros2/rclc executor.c; micro-ROS/rmw_microxrcedds rmw_wait.c"


def handle_result(handle: Handle, cycle: Cycle, extra_jitter: Mapping[str, Time | None]) -> HandleResult:
    """The response time of a handle, and the lateness of a timer; losses of messages are found for all handles together."""
    # Each cycle before that which serves the handle can wait nevertheless.
    waited_for = why_not_woken(handle, cycle.executor, cycle.has_backlog)
    wait = longest_wait(cycle.executor) if waited_for else 0
    length = cycle.longest_with(wait)
    delay = _delay(handle, cycle, wait, extra_jitter)
    ready = None if delay.cycles is None or length is None else delay.time - delay.earlier
    stored = storage_of(handle, cycle, extra_jitter) if is_message(handle) and wait and not delay.is_overload else None
    if stored is not None and ready is not None and ready <= stored.most:
        stored = None
    if stored is not None:
        ready = stored.most
    start, end = cycle.until_start(handle), cycle.until_end(handle)
    is_item = handle.kind is HandleKind.LOOP_ITEM
    ready = 0 if is_item else ready
    worst = None if ready is None or end is None else ready + end
    lateness = None
    if handle.kind is HandleKind.TIMER:
        is_bounded = delay.cycles is not None and cycle.longest is not None and start is not None
        lateness = Span(most=(cycle.longest or 0) + (start or 0) if is_bounded else None)
    lost = None
    if lateness is not None:
        lost = loss_of_timer(handle, cycle, lateness)
    elif handle.kind is HandleKind.GUARD_CONDITION:
        lost = loss_of_triggers(handle, cycle, length, extra_jitter)
    return HandleResult(
        name=handle.name,
        kind=handle.kind,
        runnable=handle.runnable,
        interval=handle.interval,
        response=Response(
            worst=worst,
            best=cycle.demand.of_handle(handle).lower // cycle.time_base + cycle.suspension(handle).least,
            method=METHOD,
            source=SOURCE,
            claim=Claim.BOUND,
            reason="" if worst is not None else delay.reason or _unbounded(handle, cycle),
            is_overload=delay.is_overload,
        ),
        lateness=lateness,
        lost=lost,
        terms=()
        if worst is None
        else _terms([] if is_item else _until_ready(cycle, delay, wait, waited_for, stored), handle, cycle, worst),
    )


def _unbounded(handle: Handle, cycle: Cycle) -> str:
    """Why a response time is not bounded, although it is known after how many cycles the handle is served."""
    own = cycle.suspension(handle)
    return own.why if own.most is None and own.why else cycle.unbounded


def _delay(handle: Handle, cycle: Cycle, wait: Time, extra_jitter: Mapping[str, Time | None]) -> Delay:
    if not starts_alone(handle, cycle.executor):
        kind = cycle.executor.trigger.kind
        return Delay(cycles=None, reason=f"the trigger condition {kind.value!r} keeps it back until others are ready, too")
    cycles = cycle.in_sequence(wait)
    if not is_message(handle):
        return Delay(cycles=1, time=0 if cycles is None else cycles.longest)
    if cycles is None:
        return certain_overload(cycle) or Delay(cycles=None, reason=_unbounded(handle, cycle))
    return delay_of(handle, cycle, cycles, extra_jitter)


def _terms(until_ready: Sequence[TimePart], handle: Handle, cycle: Cycle, worst: Time) -> tuple[TimePart, ...]:
    """The parts of the worst response time of a handle, in the order of time."""
    stated = [term for term in (*until_ready, *_of_iteration(handle, cycle)) if term.most]
    rest = worst - sum(term.most or 0 for term in stated)
    if rest:
        stated.insert(-1, TimePart(name="preemption", most=rest, why="processes of higher priority, blocking, and rounding"))
    return tuple(stated)


def _until_ready(cycle: Cycle, delay: Delay, wait: Time, waited_for: str, stored: Storage | None) -> list[TimePart]:
    """The parts of the time until the iteration that serves a handle.

    Parameters
    ----------
    delay : before that iteration
    wait : what each cycle waits
    waited_for : why it does
    stored : what bounds this time better than cycles of which each waits; None if they do
    """
    if stored is not None:
        if not stored.is_stored:
            return [TimePart(name="running iteration", most=stored.most, why=stored.why)]
        return [TimePart(name="storage", most=stored.most, why=f"{waited_for}; {stored.why}")]
    return [*_of_cycle(cycle), TimePart(name="wait", most=wait, why=waited_for), _before(cycle, delay, wait)]


def _of_cycle(cycle: Cycle) -> list[TimePart]:
    """The cycle that is running when the handle is released."""
    demand = _time(cycle.whole.demand, cycle)
    found = [TimePart(name="rest of the running iteration", most=demand, why="what is ready was fixed just before")]
    loop = cycle.executor.loop
    if loop.kind is LoopKind.PERIODIC:
        why = f"the next iteration begins when the period of {time_text(loop.period or 0)} has passed"
        return [*found, TimePart(name="sleep", most=max(0, (cycle.longest or 0) - demand), why=why)]
    suspension = cycle.whole.suspension
    return [
        *found,
        TimePart(name="publications of the running iteration", most=suspension.most or 0, why=suspension.why),
        TimePart(name="sleep", most=cycle.sleep, why="the loop sleeps after each iteration"),
        TimePart(
            name="other executors of the loop",
            most=_time(sum(part.demand for part in cycle.others), cycle)
            + sum(part.suspension.most or 0 for part in cycle.others),
            why="the loop lets them spin before this one again, with their waits",
        ),
        TimePart(name="acknowledgements", most=cycle.writing.most or 0, why=cycle.writing.why),
        TimePart(name="sent again", most=cycle.again.most or 0, why=cycle.again.why),
        TimePart(
            name="session",
            most=cycle.session_wait or 0,
            why="other executors of the session wait for input and keep it",
        ),
    ]


def _before(cycle: Cycle, delay: Delay, wait: Time) -> TimePart:
    """The further cycles, one for each message before it."""
    count, length = (delay.cycles or 1) - 1, cycle.longest_with(wait) or 0
    why = f"{counted(count, 'message')}, each of which takes an iteration of at most {rounded_time_text(length, Rounding.UP)}"
    if delay.time < (count + 1) * length:
        why += ", in a part of which the loop does what it does in intervals"
    if delay.earlier:
        why += f", less {rounded_time_text(delay.earlier, Rounding.DOWN)} by which it arrives later"
    return TimePart(name="messages before it", most=delay.time - length - delay.earlier, why=why)


def _of_iteration(handle: Handle, cycle: Cycle) -> list[TimePart]:
    """The iteration that serves a handle, up to the end of its callback, which comes last."""
    costs, before, own = cycle.demand, cycle.before(handle), cycle.suspension(handle)
    spin, take, callback = costs.spin.upper, costs.takes[handle.name].upper, costs.callbacks[handle.name]
    others = before.demand - spin - take
    names = [each.name for each in cycle.executor.handles[: cycle.executor.handles.index(handle)]]
    return [
        TimePart(name="overhead of the executor", most=_time(spin, cycle), why="fill the wait set and check all handles"),
        TimePart(
            name="callbacks before it",
            most=_time(others, cycle),
            why=f"in the order of the executor: {', '.join(names)}",
        ),
        TimePart(name="publications before it", most=before.suspension.most or 0, why=before.suspension.why),
        TimePart(
            name="take",
            least=costs.takes[handle.name].lower // cycle.time_base,
            most=_time(take, cycle),
            why="read its message",
        ),
        TimePart(name="publish", least=own.least, most=own.most or 0, why=own.why),
        TimePart(name="its execution", least=callback.lower // cycle.time_base, most=_time(callback.upper, cycle)),
    ]


def _time(demand: Time, cycle: Cycle) -> Time:
    return demand // cycle.time_base


def evaluate_executors(
    solved: SolvedSystem, *, sending: Mapping[str, Span], extra_jitter: Mapping[str, Time | None]
) -> tuple[ExecutorResult, ...]:
    """The results for all executors of a system.

    Parameters
    ----------
    sending : times from the call of publish to its return, besides its execution, by the names of transmissions. Of a publication that
        is absent, or has no maximum, the time until it times out counts
    extra_jitter : by which messages are late on their way, besides what is stated for them, by the names of handles; None if unknown.
        A message that a wire brings and that is absent has an unknown jitter
    """
    executors = solved.context.system.executors
    cycles: dict[Executor, Cycle] = {}
    results: dict[Executor, ExecutorResult] = {}
    for executor in executors:
        try:
            cycles[executor] = cycle = Cycle.of(executor, solved, sending)
        except UnknownError as error:
            results[executor] = _unknown(executor, str(error))
        else:
            results[executor] = _bounded(cycle, extra_jitter)
    for executor in executors:
        together = sharing(executor, executors)
        stored = stored_messages({each: results[each].handles for each in together}, extra_jitter)
        needed = slots_of_pool(together, solved.context.system, stored)
        handles = results[executor].handles
        if executor in cycles:
            handles = Results(with_lost_messages(handles, cycles[executor], stored, needed))
        results[executor] = replace(results[executor], handles=handles, slots_needed=needed)
    return tuple(results.values())


def _bounded(cycle: Cycle, extra_jitter: Mapping[str, Time | None]) -> ExecutorResult:
    executor = cycle.executor
    return ExecutorResult(
        name=executor.name,
        task=executor.task,
        round=Span(least=cycle.demand.spin.lower // cycle.time_base, most=cycle.busy),
        loop=Span(least=cycle.shortest, most=cycle.longest_with_wait),
        handles=Results(handle_result(handle, cycle, extra_jitter) for handle in executor.handles),
        reason="" if cycle.longest is not None else cycle.unbounded,
    )


def _unknown(executor: Executor, reason: str) -> ExecutorResult:
    return ExecutorResult(
        name=executor.name,
        task=executor.task,
        round=Span(),
        loop=Span(),
        handles=Results(
            HandleResult(
                name=handle.name,
                kind=handle.kind,
                runnable=handle.runnable,
                interval=handle.interval,
                response=Response(worst=None, best=0, method=METHOD, source=SOURCE, claim=Claim.BOUND, reason=reason),
            )
            for handle in executor.handles
        ),
        reason=reason,
    )
