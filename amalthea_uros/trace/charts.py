"""The state charts of BTF 2.3.0: for each event the states in which it may occur, and the state after it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from amalthea_uros.trace.table import EventKind

Chart: TypeAlias = Mapping[EventKind, tuple[frozenset[str], str]]


def _chart(rows: Mapping[EventKind, tuple[str, str]]) -> Chart:
    return {kind: (frozenset(before.split()), after) for kind, (before, after) in rows.items()}


#: Jobs of tasks and ISRs (figure 2-4 and tables 2-10 to 2-24 of the standard).
PROCESS = _chart(
    {
        EventKind.ACTIVATE: ("terminated", "active"),
        EventKind.ACTIVATION_LOST: ("terminated", "terminated"),
        EventKind.INTERRUPT_SUSPENDED: ("active", "active"),
        EventKind.START: ("active", "running"),
        EventKind.PREEMPT: ("running", "ready"),
        EventKind.RESUME: ("ready", "running"),
        EventKind.TERMINATE: ("running", "terminated"),
        EventKind.POLL: ("running", "polling"),
        EventKind.RUN: ("polling", "running"),
        EventKind.PARK: ("polling", "parking"),
        EventKind.POLL_PARKING: ("parking", "polling"),
        EventKind.RELEASE_PARKING: ("parking", "ready"),
        EventKind.WAIT: ("running", "waiting"),
        EventKind.RELEASE: ("waiting", "ready"),
    }
)
#: The states of a process in which it is on a core.
ON_CORE = frozenset({"running", "polling"})

#: Executions of runnables (section 2.3.3).
RUNNABLE = _chart(
    {
        EventKind.RUNNABLE_START: ("terminated", "running"),
        EventKind.RUNNABLE_SUSPEND: ("running", "suspended"),
        EventKind.RUNNABLE_RESUME: ("suspended", "running"),
        EventKind.RUNNABLE_TERMINATE: ("running", "terminated"),
    }
)

#: Semaphores (section 2.3.7); those of spinlocks are a part of it (section 2.3.8).
SEMAPHORE = _chart(
    {
        EventKind.USED: ("free used", "used"),
        EventKind.LOCK: ("free", "full"),
        EventKind.LOCK_USED: ("used", "full"),
        EventKind.OVERFULL: ("full overfull", "overfull"),
        EventKind.FULL: ("overfull", "full"),
        EventKind.UNLOCK_FULL: ("full", "used"),
        EventKind.FREE: ("used", "free"),
        EventKind.UNLOCK: ("full", "free"),
    }
)

#: What a job does with a semaphore: the order of the events that processes cause (section 2.3.7).
ACCESS = _chart(
    {
        EventKind.REQUEST_SEMAPHORE: ("idle", "requested"),
        EventKind.INCREMENT: ("requested", "requested"),
        EventKind.QUEUED: ("requested", "queued"),
        EventKind.WAITING: ("requested queued", "waiting"),
        EventKind.ASSIGNED: ("requested queued waiting", "assigned"),
        EventKind.RELEASED: ("assigned", "idle"),
        EventKind.DECREMENT: ("idle", "idle"),
    }
)
