"""The handles of an executor: one for each callback, several for the services of parameters and of the lifecycle.

How many there are: ros2/rclc `rclc/include/rclc/executor.h`, `rclc_parameter/include/rclc_parameter/rclc_parameter.h` (the constant
`RCLC_EXECUTOR_PARAMETER_SERVER_HANDLES` is 6, and 6 services are added; the README says 5). Entities of the wait set: ros2/rcl
`rcl_action/src/rcl_action/action_server.c` (3 services and a timer) and `action_client.c` (3 clients and 2 subscriptions).

Trigger conditions say which handles have to be ready before the callbacks of an iteration are called: see `rclc_executor_trigger_*` in
ros2/rclc `rclc/src/rclc/executor.c`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain

from amalthea_uros.perf.constraints import Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, TriggerCondition, TriggerKind
from amalthea_uros.perf.software import Runnable
from amalthea_uros.spec.application import MessageCallback, Subscription
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.checks import depth_of
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.transports.line import describes_wire
from amalthea_uros.uros.transports.messages import publications

_SOURCES = {HandleKind.ACTION_SERVER: 4, HandleKind.ACTION_CLIENT: 5}


def handle_names(callback: Callback) -> tuple[str, ...]:
    """The names of the handles of a callback."""
    if callback.kind in (HandleKind.PARAMETER_SERVICE, HandleKind.LIFECYCLE_SERVICE):
        return tuple(f"{callback.name}_{number}" for number in range(1, callback.handles + 1))
    return (callback.name,)


def handles_of(callback: Callback, take: Runnable | None, body: Runnable, profile: Profile) -> Iterator[Handle]:
    """The handles of a callback in its executor.

    Parameters
    ----------
    take : what takes its message; None if that costs nothing
    body : what the executor calls
    """
    section = callback.section
    is_subscription = isinstance(section, Subscription)
    has_messages = callback.kind not in (HandleKind.TIMER, HandleKind.GUARD_CONDITION, HandleKind.LOOP_ITEM)
    reliable = has_messages and (not isinstance(section, Subscription) or section.reliability == "reliable")
    incoming = callback.incoming
    handle = Handle(
        name=callback.name,
        kind=callback.kind,
        runnable=body.name,
        take=take.name if take else None,
        interval=callback.interval,
        jitter=callback.jitter,
        is_periodic=is_subscription or callback.kind is HandleKind.TIMER,
        phase=section.phase,
        transmission=incoming.transmission if incoming and describes_wire(profile.middleware.transport) else None,
        always=isinstance(section, Subscription) and section.invocation == "always",
        depth=depth_of(section),
        overwrites=not isinstance(section, MessageCallback) or section.history == "keep-last",
        reliable=reliable,
        sources=_SOURCES.get(callback.kind, 1),
        publications=tuple(publications(callback, profile)) if callback.in_executor else (),
        origin=callback.origin,
    )
    for name in handle_names(callback):
        yield replace(handle, name=name)


def deadlines(executors: Iterable[Executor], callbacks: Sequence[Callback]) -> Iterator[Requirement]:
    """The deadlines of callbacks in executors with loops as requirements on their runnables: the task has none for each of them."""
    runnables = {handle.name: handle.runnable for executor in executors for handle in executor.handles}
    for callback in callbacks:
        deadline = callback.section.deadline
        if callback.in_executor and callback.name in runnables and deadline is not None:
            yield Requirement(
                name=f"{callback.name}_deadline",
                runnable=runnables[callback.name],
                limit=TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=deadline),
                origin=callback.section.location("deadline"),
            )


def trigger_of(executor: ExecutorSection, handles: Mapping[str, Sequence[str]], notes: Notes) -> TriggerCondition:
    """The trigger condition of an executor.

    Parameters
    ----------
    handles : the names of the handles of each callback that it serves
    """
    section = executor.trigger
    if section.custom is not None:
        for names in section.custom:
            _check_defined(names, handles, executor, "custom", notes)
        sets = (frozenset(chain.from_iterable(handles.get(name, ()) for name in names)) for names in section.custom)
        return TriggerCondition(kind=TriggerKind.CUSTOM, sets=tuple(sets))
    if section.one is not None:
        _check_defined([section.one], handles, executor, "one", notes)
        return TriggerCondition(kind=TriggerKind.ONE, sets=(frozenset(handles.get(section.one, ())),))
    return TriggerCondition(kind=TriggerKind(section.when))


def _check_defined(names: Collection[str], known: Collection[str], executor: ExecutorSection, key: str, notes: Notes) -> None:
    for name in names:
        if name not in known:
            owner = f"the executor {executor.name!r}"
            notes.undefined("callback", name, known, executor.trigger.location(key), owner=owner)
