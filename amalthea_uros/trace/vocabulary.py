"""The words of the Best Trace Format (BTF), and which entities cause the events."""

from __future__ import annotations

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
