"""What a model leaves open is proposed as changes; each proposal was applied, and nothing of it is needless."""

from dataclasses import replace

import pytest
from hand_made_systems import of_parts, read, ticks, write

from amalthea_uros import build_model, load, save
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.bridge.extract import extract
from amalthea_uros.design import missing_values as module
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import parse_change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.origin import SystemOrigin
from amalthea_uros.design.missing_values import missing_values
from amalthea_uros.perf.activities import Call, Demand, Execute
from amalthea_uros.perf.distributions import Boundaries, Constant, Gauss, Uniform
from amalthea_uros.perf.hardware import Hardware
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.os import Os, Policy
from amalthea_uros.perf.software import Isr, Label, Runnable, Task
from amalthea_uros.perf.stimuli import Custom, Periodic, RelativePeriodic
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.changed_model import write_changed
from amalthea_uros.timing.basics.settings import Settings

MS = 10**9


def task(name, *used):
    return Task(name=name, stimuli=used, activities=(ticks(10),))


#: At 1 MHz each job takes 10 us. A lacks nothing; B lacks a stimulus; C is not allocated.
SYSTEM = of_parts(
    [task("A", "tick"), task("B"), task("C", "tick")],
    [TaskAllocation(task="A", scheduler="core", priority=3), TaskAllocation(task="B", scheduler="core", priority=2)],
    [Periodic(name="tick", period=MS)],
    policy=Policy.FIXED_PRIORITY_PREEMPTIVE,
)


def missing_values_of(system):
    return missing_values(SystemOrigin(Configuration(system, Settings())), analyze_system(system, Settings()))


def proposed(system):
    found = missing_values_of(system)
    return None if found is None else ({change.target for change in found.changes}, found.gained)


def test_what_is_missing_is_named_and_nothing_else():
    # As long as nobody knows where C is executed, it may delay A. Its priority is not needed: there is a bound for any order.
    assert proposed(SYSTEM) == ({"B.period", "C.scheduler"}, ("A", "B", "C"))


def test_needless_values_are_not_looked_for_once_the_analyses_have_taken_too_much_work(monkeypatch):
    """What is gained stays the same."""
    monkeypatch.setattr(module, "MAX_JOBS", 1)
    assert proposed(SYSTEM) == ({"B.period", "C.scheduler", "A.deadline", "B.deadline"}, ("A", "B", "C"))


def test_who_has_no_execution_time_is_given_one_in_what_it_calls_or_itself():
    tasks = [
        Task(name="A", stimuli=("tick",)),
        Task(name="B", stimuli=("tick",), activities=(Call(runnable="R"), Call(runnable="S"))),
    ]
    allocations = [TaskAllocation(task=name, scheduler="core", priority=number) for number, name in enumerate("AB")]
    passing = (read("label"), write("label"))
    system = of_parts(
        tasks,
        allocations,
        [Periodic(name="tick", period=MS)],
        runnables=(Runnable(name="R", activities=passing), Runnable(name="S")),
        labels=(Label(name="label"),),
        frequency=10**9,
    )
    assert proposed(system) == ({"A.execution_time", "R.execution_time"}, ("A", "B"))
    after, _ = apply(system, Settings(), missing_values_of(system).changes)
    # It executes between reading and writing.
    assert after.runnables["R"].activities == (passing[0], ticks(1000), passing[1])


def test_a_new_execution_time_is_written(tmp_path):
    system = of_parts(
        [Task(name="A", stimuli=("tick",))],
        [TaskAllocation(task="A", scheduler="core", priority=1)],
        [Periodic(name="tick", period=MS)],
        frequency=10**9,
    )
    model = build_model(system)
    write_changed(model, missing_values_of(system).changes, Settings(), tmp_path / "new.amxmi")
    assert extract(load(tmp_path / "new.amxmi")).system.processes["A"].activities == (ticks(1000),)


