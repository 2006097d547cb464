"""What can be said of an executor with a loop before any time is computed: mistakes, and traps of rclc and its middleware.

Sources are cited at each check; `executor.c` is ros2/rclc `rclc/src/rclc/executor.c`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import takewhile

from amalthea_uros._internal.plural import counted, enumerated
from amalthea_uros.executors.semantics.loops import is_paced, iterations_follow_at_once
from amalthea_uros.executors.semantics.readiness import messages
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, LoopKind, TriggerKind
from amalthea_uros.spec import executors as spec
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import time_text
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes

_ACTIONS = (HandleKind.ACTION_SERVER, HandleKind.ACTION_CLIENT)


def check_executor(executor: Executor, section: spec.ExecutorSection, middleware: Middleware, notes: Notes) -> None:
    """Report what is wrong with an executor with a loop, or will surprise."""
    _check_keys(executor, section, notes)
    _check_handle_limit(executor, section, middleware, notes)
    _check_timeout(executor, section, notes)
    _check_polling(executor, section, notes)
    _check_one(executor, section, notes)
    _check_guard_conditions(executor, section, notes)


def _check_keys(executor: Executor, section: spec.ExecutorSection, notes: Notes) -> None:
    """Keys of an executor that a period activates."""
    if section.period is not None:
        message = f"'period' and 'loop' of {executor.name!r} exclude each other"
        notes.error("APP003", message, section.location("period"), "Remove 'period', or set 'loop: {spin_period: ...}'.")
    if section.states("offset") and executor.loop.period is None:
        message = f"'offset' of {executor.name!r} has no effect without a period"
        notes.error("APP003", message, section.location("offset"), "Remove 'offset'.")


def _check_handle_limit(executor: Executor, section: spec.ExecutorSection, middleware: Middleware, notes: Notes) -> None:
    """`rclc_executor_init` allocates the handles once; each `rclc_executor_add_*` beyond them returns an error."""
    count, limit = len(executor.handles), section.max_handles
    if limit is not None and count > limit:
        left = ", ".join(handle.name for handle in executor.handles[limit:])
        message = f"{executor.name!r} needs {counted(count, 'handle')}, but has only {limit}: adding {left} returns an error"
        advice = f"Set 'max_handles' and rclc_executor_init to {count}"
        servers = len(
            {handle.name.rpartition("_")[0] for handle in executor.handles if handle.kind is HandleKind.PARAMETER_SERVICE}
        )
        if middleware.ros is None and count - servers <= limit:
            # A parameter server had one handle less before iron.
            message = f"{message}, unless ROS 2 is humble or older"
            notes.warning("EXE001", message, section.location("max_handles"), f"{advice}, or state 'ros' under 'middleware'.")
        else:
            notes.error("EXE001", message, section.location("max_handles"), f"{advice}.")


def _check_timeout(executor: Executor, section: spec.ExecutorSection, notes: Notes) -> None:
    """`rclc_executor_spin_one_period` waits for the timeout of the executor (1 s, though a comment in executor.h says 100 ms)."""
    loop = executor.loop
    if loop.kind is LoopKind.PERIODIC and not is_paced(executor) and loop.period is not None and section.loop is not None:
        message = (
            f"{executor.name!r} waits for up to {time_text(loop.timeout)} in each period of {time_text(loop.period)}: "
            "without a message or timer, an iteration takes as long as the timeout"
        )
        advice = f"Call rclc_executor_set_timeout and set 'timeout' to less than {time_text(loop.period)}."
        notes.warning("EXE002", message, section.loop.location("timeout"), advice)


def _check_polling(executor: Executor, section: spec.ExecutorSection, notes: Notes) -> None:
    """Loops that never wait; where several executors spin in one, it waits if any of them does.

    Timeouts are cut to whole milliseconds (micro-ROS/rmw_microxrcedds `rmw_wait.c`); a due timer makes the timeout 0 (ros2/rcl
    `rcl/src/rcl/wait.c`), also if the trigger condition keeps it back.
    """
    if executor.place is not None:
        return
    loop, resolution, reason = executor.loop, executor.waiting.resolution, iterations_follow_at_once(executor)
    where = section.loop.location() if section.loop is not None else section.location()
    if reason and messages(executor):
        message = f"{executor.name!r} can use all the time that others leave it: {reason}"
        timeout = (
            "Use the trigger condition 'any'"
            if loop.timeout >= resolution
            else f"Set a timeout of {time_text(resolution)} or more"
        )
        notes.warning("EXE003", message, where, f"{timeout}, or add a 'sleep'.")
    elif reason and executor.handles and all(handle.kind is HandleKind.LOOP_ITEM for handle in executor.handles):
        message = f"{executor.name!r} can use all the time that others leave it: {reason}"
        notes.warning("EXE003", message, where, "Add a 'sleep'.")
    elif reason:
        message = (
            f"{executor.name!r} has timers only: the wait of the middleware returns at once, and the loop uses all the time that "
            "others leave it; with rmw_microxrcedds#305 it waits for the whole timeout instead, also if a guard condition is set"
        )
        notes.warning(
            "EXE006", message, where, "Add a 'sleep', or a subscription; check which version of the middleware is built."
        )
    elif 0 < loop.timeout < resolution:
        message = f"the timeout of {time_text(loop.timeout)} of {executor.name!r} is cut to 0: the executor does not wait"
        notes.warning("EXE003", message, where, f"Set a timeout of {time_text(resolution)} or more; or 0, if that is meant.")


def _check_one(executor: Executor, section: spec.ExecutorSection, notes: Notes) -> None:
    """`rclc_executor_trigger_one` answers false at the first handle that is ready and of a type that it does not know, an action."""
    if executor.trigger.kind is not TriggerKind.ONE or not executor.trigger.sets:
        return
    waited_for = executor.trigger.sets[0]
    own = [handle for handle in executor.handles if handle.name in waited_for]
    before = list(takewhile(lambda handle: handle.name not in waited_for, executor.handles))
    location = section.trigger.location("one")
    if any(handle.kind in _ACTIONS for handle in own):
        message = f"the trigger condition 'one' of {executor.name!r} does not know actions, so that it is never true"
        notes.warning("EXE004", message, location, "Use 'custom' with a trigger function of your own.")
    elif actions := [repr(handle.name) for handle in before if handle.kind in _ACTIONS]:
        what = f"whenever {enumerated(actions)} is ready, an action before it"
        message = f"the trigger condition 'one' of {executor.name!r} is false {what}"
        advice = f"Add {enumerated(sorted(map(repr, waited_for)))} to the executor before the actions."
        notes.warning("EXE004", message, location, advice)


def _check_guard_conditions(executor: Executor, section: spec.ExecutorSection, notes: Notes) -> None:
    """The middleware clears a guard condition when it has seen it (micro-ROS/rmw_microxrcedds `rmw_wait.c`)."""
    for guard in (handle for handle in executor.handles if handle.kind is HandleKind.GUARD_CONDITION):
        if _can_be_lost(guard, executor):
            message = (
                f"the guard condition of {guard.name!r} is cleared when it is seen: it is lost if the trigger condition of "
                f"{executor.name!r} is false in that iteration"
            )
            advice = f"Let {guard.name!r} alone make the trigger condition true."
            notes.warning("EXE005", message, section.trigger.location() or section.location(), advice)


def _can_be_lost(guard: Handle, executor: Executor) -> bool:
    match executor.trigger.kind:
        case TriggerKind.ALL:
            return len(executor.handles) > 1
        case TriggerKind.ONE | TriggerKind.CUSTOM:
            return frozenset([guard.name]) not in executor.trigger.sets
    return False


def check_threads(executors: Iterable[str], sending_tasks: Sequence[Callback], middleware: Middleware, notes: Notes) -> None:
    """Report threads that use a middleware at the same time that does not protect its session.

    Nothing is locked without `UCLIENT_PROFILE_MULTITHREAD` (eProsima/Micro-XRCE-DDS-Client `CMakeLists.txt`).

    Parameters
    ----------
    executors : names of those with loops
    sending_tasks : callbacks with tasks of their own that send messages
    """
    threads = [*map(repr, executors), *(repr(callback.name) for callback in sending_tasks)]
    if len(threads) < 2:
        return
    message = f"{enumerated(threads)} use the session of the middleware from several threads, but nothing locks it"
    advice = "Build with UCLIENT_PROFILE_MULTITHREAD=ON and set 'multithread: true', or let one executor run all callbacks."
    notes.warning("EXE008", message, middleware.location("multithread") or middleware.location(), advice)


def check_order(section: spec.ExecutorSection, notes: Notes) -> None:
    """Report callbacks that are listed twice: each is added once."""
    for index, name in enumerate(section.order):
        if name in section.order[:index]:
            message = f"{name!r} occurs twice in 'order' of {section.name!r}; the first place counts"
            notes.warning("EXE009", message, section.location("order", index), "Remove one of them.")
