"""Locks of the application around calls of micro-ROS."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

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

#: A function that takes or releases a lock, the thread that calls it, and the key of the lock.
_LockUse: TypeAlias = tuple[str, int, str]


class ReleasedLocks:
    """The locks that threads release which take them; who waits for others waits for another thread, or for an interrupt."""

    def __init__(self, calls: Iterable[FunctionCall]) -> None:
        self._released = {_use(call.name, call) for call in calls if call.name in LOCKS}

    def has(self, call: FunctionCall) -> bool:
        """Whether a call takes such a lock."""
        release = _RELEASES.get(call.name)
        return release is not None and call.argument(0) is not None and _use(release, call) in self._released


def held_at_all(users: Sequence[FunctionCall], calls: Iterable[FunctionCall]) -> set[str]:
    """The locks that threads hold wherever some calls are: for each, the calls are counted that are made while it is held.

    Parameters
    ----------
    calls : all, in order
    """
    counted = set(map(id, users))
    before: Counter[int] = Counter()
    since: dict[tuple[int, str], int] = {}
    held: Counter[str] = Counter()
    for call in calls:
        thread = id(call.root)
        if id(call) in counted:
            before[thread] += 1
        elif call.name in _RELEASES:
            since.setdefault((thread, _key(call)), before[thread])
        elif call.name in LOCKS and (taken := since.pop((thread, _key(call)), None)) is not None:
            held[_key(call)] += before[thread] - taken
    for (thread, key), taken in since.items():
        held[key] += before[thread] - taken
    return {key for key, number in held.items() if number == len(users)}


def _use(name: str, call: FunctionCall) -> _LockUse:
    return name, id(call.root), _key(call)


def _key(call: FunctionCall) -> str:
    given = call.argument(0)
    return given.key if given is not None else ""
