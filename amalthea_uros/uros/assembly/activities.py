"""The activities of a runnable: lock, read, compute, write, send, unlock, trigger."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Execute,
    LabelAccess,
    SemaphoreAccess,
    SemaphoreOperation,
    Send,
    Trigger,
    Waiting,
)


def trigger_name(task: str) -> str:
    """The name of the stimulus that triggers a task."""
    return f"trigger_of_{task}"


def activity_sequence(
    execute: Iterable[Execute],
    *,
    reads: Iterable[str] = (),
    writes: Iterable[str] = (),
    sends: Iterable[str] = (),
    triggers: Iterable[str] = (),
    locks: Iterable[str] = (),
) -> tuple[Activity, ...]:
    """The activities of a runnable; locks are released in reverse order."""
    held = list(locks)
    return (
        *(_access(lock, SemaphoreOperation.REQUEST) for lock in held),
        *(LabelAccess(label=label, kind=AccessKind.READ) for label in reads),
        *execute,
        *(LabelAccess(label=label, kind=AccessKind.WRITE) for label in writes),
        *(Send(channel=channel) for channel in sends),
        *(_access(lock, SemaphoreOperation.RELEASE) for lock in reversed(held)),
        *(Trigger(stimulus=trigger_name(task)) for task in triggers),
    )


def _access(lock: str, operation: SemaphoreOperation) -> SemaphoreAccess:
    return SemaphoreAccess(semaphore=lock, operation=operation, waiting=Waiting.PASSIVE)
