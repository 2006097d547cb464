"""The parts of a worst response time: what is executed and waited for without others; the rest is preemption and blocking."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.executors.cycle import Cycle
from amalthea_uros.analyze.executors.queue import Delay
from amalthea_uros.analyze.executors.results import Term
from amalthea_uros.perf.executors import Handle, LoopKind
from amalthea_uros.units import Time, time_text


def terms_of(handle: Handle, cycle: Cycle, *, delay: Delay, wait: Time, waited_for: str, worst: Time) -> tuple[Term, ...]:
    """The parts of the worst response time of a handle, in the order of time.

    Parameters
    ----------
    delay : before the round that serves it
    wait : what each cycle waits
    waited_for : why it does
    """
    found = [
        *_of_cycle(cycle),
        Term(name="wait", least=0, most=wait, why=waited_for),
        _before(cycle, delay, wait),
        *_of_round(handle, cycle),
    ]
    stated = [term for term in found if term.most]
    rest = worst - sum(term.most for term in stated)
    if rest:
        stated.insert(
            -1, Term(name="preemption", least=0, most=rest, why="processes of higher priority, blocking, and rounding")
        )
    return tuple(stated)


def _of_cycle(cycle: Cycle) -> list[Term]:
    """The cycle that is running when the handle is released."""
    demand = _time(cycle.whole.demand, cycle)
    found = [Term(name="rest of the running round", least=0, most=demand, why="what is ready was fixed just before")]
    loop = cycle.executor.loop
    if loop.kind is LoopKind.SPIN_PERIOD:
        why = f"the next round begins when the period of {time_text(loop.period or 0)} has passed"
        return [*found, Term(name="sleep", least=0, most=max(0, (cycle.longest or 0) - demand), why=why)]
    suspension = cycle.whole.suspension
    return [
        *found,
        Term(name="publications of the running round", least=0, most=suspension.most or 0, why=suspension.why),
        Term(name="sleep", least=0, most=cycle.sleep, why="the loop sleeps after each round"),
        Term(name="acknowledgements", least=0, most=cycle.answering.most or 0, why=cycle.answering.why),
        Term(name="session", least=0, most=cycle.held or 0, why="other executors of the session wait for input and keep it"),
    ]


def _before(cycle: Cycle, delay: Delay, wait: Time) -> Term:
    """The further cycles, one for each message before it."""
    count, length = (delay.cycles or 1) - 1, cycle.longest_with(wait) or 0
    why = f"{counted(count, 'message')}, each of which takes a round of at most {time_text(length)}"
    if delay.earlier:
        why += f", less {time_text(delay.earlier)} by which it arrives later"
    return Term(name="messages before it", least=0, most=count * length - delay.earlier, why=why)


def _of_round(handle: Handle, cycle: Cycle) -> list[Term]:
    """The round that serves a handle, up to the end of its callback, which comes last."""
    costs, part, own = cycle.costs, cycle.before(handle), cycle.suspension(handle)
    spin, take, callback = costs.spin.worst, costs.takes[handle.name].worst, costs.callbacks[handle.name]
    others = part.demand - spin - take
    names = [each.name for each in cycle.executor.handles[: cycle.executor.handles.index(handle)]]
    return [
        Term(name="overhead of the executor", least=0, most=_time(spin, cycle), why="fill the wait set and check all handles"),
        Term(
            name="callbacks before it",
            least=0,
            most=_time(others, cycle),
            why=f"in the order of the executor: {', '.join(names)}",
        ),
        Term(name="publications before it", least=0, most=part.suspension.most or 0, why=part.suspension.why),
        Term(
            name="take", least=costs.takes[handle.name].best // cycle.time_base, most=_time(take, cycle), why="read its message"
        ),
        Term(name="publish", least=own.least, most=own.most or 0, why=own.why),
        Term(name="its execution", least=callback.best // cycle.time_base, most=_time(callback.worst, cycle)),
    ]


def _time(demand: Time, cycle: Cycle) -> Time:
    return demand // cycle.time_base
