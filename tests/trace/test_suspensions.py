"""Runnables pause with their process (BTF 2.3.0, section 2.3.3)."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from traces import chunks, random_trace, said, table

from amalthea_uros.trace.derived_events import RunnableSuspensions
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

K = EventKind
CORE, TASK, OUTER, INNER = range(4)
ENTITIES = [
    Entity(EntityKind.CORE, "C"),
    Entity(EntityKind.TASK, "T"),
    Entity(EntityKind.RUNNABLE, "R"),
    Entity(EntityKind.RUNNABLE, "Q"),
]


def test_the_inner_runnable_is_suspended_first_and_resumed_last():
    recorded = table(
        ENTITIES,
        [
            (10, K.START, CORE, 0, TASK, 4),
            (10, K.RUNNABLE_START, TASK, 4, OUTER, 7),
            (12, K.RUNNABLE_START, TASK, 4, INNER, 9),
            (20, K.PREEMPT, CORE, 0, TASK, 4),
            (30, K.RESUME, CORE, 0, TASK, 4),
            (40, K.RUNNABLE_TERMINATE, TASK, 4, INNER, 9),
            (50, K.WAIT, CORE, 0, TASK, 4),
        ],
    )
    complete = RunnableSuspensions().insert(recorded)
    assert said(complete)[3:9] == said(
        table(
            ENTITIES,
            [
                (20, K.RUNNABLE_SUSPEND, TASK, 4, INNER, 9),
                (20, K.RUNNABLE_SUSPEND, TASK, 4, OUTER, 7),
                (20, K.PREEMPT, CORE, 0, TASK, 4),
                (30, K.RESUME, CORE, 0, TASK, 4),
                (30, K.RUNNABLE_RESUME, TASK, 4, OUTER, 7),
                (30, K.RUNNABLE_RESUME, TASK, 4, INNER, 9),
            ],
        )
    )
    assert complete.kind.tolist()[9:] == [K.RUNNABLE_TERMINATE, K.RUNNABLE_SUSPEND, K.WAIT]


@given(st.randoms(use_true_random=False), st.integers(1, 20))
def test_of_a_legal_trace_they_are_what_was_taken_away(random, size):
    legal = random_trace(random, steps=150)
    paused = np.isin(legal.kind, [K.RUNNABLE_SUSPEND, K.RUNNABLE_RESUME])
    recorded = legal.where(~paused)
    assert said(map(RunnableSuspensions().insert, chunks(recorded, size))) == said(legal)
