"""Histories of the quality of service that the middleware cannot hold."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.spec.application import MessageCallback
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.callbacks import Callback
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.notes import Notes

#: Depths of the profiles `rmw_qos_profile_default` and `rmw_qos_profile_sensor_data` in ros2/rmw rmw/include/rmw/qos_profiles.h.
RELIABLE_DEPTH, BEST_EFFORT_DEPTH = 10, 5


def depth_of(callback: Callback) -> int | None:
    """The depth of the history of a callback's messages; None if it has none."""
    if callback.incoming is None or not isinstance(callback.section, MessageCallback):
        return None
    stated = callback.section.depth
    default = RELIABLE_DEPTH if callback.incoming.reliable else BEST_EFFORT_DEPTH
    return default if stated is None else stated


def check_histories(callbacks: Sequence[Callback], middleware: Middleware, profile: Profile, notes: Notes) -> None:
    """Report histories that are deeper than the slots for all messages together, so that these are used up first."""
    slots = profile.waiting(middleware).slots
    if slots is None:
        return
    by_default = []
    for callback in callbacks:
        depth = depth_of(callback)
        if depth is None or depth <= slots or not isinstance(callback.section, MessageCallback):
            continue
        if callback.section.states("depth"):
            text = (
                f"the history of {callback.name!r} is {depth} messages deep, but only {slots} can be stored for all callbacks"
            )
            notes.warning("UR125", f"{text}: {_effect(callback)}", callback.section.location("depth"), _ADVICE)
        elif callback.in_executor and _loops(middleware):
            by_default.append(callback)
    if by_default:
        names = ", ".join(repr(callback.name) for callback in by_default)
        text = f"histories are 10 messages deep by default, but only {slots} can be stored for all callbacks"
        notes.info("UR125", f"{text}: {_effect(by_default[0])}: {names}", middleware.location("limits"), _ADVICE)


_ADVICE = "Set RMW_UXRCE_MAX_HISTORY to the messages that can wait at the same time, or a smaller 'depth'."


def _effect(callback: Callback) -> str:
    """What happens when the slots are used up before the history."""
    assert isinstance(callback.section, MessageCallback)
    expected = "the oldest one being overwritten" if callback.section.history == "keep-last" else "more being kept"
    return f"a new message of any topic is dropped instead of {expected}"


def _loops(middleware: Middleware) -> bool:
    return any(executor.loop is not None for executor in (*middleware.executors, middleware.executor))
