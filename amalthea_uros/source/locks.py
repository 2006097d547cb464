"""Locks of the application around calls of micro-ROS."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amalthea_uros.source.walk import FunctionCall

#: Functions that take a lock -> those that release it.
_RELEASES: Mapping[str, str] = {
    "xSemaphoreTake": "xSemaphoreGive",
    "xSemaphoreTakeRecursive": "xSemaphoreGiveRecursive",
    "osMutexAcquire": "osMutexRelease",
    "osMutexWait": "osMutexRelease",
    "osSemaphoreAcquire": "osSemaphoreRelease",
    "k_mutex_lock": "k_mutex_unlock",
    "k_sem_take": "k_sem_give",
    "pthread_mutex_lock": "pthread_mutex_unlock",
    "tx_mutex_get": "tx_mutex_put",
}
LOCKS = frozenset({*_RELEASES, *_RELEASES.values()})


def is_lock(call: FunctionCall, calls: Sequence[FunctionCall]) -> bool:
    """Whether a call takes a lock that the same thread releases; else it waits for another one, or for an interrupt."""
    release, taken = _RELEASES.get(call.name), call.argument(0)
    return (
        release is not None
        and taken is not None
        and any(each.name == release and each.root is call.root and _key(each) == taken.key for each in calls)
    )


def held_at(call: FunctionCall, calls: Sequence[FunctionCall]) -> set[str]:
    """The locks that a thread holds where a call is."""
    held: set[str] = set()
    for each in calls:
        if each is call:
            break
        if each.root is call.root and each.name in _RELEASES:
            held.add(_key(each))
        elif each.root is call.root and each.name in LOCKS:
            held.discard(_key(each))
    return held


def _key(call: FunctionCall) -> str:
    given = call.argument(0)
    return given.key if given is not None else ""