def test_with_the_proposal_all_processes_have_a_response_time():
    found = missing_values_of(SYSTEM)
    after = analyze_system(*apply(SYSTEM, Settings(), found.changes))
    # In the worst order each waits for two others; A is above B, and only waits for C.
    assert [process.response.worst for process in after.processes] == [20 * MS // 1000, 30 * MS // 1000, 30 * MS // 1000]


def test_a_scheduler_by_deadlines_has_bounds_without_them():
    """For any deadlines."""
    edf = of_parts(
        [task("A", "tick"), task("B", "tick")],
        [TaskAllocation(task=name, scheduler="core") for name in "AB"],
        [Periodic(name="tick", period=MS)],
        policy=Policy.EARLIEST_DEADLINE_FIRST,
    )
    assert proposed(edf) is None


def test_what_has_all_its_response_times_lacks_nothing():
    whole = replace(SYSTEM, software=replace(SYSTEM.software, tasks=SYSTEM.software.tasks[:1]))
    assert proposed(replace(whole, mapping=replace(whole.mapping, tasks=whole.mapping.tasks[:1]))) is None


@pytest.mark.parametrize("hardware", [SYSTEM.hardware, Hardware()])
def test_a_core_without_a_scheduler_is_given_one_and_a_model_without_cores_a_core(hardware):
    lonely = replace(SYSTEM, hardware=hardware, os=Os(), mapping=Mapping())
    found = missing_values_of(lonely)
    name, stated = ("core", []) if hardware.structures else ("CPU", ["CPU.frequency"])
    assert [change.target for change in found.changes] == [*stated, f"{name}.policy", "A.core", "B.core", "B.period", "C.core"]
    # Other files of the model may say more about its schedulers.
    assert found.lacks_schedulers
    after = analyze_system(*apply(lonely, Settings(), found.changes))
    # The bounds hold for any order of priorities; 30 ticks are 30 us at 1 MHz, and 30 ns at 1 GHz.
    assert {each.wcrt for each in after.processes} == {30 * MS // 1000 if hardware.structures else 30_000}


def test_priorities_that_are_proposed_are_rate_monotonic():
    # Loads of 50 %, 40 % and 60 %: each may be the lowest of an overloaded core, but the two fastest fit together.
    demands = {"Fast": (10, 5), "Middle": (20, 8), "Slow": (40, 24)}
    system = of_parts(
        [replace(task(name, name), activities=(ticks(demand),)) for name, (_, demand) in demands.items()],
        [TaskAllocation(task=name, scheduler="core") for name in demands],
        [Periodic(name=name, period=period * MS // 1000) for name, (period, _) in demands.items()],
        policy=Policy.FIXED_PRIORITY_PREEMPTIVE,
    )
    found = missing_values_of(system)
    assert [str(change) for change in found.changes] == ["Slow.priority=1", "Middle.priority=2", "Fast.priority=3"]
    assert found.gained == ("Fast", "Middle")


def test_a_stated_period_says_nothing_of_the_phase():
    """Not an offset of 0, which would make the releases of both tasks known."""
    changed = apply(SYSTEM, Settings(), [parse_change("B.period=2ms")]).system
    (name,) = changed.processes["B"].stimuli
    assert isinstance(changed.stimuli_by_name[name], RelativePeriodic)


@pytest.mark.parametrize("change", ["B.period=2ms", "C.scheduler=core"])
def test_what_is_added_is_written_to_a_model(change, tmp_path):
    given, path = tmp_path / "given.amxmi", tmp_path / "changed.amxmi"
    save(build_model(SYSTEM), given)
    write_changed([given], [parse_change(change)], Settings(), path)
    assert extract(load(path)).system == apply(extract(load(given)).system, Settings(), [parse_change(change)]).system


def test_a_rate_without_a_bound_is_stated_as_the_least_distance():
    # At 1 MHz each job takes 10 us: with 1 s between two of them, B waits for one of A, and A for none.
    system = of_parts(
        [task("A", "pulses"), task("B", "tick")],
        [TaskAllocation(task="A", scheduler="core", priority=2), TaskAllocation(task="B", scheduler="core", priority=1)],
        [Custom(name="pulses", description="by hand"), Periodic(name="tick", period=MS)],
        policy=Policy.FIXED_PRIORITY_PREEMPTIVE,
    )
    assert proposed(system) == ({"pulses.min_distance"}, ("A", "B"))
    after = analyze_system(*apply(system, Settings(), [parse_change("pulses.min_distance=1s")]))
    assert [after[name].wcrt * 1000 // MS for name in "AB"] == [10, 20]


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (Uniform(lower=0, upper=5 * MS), Boundaries(lower=2 * MS, upper=5 * MS)),
        (Uniform(lower=0, upper=MS), Constant(2 * MS)),
    ],
)
def test_a_least_distance_keeps_the_greatest_one_if_that_is_not_less(before, after):
    system = of_parts([task("A", "pulses")], [], [RelativePeriodic(name="pulses", distance=before, has_maximum=True)])
    changed = apply(system, Settings(), [parse_change("pulses.min_distance=2ms")]).system.stimuli_by_name["pulses"]
    assert changed.distance == after
    # Nobody said that what is farther apart than before does not come.
    assert changed.has_maximum == (after.upper == before.upper if isinstance(after, Boundaries) else False)


def test_a_distribution_without_a_least_value_is_replaced_too():
    # Its greatest value alone bounds nothing: the least one decides what else can execute meanwhile.
    unbounded = replace(task("B", "tick"), activities=(Execute(demand=Demand(Gauss(mean=5.0, deviation=1.0, upper=10))),))
    system = of_parts(
        [task("A", "tick"), unbounded],
        [TaskAllocation(task="A", scheduler="core", priority=1), TaskAllocation(task="B", scheduler="core", priority=2)],
        [Periodic(name="tick", period=10 * MS)],
        policy=Policy.FIXED_PRIORITY_PREEMPTIVE,
    )
    assert proposed(system) == ({"B.execution_time"}, ("A", "B"))


def test_a_policy_without_a_meaning_and_time_slices_are_stated():
    # Of two tasks of 10 us with slices of 1 s, each waits for one job of the other one: 20 us; the policy decides which are stated.
    for policy, stated in (
        ("UserSpecificSchedulingAlgorithm", {"core.policy"}),
        (Policy.PRIORITY_BASED_ROUND_ROBIN, {"core.time_slice"}),
    ):
        system = of_parts(
            [task("A", "tick"), task("B", "tick")],
            [TaskAllocation(task=name, scheduler="core", priority=1) for name in "AB"],
            [Periodic(name="tick", period=MS)],
            policy=policy,
        )
        assert proposed(system) == (stated, ("A", "B"))
        changes = missing_values_of(system).changes
        after = analyze_system(*apply(system, Settings(), changes))
        assert {process.wcrt for process in after.processes} == {20 * MS // 1000}


def test_a_stimulus_with_the_name_of_a_process_is_proposed_for_it():
    system = of_parts(
        [task("A"), task("B")],
        [TaskAllocation(task=name, scheduler="core", priority=number) for number, name in enumerate("AB")],
        [Periodic(name=f"activates_{name}", period=MS) for name in "XBA"],
        policy=Policy.FIXED_PRIORITY_PREEMPTIVE,
    )
    found = missing_values_of(system)
    assert [str(change) for change in found.changes] == ["A.stimulus=activates_A", "B.stimulus=activates_B"]


#: As it is imported: nobody stated how long the network and the agent take.
DESCRIBED = """
amuros: 1
name: imported
hardware: {platform: generic, frequency: 160 MHz}
middleware:
  executor: {name: executor, max_handles: 2, loop: {spin_some: 10 ms, sleep: 5 ms}, execution_time: {base: 50 us}}
  transport: {udp: {bitrate: 10 Mbit/s}}
application:
  nodes:
    - name: robot
      publishers: [{topic: speed, message_size: 4 B, reliability: best-effort}]
      subscriptions: [{name: On_Cmd, topic: cmd, message_size: 48 B, rate: 20 Hz, execution_time: 80 us}]
      timers: [{name: On_Timer, period: 50 ms, execution_time: 100 us, publishes: [speed]}]
"""


def test_the_times_of_a_network_and_of_an_agent_are_values_of_a_description(tmp_path):
    (tmp_path / "app.yaml").write_text(DESCRIBED)
    found = analyze_files([tmp_path / "app.yaml"], with_missing=True)
    assert all(handle.response.worst is None for executor in found.analysis.executors for handle in executor.handles)
    assert {each.target for each in found.missing.changes} == {"udp.latency", "Agent.to_controller"}
    stated = analyze_files([tmp_path / "app.yaml"], changes=found.missing.changes, with_missing=True)
    assert all(handle.response.worst for executor in stated.analysis.executors for handle in executor.handles)
    assert stated.missing is None


def test_an_interrupt_without_a_controller_is_given_a_core(tmp_path):
    isr = Isr(name="I", stimuli=("tick",), activities=(ticks(1),))
    system = replace(SYSTEM, software=replace(SYSTEM.software, tasks=SYSTEM.software.tasks[:1], isrs=(isr,)))
    system = replace(system, mapping=replace(system.mapping, tasks=system.mapping.tasks[:1]))
    # As long as nobody knows where it is executed, it may delay A.
    assert proposed(system) == ({"I.core"}, ("A", "I"))
    write_changed(build_model(system), missing_values_of(system).changes, Settings(), tmp_path / "new.amxmi")
    assert [each.cores for each in extract(load(tmp_path / "new.amxmi")).system.interrupt_controllers.values()] == [("core",)]
