"""What an iteration of an executor does, as activities of the task that executes one iteration per job.

First it spins, which costs the same in every iteration. Then it calls what is ready, in the order of the handles, each message taken
just before its callback or (LET) all messages first. Nobody knows which handles are ready in an iteration, so each one is a branch by
chance. If a wait takes one message at most, and nothing else stores messages meanwhile, an iteration has a message for one handle at
most: then the message handles exclude each other.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import chain, takewhile

from amalthea_uros._internal.records import dataclass
from amalthea_uros.executors.semantics.loops import is_paced
from amalthea_uros.executors.semantics.readiness import can_defer, timers, waits_for_acknowledgements
from amalthea_uros.perf.activities import Activity, Call, Chance, ProbabilitySwitch
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, TriggerKind

#: What only the message of its own service, client or subscription can make ready.
_BY_ONE_MESSAGE = frozenset(
    {
        HandleKind.SUBSCRIPTION,
        HandleKind.SERVICE,
        HandleKind.CLIENT,
        HandleKind.ACTION_CLIENT,
        HandleKind.PARAMETER_SERVICE,
        HandleKind.LIFECYCLE_SERVICE,
    }
)

Activities = tuple[Activity, ...]


def has_one_message_per_iteration(executor: Executor, is_alone: bool) -> bool:
    """Whether at most one of its messages is taken in an iteration.

    A publication that waits for its acknowledgement stores what arrives meanwhile (micro-ROS/rmw_microxrcedds `rmw_publish.c`), and so
    does the wait of another executor of the same session; a trigger condition can keep messages back for later.

    Parameters
    ----------
    is_alone : whether no other thread waits or sends
    """
    can_store = can_defer(executor) or waits_for_acknowledgements(executor)
    return executor.waiting.messages_per_wait == 1 and is_alone and not can_store


def iteration_activities(executor: Executor, *, exclusive: bool, poll: str | None) -> Activities:
    """The activities of an iteration.

    Parameters
    ----------
    exclusive : whether at most one message is taken
    poll : runnable that stands for polling until a timer is due, when the wait has ended too early; None if that does not happen
    """
    spin = Call(runnable=executor.spin)
    body = _Iteration(executor, exclusive, poll).body()
    after = () if executor.busy_wait is None else (Call(runnable=executor.busy_wait),)
    return (spin, *body, *after)


def polls_before_timers(executor: Executor) -> bool:
    """Whether iterations follow each other at once before a timer is due: the wait is cut to whole multiples of its resolution."""
    return bool(timers(executor)) and executor.waiting.resolution > 0 and not is_paced(executor)


@dataclass(frozen=True, slots=True)
class _Iteration:
    executor: Executor
    exclusive: bool
    poll: str | None

    def body(self) -> Activities:
        """What may be called, under the trigger condition."""
        messages = [handle for handle in self.executor.handles if self._is_exclusive(handle)] if self.exclusive else []
        # Several services of the same callback are one branch.
        chosen = {(handle.take, handle.runnable): handle.name for handle in messages}
        without = self._sequence(frozenset(handle.name for handle in messages), None)
        branches = [self._sequence(frozenset(handle.name for handle in messages), name) for name in chosen.values()]
        found = _one_of((*branches, without)) if branches else without
        is_always_true = self.executor.trigger.kind is TriggerKind.ALWAYS
        return _maybe(found) if found and self._certain() and not is_always_true else found

    def _is_exclusive(self, handle: Handle) -> bool:
        return handle.kind in _BY_ONE_MESSAGE and not handle.always

    def _certain(self) -> frozenset[str]:
        """The handles that are called whenever the trigger condition is true."""
        trigger = self.executor.trigger
        if trigger.kind is TriggerKind.ALL:
            return frozenset(handle.name for handle in self.executor.handles)
        waited_for = trigger.sets[0] if trigger.kind is TriggerKind.ONE and trigger.sets else frozenset[str]()
        return waited_for | {handle.name for handle in self.executor.handles if handle.always}

    def _sequence(self, exclusive: Collection[str], chosen: str | None) -> Activities:
        """The activities of all handles, of the exclusive ones only of the chosen one."""
        parts = [self._parts(handle, handle.name == chosen) for handle in self._served(exclusive, chosen)]
        if self.executor.takes_first:
            return (*chain.from_iterable(take for take, _ in parts), *chain.from_iterable(call for _, call in parts))
        return tuple(chain.from_iterable(_joined(take, call) for take, call in parts))

    def _served(self, exclusive: Collection[str], chosen: str | None) -> Iterator[Handle]:
        for handle in self.executor.handles:
            if handle.name not in exclusive or handle.name == chosen:
                yield handle

    def _parts(self, handle: Handle, is_chosen: bool) -> tuple[Activities, Activities]:
        """What takes the message of a handle, and its callback."""
        certain = is_chosen or handle.name in self._certain()
        polling = (Call(runnable=self.poll),) if self.poll and handle.kind is HandleKind.TIMER else ()
        take: Activities = (*polling, *((Call(runnable=handle.take),) if handle.take else ()))
        call: Activities = (Call(runnable=handle.runnable),)
        if not certain:
            return _maybe(take), _maybe(call)
        # A handle that is always called takes a message only if there is one.
        return (_maybe(take) if handle.always and self.executor.trigger.kind is not TriggerKind.ALL else take), call


def _joined(take: Activities, call: Activities) -> Activities:
    """A take and a call that both may happen, as one branch: a callback runs when its message was taken."""
    match take, call:
        case (ProbabilitySwitch() as first,), (ProbabilitySwitch() as second,):
            return _maybe((*first.branches[0].activities, *second.branches[0].activities))
    return (*take, *call)


def _maybe(activities: Activities) -> Activities:
    return (ProbabilitySwitch(branches=(_chance(activities), _chance(()))),) if activities else ()


def _one_of(branches: Sequence[Activities]) -> Activities:
    """One of several branches; what they all begin or end with is before or after it."""
    before = _common(branches)
    rest = [branch[before:] for branch in branches]
    after = _common([branch[::-1] for branch in rest])
    inner = dict.fromkeys(branch[: len(branch) - after] for branch in rest)
    first = branches[0]
    return (
        *first[:before],
        ProbabilitySwitch(branches=tuple(map(_chance, inner))),
        *first[len(first) - after :],
    )


def _common(branches: Sequence[Activities]) -> int:
    """The number of activities that all branches begin with."""
    return sum(1 for _ in takewhile(lambda items: len(set(items)) == 1, zip(*branches, strict=False)))


def _chance(activities: Activities) -> Chance:
    return Chance(weight=1.0, activities=activities)
