"""BTF files as the standard wants them (BTF 2.3.0)."""

import io

import pytest
from traces import encoded, table

from amalthea_uros._version import __version__
from amalthea_uros.trace.sinks import open_sink
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

K = EventKind
ENTITIES = [
    Entity(EntityKind.STIMULUS, "Sti_A"),
    Entity(EntityKind.STIMULUS, "Sti_B"),
    Entity(EntityKind.CORE, "Core_1"),
    Entity(EntityKind.TASK, "Task_A"),
    Entity(EntityKind.TASK, "Task_B"),
    Entity(EntityKind.RUNNABLE, "Run_1"),
    Entity(EntityKind.LABEL, "Label_1"),
]
STI_A, STI_B, CORE, TASK_A, TASK_B, RUN, LABEL = range(7)
#: A task that another one preempts, in nanoseconds.
PREEMPTION = [
    (0, K.TRIGGER, STI_A, 0, STI_A, 0),
    (0, K.ACTIVATE, STI_A, 0, TASK_A, 0),
    (100, K.START, CORE, 0, TASK_A, 0),
    (100, K.RUNNABLE_START, TASK_A, 0, RUN, 0),
    (150, K.READ, TASK_A, 0, LABEL, 0),
    (200, K.TRIGGER, STI_B, 0, STI_B, 0),
    (200, K.ACTIVATE, STI_B, 0, TASK_B, 0),
    (200, K.RUNNABLE_SUSPEND, TASK_A, 0, RUN, 0),
    (200, K.PREEMPT, CORE, 0, TASK_A, 0),
    (200, K.START, CORE, 0, TASK_B, 0),
    (300, K.TERMINATE, CORE, 0, TASK_B, 0),
    (300, K.RESUME, CORE, 0, TASK_A, 0),
    (300, K.RUNNABLE_RESUME, TASK_A, 0, RUN, 0),
    (400, K.RUNNABLE_TERMINATE, TASK_A, 0, RUN, 0),
    (400, K.TERMINATE, CORE, 0, TASK_A, 0),
]
LINES = """\
0,Sti_A,0,STI,Sti_A,0,trigger
0,Sti_A,0,T,Task_A,0,activate
100,Core_1,0,T,Task_A,0,start
100,Task_A,0,R,Run_1,0,start
150,Task_A,0,SIG,Label_1,0,read
200,Sti_B,0,STI,Sti_B,0,trigger
200,Sti_B,0,T,Task_B,0,activate
200,Task_A,0,R,Run_1,0,suspend
200,Core_1,0,T,Task_A,0,preempt
200,Core_1,0,T,Task_B,0,start
300,Core_1,0,T,Task_B,0,terminate
300,Core_1,0,T,Task_A,0,resume
300,Task_A,0,R,Run_1,0,resume
400,Task_A,0,R,Run_1,0,terminate
400,Core_1,0,T,Task_A,0,terminate
"""


#: What a picture shows of it in a row of the core and of each task.
SLICES = {
    "Core_1": [(100, 200, "Task_A"), (200, 300, "Task_B"), (300, 400, "Task_A")],
    "Task_A": [
        (0, 100, "active"),
        (100, 200, "running"),
        (100, 200, "Run_1"),
        (200, 300, "ready"),
        (300, 400, "running"),
        (300, 400, "Run_1"),
    ],
    "Task_B": [(200, 200, "active"), (200, 300, "running")],
}


def written(entities, rows):
    return encoded(".btf", table(entities, rows)).decode()


def events(text):
    return [line for line in text.splitlines() if not line.startswith("#")]


def in_nanoseconds(rows):
    return [(time * 1000, *rest) for time, *rest in rows]


def test_a_preemption_is_written_as_the_standard_shows_it():
    assert events(written(ENTITIES, PREEMPTION)) == LINES.splitlines()


def test_the_header():
    text = written(ENTITIES[:1], [])
    assert text == f"#version 2.3.0\n#creator amuros {__version__}\n#timescale ps\n#entityTypeMapping STI Sti_A\n"


MORE = [*ENTITIES, Entity(EntityKind.SEMAPHORE, "Lock"), Entity(EntityKind.OS_EVENT, "Go")]
LOCK, GO = 7, 8


@pytest.mark.parametrize(
    ("row", "line"),
    [
        # A task triggers the stimulus of another one.
        ((7, K.TRIGGER, TASK_A, 2, STI_B, 1), "7,Task_A,2,STI,Sti_B,1,trigger"),
        ((7, K.ACTIVATE, STI_B, 1, TASK_B, 1), "7,Sti_B,1,T,Task_B,1,activate"),
        # The events of a spinlock are those of the subset.
        ((1, K.REQUEST_SEMAPHORE, TASK_A, 0, LOCK, 0), "1,Task_A,0,SEM,Lock,0,requestsemaphore"),
        ((1, K.LOCK, LOCK, 0, LOCK, 0), "1,Lock,0,SEM,Lock,0,lock"),
        ((1, K.ASSIGNED, TASK_A, 0, LOCK, 0), "1,Task_A,0,SEM,Lock,0,assigned"),
        ((2, K.RELEASED, TASK_A, 0, LOCK, 0), "2,Task_A,0,SEM,Lock,0,released"),
        ((2, K.UNLOCK, LOCK, 0, LOCK, 0), "2,Lock,0,SEM,Lock,0,unlock"),
        # Notes are values of labels and owners of OS events.
        ((1, K.WRITE, TASK_A, 0, LABEL, 0, -5), "1,Task_A,0,SIG,Label_1,0,write,-5"),
        ((1, K.SET_EVENT, TASK_A, 0, GO, 0, TASK_B), "1,Task_A,0,EVENT,Go,0,set_event,Task_B"),
    ],
)
def test_the_line_of_an_event(row, line):
    assert events(written(MORE, [row])) == [line]


def test_steps_of_chains_are_not_written():
    entities = [*ENTITIES, Entity(EntityKind.CHAIN, "Chain")]
    text = written(entities, [(1, K.CHAIN_STEP, TASK_A, 0, 7, 0, 0), (2, K.START, CORE, 0, TASK_A, 0)])
    assert events(text) == ["2,Core_1,0,T,Task_A,0,start"]
    assert "Chain" not in text


def test_an_entity_that_comes_later_is_declared_before_its_first_event():
    entities = ENTITIES[:3]
    stream = io.BytesIO()
    with open_sink(stream, entities, suffix=".btf") as sink:
        entities.append(ENTITIES[3])
        sink.write(table(entities, [(9, K.START, 2, 0, 3, 0)]))
    assert stream.getvalue().decode().splitlines()[-2:] == ["#entityTypeMapping T Task_A", "9,Core_1,0,T,Task_A,0,start"]
