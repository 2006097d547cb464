"""An overload is claimed only of a priority at which, or above which, some activation is lost if each job takes its longest time."""

from random import Random

from effort import examples
from hand_made_systems import system
from hypothesis import given
from hypothesis import strategies as st
from test_waits_for_events import to_perf
from waiting_player import PlayedTask, Player

from amalthea_uros.analyze.system import analyze_system


@st.composite
def systems(draw):
    """Tasks on two cores, of which some trigger others above or below them: response times and activations depend on each other."""
    count = draw(st.integers(3, 5))
    priorities = draw(st.permutations(range(count)))
    # Each task that is not periodic is triggered by one before it.
    triggering = [None, *(draw(st.none() | st.integers(0, number - 1)) for number in range(1, count))]
    tasks = []
    for number in range(count):
        effects = [("trigger", f"T{other}") for other in range(count) if triggering[other] == number]
        runs = [("run", length, length) for length in draw(st.lists(st.integers(1, 5), min_size=1, max_size=2))]
        body = (runs[0], *effects, *runs[1:])
        period = draw(st.sampled_from((6, 8, 12, 24))) if triggering[number] is None else 0
        core = draw(st.sampled_from((0, 0, 0, 1)))
        tasks.append(PlayedTask(f"T{number}", core, priorities[number], body, period, draw(st.integers(0, 5)) if period else 0))
    return tasks


def overloaded(tasks):
    """The tasks of a certain overload."""
    triggers = tuple(f"go {task.name}" for task in tasks if not task.period)
    processes = analyze_system(system(*map(to_perf, tasks), triggers=triggers)).processes
    return {each.name for each in processes if each.verdict == "unbounded"}


def level(tasks, name):
    """The tasks of a core that a task cannot preempt, and itself."""
    (own,) = (task for task in tasks if task.name == name)
    return {task.name for task in tasks if task.core == own.core and task.priority >= own.priority}


@given(systems())
@examples(6)
def test_an_overload_loses_activations(tasks):
    found = overloaded(tasks)
    if found:
        # An excess load is at least 1/24, so that after this time more is left than five jobs of ten units.
        lost = Player(tasks, Random(0)).play(24 * 5 * 10 + 24).lost
        assert all(lost & level(tasks, name) for name in found), (found, lost)


#: T0 and what it triggers above it need 6 of 6, and what it triggers below it is too much.
JUST_FULL = [
    PlayedTask("T0", 0, 1, (("run", 5, 5), ("trigger", "T1"), ("trigger", "T2")), 6),
    PlayedTask("T1", 0, 0, (("run", 1, 1),)),
    PlayedTask("T2", 0, 2, (("run", 1, 1),)),
]


def test_a_full_core_is_not_overloaded_by_what_is_below():
    assert "T0" not in overloaded(JUST_FULL)
