"""Histories of the quality of service that the middleware cannot hold."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.spec.application import Application, MessageCallback, NodeSection, Subscription
from amalthea_uros.spec.application import CallbackSection as Section
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.entities import ACTION_SERVICES, ACTION_TOPICS, LIFECYCLE_SERVICES, PARAMETER_SERVICES
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.application.serving import stated_executors
from amalthea_uros.uros.middleware.profile import Profile

#: Depths of the profiles `rmw_qos_profile_default` and `rmw_qos_profile_sensor_data` in ros2/rmw rmw/include/rmw/qos_profiles.h.
_RELIABLE, _BEST_EFFORT = 10, 5


def depth_of(section: Section) -> int | None:
    """The depth of the history of a callback's messages; None if it has none."""
    if not isinstance(section, MessageCallback):
        return None
    is_best_effort = isinstance(section, Subscription) and section.reliability == "best-effort"
    return section.depth or (_BEST_EFFORT if is_best_effort else _RELIABLE)


def kept_messages(application: Application) -> int:
    """The most messages that the histories of an application keep together."""
    return sum(count * (depth_of(section) or 0) for node in application.nodes for section, count in _receivers(node))


def _receivers(node: NodeSection) -> Iterator[tuple[Section, int]]:
    """The callbacks with messages of a node, with the entities that receive them."""
    yield from ((section, 1) for section in (*node.subscriptions, *node.services, *node.clients))
    yield from ((section, ACTION_SERVICES) for section in node.action_servers)
    yield from ((section, ACTION_SERVICES + ACTION_TOPICS) for section in node.action_clients)
    if node.parameter_server is not None:
        yield MessageCallback.model_construct(), PARAMETER_SERVICES
    if node.lifecycle is not None:
        yield MessageCallback.model_construct(), LIFECYCLE_SERVICES


def check_histories(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report histories that are deeper than the slots for all messages together, so that these are used up first."""
    slots = profile.waiting.slots
    if slots is None:
        return
    by_default = []
    loops = {executor.name for executor in stated_executors(profile.middleware) if executor.loop is not None}
    for callback in callbacks:
        depth = depth_of(callback.section)
        if depth is None or depth <= slots:
            continue
        if callback.section.states("depth"):
            text = (
                f"the history of {callback.name!r} is {depth} messages deep, but only {slots} can be stored for all callbacks"
            )
            notes.warning("UR125", f"{text}: {_effect(callback)}", callback.section.location("depth"), _ADVICE)
        elif callback.executor in loops:
            by_default.append(callback)
    if by_default:
        names = ", ".join(repr(callback.name) for callback in by_default)
        text = f"by default, the histories of {names} are deeper than the storage for messages of all callbacks, {slots}"
        place = profile.middleware.limits.location("RMW_UXRCE_MAX_HISTORY")
        notes.info("UR125", f"{text}: {_effect(by_default[0])}", place, _ADVICE)


_ADVICE = "Set RMW_UXRCE_MAX_HISTORY to the messages that can wait at the same time, or a smaller 'depth'."


def _effect(callback: Callback) -> str:
    """What happens when the slots are used up before the history."""
    assert isinstance(callback.section, MessageCallback)
    expected = "the oldest one being overwritten" if callback.section.history == "keep-last" else "more being kept"
    return f"a new message of any topic is dropped instead of {expected}"
