"""The words of the Best Trace Format (BTF), which entities cause the events, and the state charts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from amalthea_uros.trace.table import EntityKind, EventKind

_PROCESS = {
    "activate": EventKind.ACTIVATE,
    "start": EventKind.START,
    "preempt": EventKind.PREEMPT,
    "resume": EventKind.RESUME,
    "terminate": EventKind.TERMINATE,
    "poll": EventKind.POLL,
    "run": EventKind.RUN,
    "park": EventKind.PARK,
    "poll_parking": EventKind.POLL_PARKING,
    "release_parking": EventKind.RELEASE_PARKING,
    "wait": EventKind.WAIT,
    "release": EventKind.RELEASE,
    "mtalimitexceeded": EventKind.ACTIVATION_LOST,
    "interrupt_suspended": EventKind.INTERRUPT_SUSPENDED,
}

#: The events that are about entities of a type (BTF 2.3.0, table 2-1 and chapters of the types).
EVENTS: dict[EntityKind, dict[str, EventKind]] = {
    EntityKind.TASK: _PROCESS,
    EntityKind.ISR: _PROCESS,
    EntityKind.RUNNABLE: {
        "start": EventKind.RUNNABLE_START,
        "suspend": EventKind.RUNNABLE_SUSPEND,
        "resume": EventKind.RUNNABLE_RESUME,
        "terminate": EventKind.RUNNABLE_TERMINATE,
    },
    EntityKind.STIMULUS: {"trigger": EventKind.TRIGGER},
    EntityKind.LABEL: {"read": EventKind.READ, "write": EventKind.WRITE},
    EntityKind.SEMAPHORE: {
        "requestsemaphore": EventKind.REQUEST_SEMAPHORE,
        "lock": EventKind.LOCK,
        "unlock": EventKind.UNLOCK,
        "assigned": EventKind.ASSIGNED,
        "waiting": EventKind.WAITING,
        "released": EventKind.RELEASED,
        "increment": EventKind.INCREMENT,
        "decrement": EventKind.DECREMENT,
        "queued": EventKind.QUEUED,
        "used": EventKind.USED,
        "lock_used": EventKind.LOCK_USED,
        "overfull": EventKind.OVERFULL,
        "full": EventKind.FULL,
        "unlock_full": EventKind.UNLOCK_FULL,
        "free": EventKind.FREE,
    },
    EntityKind.OS_EVENT: {
        "set_event": EventKind.SET_EVENT,
        "clear_event": EventKind.CLEAR_EVENT,
        "wait_event": EventKind.WAIT_EVENT,
    },
    EntityKind.SCHEDULER: {"schedule": EventKind.SCHEDULE, "schedulepoint": EventKind.SCHEDULE_POINT},
}

#: The word for each kind of event; events of chains have none.
WORDS = {kind: word for events in EVENTS.values() for word, kind in events.items()}

#: The types of entities by the names that files have for them; older ones have another name for ISRs.
TYPES = {kind.value: kind for kind in EntityKind if kind is not EntityKind.CHAIN} | {"ISR": EntityKind.ISR}

PROCESSES = (EntityKind.TASK, EntityKind.ISR)
#: The transitions by which a process gets onto a core, and those by which it leaves it.
ENTERING = frozenset({EventKind.START, EventKind.RESUME, EventKind.POLL_PARKING})
LEAVING = frozenset({EventKind.PREEMPT, EventKind.PARK, EventKind.WAIT, EventKind.TERMINATE})
#: The changes of the state of a semaphore, which it causes itself.
SEMAPHORE_STATES = frozenset(
    {
        EventKind.LOCK,
        EventKind.UNLOCK,
        EventKind.USED,
        EventKind.LOCK_USED,
        EventKind.OVERFULL,
        EventKind.FULL,
        EventKind.UNLOCK_FULL,
        EventKind.FREE,
    }
)
#: Events about an OS event; their note is the task that owns it.
OS_EVENTS = frozenset(EVENTS[EntityKind.OS_EVENT].values())

_BY_STIMULUS = (EntityKind.STIMULUS, *PROCESSES)
_BY_PROCESS_OR_STIMULUS = (*PROCESSES, EntityKind.STIMULUS)

#: The types of what can cause an event, the usual one first, as files do not say it. What causes its own events is tried before.
SOURCES: dict[EventKind, tuple[EntityKind, ...]] = {
    **dict.fromkeys(_PROCESS.values(), (EntityKind.CORE,)),
    EventKind.ACTIVATE: _BY_STIMULUS,
    EventKind.ACTIVATION_LOST: _BY_STIMULUS,
    EventKind.INTERRUPT_SUSPENDED: (EntityKind.SCHEDULER,),
    **dict.fromkeys(EVENTS[EntityKind.RUNNABLE].values(), PROCESSES),
    EventKind.TRIGGER: _BY_PROCESS_OR_STIMULUS,
    EventKind.READ: PROCESSES,
    EventKind.WRITE: _BY_PROCESS_OR_STIMULUS,
    **dict.fromkeys(EVENTS[EntityKind.SEMAPHORE].values(), PROCESSES),
    **dict.fromkeys(SEMAPHORE_STATES, (*PROCESSES, EntityKind.SEMAPHORE)),
    **dict.fromkeys(OS_EVENTS, PROCESSES),
    EventKind.SET_EVENT: _BY_PROCESS_OR_STIMULUS,
    EventKind.SCHEDULE: (EntityKind.SCHEDULER,),
    EventKind.SCHEDULE_POINT: PROCESSES,
    EventKind.CHAIN_STEP: PROCESSES,
}


# The state charts of BTF 2.3.0: for each event the states in which it may occur, and the state after it.

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
