"""The words of the Best Trace Format (BTF), which entities cause the events, and the state charts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from amalthea_uros.trace.table import EntityKind, EventKind


def _named(*kinds: EventKind, prefix: str = "", **others: EventKind) -> dict[str, EventKind]:
    """Kinds of events by their words: their names here without a prefix, or others."""
    return {kind.name.lower().removeprefix(prefix): kind for kind in kinds} | others


_PROCESS = _named(
    *(kind for kind in EventKind if kind <= EventKind.RELEASE),
    EventKind.INTERRUPT_SUSPENDED,
    mtalimitexceeded=EventKind.ACTIVATION_LOST,
)

#: The events that are about entities of a type (BTF 2.3.0, table 2-1 and chapters of the types).
EVENTS: dict[EntityKind, dict[str, EventKind]] = {
    EntityKind.TASK: _PROCESS,
    EntityKind.ISR: _PROCESS,
    EntityKind.RUNNABLE: _named(
        EventKind.RUNNABLE_START,
        EventKind.RUNNABLE_SUSPEND,
        EventKind.RUNNABLE_RESUME,
        EventKind.RUNNABLE_TERMINATE,
        prefix="runnable_",
    ),
    EntityKind.STIMULUS: {"trigger": EventKind.TRIGGER},
    EntityKind.LABEL: {"read": EventKind.READ, "write": EventKind.WRITE},
    EntityKind.SEMAPHORE: _named(
        *(kind for kind in EventKind if EventKind.LOCK <= kind <= EventKind.RELEASED),
        *(kind for kind in EventKind if EventKind.INCREMENT <= kind <= EventKind.FREE),
        requestsemaphore=EventKind.REQUEST_SEMAPHORE,
    ),
    EntityKind.OS_EVENT: _named(EventKind.SET_EVENT, EventKind.CLEAR_EVENT, EventKind.WAIT_EVENT),
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
#: Events about an OS event; their note is the task that owns it.
OS_EVENTS = frozenset(EVENTS[EntityKind.OS_EVENT].values())

# The state charts of BTF 2.3.0: for each event the states in which it may occur, and the state after it.

Chart: TypeAlias = Mapping[EventKind, tuple[frozenset[str], str]]


def chart(rows: Mapping[EventKind, tuple[str, str]]) -> Chart:
    """A state chart: the states are words with blanks between them."""
    return {kind: (frozenset(before.split()), after) for kind, (before, after) in rows.items()}


#: Jobs of tasks and ISRs (figure 2-4 and tables 2-10 to 2-24 of the standard).
PROCESS = chart(
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

_STATES_OF_SEMAPHORES = (
    EventKind.LOCK,
    EventKind.UNLOCK,
    *(kind for kind in EventKind if EventKind.USED <= kind <= EventKind.FREE),
)
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
    # It causes the changes of its state itself.
    **dict.fromkeys(_STATES_OF_SEMAPHORES, (*PROCESSES, EntityKind.SEMAPHORE)),
    **dict.fromkeys(OS_EVENTS, PROCESSES),
    EventKind.SET_EVENT: _BY_PROCESS_OR_STIMULUS,
    EventKind.SCHEDULE: (EntityKind.SCHEDULER,),
    EventKind.SCHEDULE_POINT: PROCESSES,
    EventKind.CHAIN_STEP: PROCESSES,
}
