"""No call of a played executor is later than its bound, and nothing is lost of which the analysis does not say so."""

import random

from effort import examples
from executor_player import MS, play
from hypothesis import given
from hypothesis import strategies as st
from looping_executors import evaluate, guard, looping, message, timer, waiting_publication

from amalthea_uros.perf.executors import HandleKind, Loop, LoopKind, Waiting
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND

LOOPS = st.one_of(
    st.builds(
        lambda sleep, timeout: Loop(kind=LoopKind.SPIN_SOME, sleep=sleep * MILLISECOND, timeout=timeout * MILLISECOND),
        st.sampled_from((0, 1, 10, 100)),
        st.sampled_from((0, 1, 10, 100)),
    ),
    st.builds(lambda timeout: Loop(kind=LoopKind.SPIN, timeout=timeout * MILLISECOND), st.sampled_from((1, 20, 1000))),
    st.builds(
        lambda period, timeout: Loop(kind=LoopKind.SPIN_PERIOD, period=period * MILLISECOND, timeout=timeout * MILLISECOND),
        st.sampled_from((5, 20)),
        st.sampled_from((1, 10, 1000)),
    ),
)
COSTS = st.sampled_from((0, 1, 130, 999, 2500))


@st.composite
def applications(draw):
    """Handles in any order, with their costs, and whether they publish and wait."""
    handles = []
    for number in range(draw(st.integers(1, 4))):
        interval, cost = draw(st.sampled_from((7, 40, 90, 250))) * MS, draw(COSTS)
        publications = (
            (waiting_publication(timeout=draw(st.sampled_from((5, 60))) * MILLISECOND),) if draw(st.integers(0, 3)) == 0 else ()
        )
        phase = draw(st.integers(0, interval)) * US
        parts = {"phase": phase, "publications": publications}
        match draw(st.sampled_from(("message", "message", "timer", "guard"))):
            case "message":
                jitter = draw(st.sampled_from((0, 0, 30))) * MILLISECOND
                depth, always = draw(st.sampled_from((1, 2, 10))), draw(st.integers(0, 5)) == 0
                overwrites = draw(st.booleans())
                handles.append(
                    message(
                        f"h{number}", interval, cost, jitter=jitter, depth=depth, overwrites=overwrites, always=always, **parts
                    )
                )
            case "timer":
                handles.append(timer(f"h{number}", interval, cost, **parts))
            case _:
                handles.append(guard(f"h{number}", interval, cost, **parts))
    waiting = Waiting(slots=draw(st.sampled_from((1, 4))))
    return looping(
        *handles, loop=draw(LOOPS), spin=draw(st.sampled_from((1, 50))), waiting=waiting, takes_first=draw(st.booleans())
    ), {handle.name: cost for handle, cost in handles}


def releases(handles, kinds, chance, until):
    """The times of messages or triggers, late by any part of their jitter, in the order of their arrival."""
    found = []
    for handle in handles:
        if handle.kind in kinds:
            period, jitter = handle.interval // US, handle.jitter // US
            for nominal in range(handle.phase // US, until, period):
                found.append((nominal + chance.choice((0, jitter, chance.randint(0, jitter))), handle.name))
    return sorted(found, key=lambda each: each[0])


@examples(24)
@given(applications(), st.integers(0, 2**32))
def test_no_call_is_later_and_no_loss_is_untold(application, seed):
    model, costs = application
    result, executor, chance = evaluate(model), model.executors[0], random.Random(seed)
    spin = model.runnables[executor.spin].activities[0].demand.ticks.value
    until = 300 * MS
    run = play(
        executor,
        costs,
        spin,
        releases(executor.handles, (HandleKind.SUBSCRIPTION,), chance, until),
        releases(executor.handles, (HandleKind.GUARD_CONDITION,), chance, until),
        chance,
        until,
    )
    for name, release, start, end in run.calls:
        found = result.handles[name]
        assert found.response.worst is None or (end - release) * US <= found.response.worst
        assert (end - release) * US >= found.response.best
        if found.lateness is not None and found.lateness.most is not None:
            assert (start - release) * US <= found.lateness.most
    assert run.lost <= {handle.name for handle in result.handles if handle.lost is not None}
    for handle in result.handles:
        if handle.terms:
            assert sum(term.most for term in handle.terms) == handle.response.worst
            assert all(term.most > 0 for term in handle.terms)
