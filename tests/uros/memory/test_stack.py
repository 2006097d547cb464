"""Stacks of their own, and the stack that the tasks of a core share."""

from itertools import combinations, pairwise

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.errors import ReadError
from amalthea_uros.uros.described import describe_text

KINDS = ("preemptive", "cooperative", "non-preemptive")


def described(tasks, isrs=(), stack="shared", cores=1):
    lines = [
        *("amuros: 1", "name: app", f"hardware: {{platform: generic, cores: {cores}}}", f"os: {{stack: {stack}}}", "tasks:"),
        *(f"  - {task}" for task in tasks),
        *(["isrs:", *(f"  - {isr}" for isr in isrs)] if isrs else []),
    ]
    return describe_text("\n".join(lines)).assembly.memory.stacks


def task(name, priority, size, preemption="preemptive", functions=1, core=0):
    stated = "" if size is None else f", stack: {size} B"
    runnables = ", ".join(f"{{name: {name}{number}, execution_time: 1 us}}" for number in range(functions))
    return (
        f"{{name: {name}, period: 10 ms, priority: {priority}, preemption: {preemption}, core: Core_{core}"
        f"{stated}, runnables: [{runnables}]}}"
    )


def isr(name, priority, size):
    return f"{{name: {name}, sporadic: 10 ms, priority: {priority}, stack: {size} B, execution_time: 1 us}}"


def test_tasks_with_stacks_of_their_own_are_summed():
    stacks = described([task("A", 1, 100), task("B", 2, 200), task("C", 3, None)], stack="per-task")
    assert (stacks.size, stacks.unknown) == (300, ("C",))


def chain(stacks):
    return [user.name for user in stacks.users]


def test_a_chain_of_preemption():
    stacks = described([task("A", 1, 100), task("B", 2, 200), task("C", 3, 300)])
    assert (stacks.size, chain(stacks)) == (600, ["A", "B", "C"])


def test_tasks_of_the_same_priority_never_lie_on_each_other():
    stacks = described([task("A", 1, 100), task("B", 1, 200), task("C", 2, 50)])
    assert (stacks.size, chain(stacks)) == (250, ["B", "C"])


def test_nothing_but_interrupts_lies_on_a_task_that_cannot_be_preempted():
    tasks = [task("A", 1, 100, "non-preemptive"), task("B", 2, 200)]
    assert described(tasks).size == 200
    assert described(tasks, [isr("I", 1, 150), isr("J", 2, 30), isr("K", 2, 40)]).size == 200 + 150 + 40


def test_cooperative_tasks_lie_on_each_other_between_two_functions_only():
    higher = task("B", 2, 200, "cooperative")
    assert described([task("A", 1, 100, "cooperative"), higher]).size == 200
    assert described([task("A", 1, 100, "cooperative", functions=2), higher]).size == 300
    # Others preempt them at any time.
    assert described([task("A", 1, 100, "cooperative"), task("B", 2, 200)]).size == 300


def test_each_core_has_a_stack():
    stacks = described([task("A", 1, 100), task("B", 2, 200, core=1)], cores=2)
    assert (stacks.size, chain(stacks)) == (300, ["A", "B"])


def test_unknown_sizes_make_a_lower_bound():
    stacks = described([task("A", 1, 100), task("B", 2, None)])
    assert (stacks.size, stacks.unknown) == (100, ("B",))


@examples(15)
@given(
    st.lists(
        st.tuples(st.integers(1, 4), st.integers(1, 50), st.sampled_from(KINDS), st.integers(1, 2)), min_size=1, max_size=6
    ),
    st.lists(st.tuples(st.integers(1, 3), st.integers(1, 50)), max_size=3),
)
def test_the_longest_chain_is_that_of_all_chains(tasks, isrs):
    """Against all sequences of processes, of rising priority, in which each one preempts the one before it."""
    named = [(f"T{number}", *each) for number, each in enumerate(tasks)]
    routines = [(f"I{number}", *each) for number, each in enumerate(isrs)]
    lines = [task(name, priority, size, kind, functions) for name, priority, size, kind, functions in named]
    stacks = described(lines, [isr(*each) for each in routines])

    def preempts(above, below):
        if len(above) == 3:
            return len(below) > 3 or above[1] > below[1]
        if len(below) == 3 or below[3] == "non-preemptive" or above[1] <= below[1]:
            return False
        return not (above[3] == below[3] == "cooperative" and below[4] == 1)

    everything = [*named, *routines]
    depths = [
        sum(each[2] for each in chosen)
        for count in range(1, len(everything) + 1)
        for chosen in combinations(sorted(everything, key=lambda each: (len(each) == 3, each[1])), count)
        if all(preempts(above, below) for below, above in pairwise(chosen))
    ]
    assert stacks.size == max(depths)


@pytest.mark.parametrize(("os", "shared"), [("", True), ("os: {stack: per-task}\n", False)])
def test_tasks_of_osek_share_their_stack(os, shared):
    text = f"amuros: 1\nname: app\nhardware: {{platform: generic}}\n{os}middleware: {{policy: OSEK}}\ntasks:\n  - {task('A', 1, 100)}"
    assert describe_text(text).assembly.memory.stacks.shared is shared


CALLBACKS = """\
amuros: 1
name: app
hardware: {{platform: generic}}
os: {{stack: {stack}}}
middleware:
  executor: {{name: Executor, stack: 400 B, loop: {{spin_some: 10 ms}}}}
  transport: {{can: {{bitrate: 500 kbit/s, interrupt: {{execution_time: 2 us, stack: 64 B}}}}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {{name: Take, topic: t, rate: 10 Hz, message_size: 4 B, execution_time: 1 us, runs_in: executor}}
      timers:
        - {{name: Fast, period: 10 ms, execution_time: 1 us, runs_in: {place}, priority: 2, stack: 100 B}}
        - {{name: Slow, period: 20 ms, execution_time: 1 us, runs_in: own-task, priority: 1{slow}}}
"""


def of_callbacks(stack="per-task", slow=", stack: 200 B", place="own-task"):
    return describe_text(CALLBACKS.format(stack=stack, slow=slow, place=place)).assembly.memory.stacks


def test_callbacks_in_tasks_of_their_own_have_stacks():
    stacks = of_callbacks()
    assert {user.name: user.size for user in stacks.users} == {"Executor": 400, "Fast": 100, "Slow": 200, "CAN_Receive": 64}
    assert (stacks.size, stacks.unknown) == (764, ())


def test_callbacks_share_the_stack_of_their_core():
    # On the slow one the fast one, on that the executor, if it is more urgent, and the interrupt.
    assert of_callbacks("shared").size == 200 + 100 + 400 + 64


def test_a_callback_without_a_stated_stack_makes_a_lower_bound():
    assert of_callbacks(slow="").unknown == ("Slow",)
    stacks = of_callbacks("shared", slow="")
    assert (stacks.size, stacks.unknown, "Slow" in chain(stacks)) == (564, ("Slow",), False)


def test_a_callback_in_the_executor_uses_the_stack_of_that():
    with pytest.raises(ReadError, match="'stack' of 'Fast' has no effect, because it runs in the executor"):
        of_callbacks(place="executor")
