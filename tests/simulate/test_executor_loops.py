"""Executors that loop: their bounds, and single rules by hand; `opponent.test_executors` compares each call with that of a player."""

import random
from dataclasses import replace

import pytest
import test_whole_way
from effort import IS_THOROUGH
from hand_made_systems import WRITE, Proc, ticks
from looping_executors import SPIN, US, WaitBehaviour, guard, looping, message, timer, waiting_publication
from support import ROOT

from amalthea_uros import simulate
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.executors.semantics.steps import with_steps
from amalthea_uros.perf.activities import Call, Communication, Group, LabelAccess
from amalthea_uros.perf.executors import LoopKind, TriggerCondition, TriggerKind
from amalthea_uros.perf.software import Runnable
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND, Duration
from amalthea_uros.uros.described import describe_content, describe_text

BLOCK = 20
#: Analyses take longer.
BOUNDED = range(500 if IS_THOROUGH else 8)


@pytest.mark.parametrize("block", range(0, len(BOUNDED), BLOCK))
def test_nothing_that_is_observed_exceeds_a_bound(block):
    for seed in BOUNDED[block : block + BLOCK]:
        content, _ = test_whole_way.drawn(random.Random(seed))
        system = describe_content(content).assembly.system
        analysis, simulation = (
            analyze_system(system),
            simulate_system(system, Options(duration=Duration(SECOND // 4), seed=seed)),
        )
        for bounded, observed in zip(analysis.executors, simulation.executors, strict=True):
            for handle in observed.handles:
                bound, seen = bounded.handles[handle.name], handle.response_time
                if seen is None:
                    continue
                assert seen.min >= bound.response.best - 20, (seed, handle.name)
                assert bound.response.worst is None or seen.max <= bound.response.worst + 20, (seed, handle.name)
                assert not handle.lost or bound.lost is not None or bound.response.worst is None, (seed, handle.name)
        for chain in simulation.chains:
            reaction, bound = chain.quantities.get(ChainQuantity.REDUCED_REACTION_TIME), analysis.chains[chain.name]
            if reaction is not None and bound.worst is not None:
                assert bound.best - 20 <= reaction.min, (seed, chain.name)
                assert reaction.max <= bound.worst + 20, (seed, chain.name)


# Single rules of ros2/rclc and micro-ROS/rmw_microxrcedds, by hand; the ECU has 1 MHz.


def simulated(*handles, duration=SECOND, **parts):
    (executor,) = simulate_system(
        looping(*handles, **parts), Options(duration=Duration(duration), mode=SimulationMode.BEST)
    ).executors
    return executor


def test_a_timer_of_a_bare_loop_is_polled_for_in_the_last_millisecond():
    """The wait is cut to whole milliseconds, so that rounds of 100 us follow each other until the timer is due."""
    control = simulated(timer("control", 10_000, 500), loop=SPIN, spin=100, waiting=WaitBehaviour(polls_without_messages=False))
    lateness = control.handles["control"].lateness
    assert 0 <= lateness.min <= lateness.max < 200 * US


def test_one_message_is_taken_in_each_iteration():
    """Messages every 20 ms, iterations every 100 ms and more: the others wait, longer and longer."""
    executor = simulated(message("cmd", 20_000, 100, depth=100), spin=10)
    handle = executor.handles["cmd"]
    assert handle.calls == executor.iterations
    assert handle.response_time.max > 700 * MS


def test_an_executor_whose_publications_wait_for_an_unknown_time_is_left_out():
    handle = timer("control", 100_000, 10, publications=(waiting_publication(timeout=50 * MS),))
    (left_out,) = simulate_system(looping(handle, loop=SPIN, spin=10), Options(duration=Duration(SECOND))).left_out
    assert "how long the publication of 'odom' waits" in left_out.reason


@pytest.mark.parametrize(
    ("kind", "called"),
    [(TriggerKind.ANY, (100, 10)), (TriggerKind.ALL, (10, 10)), (TriggerKind.ALWAYS, (100, 10))],
)
def test_a_trigger_condition_keeps_calls_back(kind, called):
    """Of a message every 10 ms and a timer every 100 ms, the trigger `all` calls both ten times in a second."""
    executor = simulated(
        message("cmd", 10_000, 10, phase=MS, depth=1),
        timer("control", 100_000, 10, phase=50 * MS),
        loop=SPIN,
        spin=100,
        trigger=TriggerCondition(kind=kind),
    )
    assert tuple(handle.calls for handle in executor.handles) == pytest.approx(called, abs=1)


def test_a_guard_condition_does_not_end_the_wait():
    """The wait of 100 ms ends for the message every 100 ms; the guard condition is seen then."""
    executor = simulated(
        guard("stop", 30_000, 10, phase=MS), message("cmd", 100_000, 10, phase=50 * MS, depth=1), loop=SPIN, spin=10
    )
    stop = executor.handles["stop"]
    assert stop.calls == pytest.approx(10, abs=1)
    assert stop.lost > 15
    assert stop.response_time.max > 50 * MS


def test_the_round_trip_of_a_default_reliable_publisher(tmp_path):
    """A message goes through agent, USB, an executor that publishes and waits, and back.

    The mean is the sum of the means of its parts, in ms: from the host 0.65 and on USB 0.09 + 0.5, the executor 0.05, the callback with
    its driver 1.3 + 0.29 + 0.25, on USB 0.25 + 0.5, to the host 0.65; and the minimum at least that of their minima.
    """
    path = tmp_path / "p.yaml"
    path.write_text(ROUND_TRIP)
    simulation = simulate(path, "5 s")
    reaction = simulation.chains["rtt"].quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert float(reaction.mean) / MS == pytest.approx(4.53, abs=0.15)
    assert reaction.min > 2.101 * MS
    (handle,) = simulation.executors["executor"].handles
    assert (handle.calls, handle.lost) == (pytest.approx(500, abs=1), 0)


ROUND_TRIP = """
amuros: 1
name: p
hardware: {platform: rp2040, frequency: 150 MHz}
middleware:
  executor:
    {name: executor, max_handles: 1, loop: {spin_some: 100 ms}, execution_time: {base: 30 us, per_message: 20 us}}
  transport: {usb_cdc: {latency: {min: 0 ms, max: 1 ms}}}
  agent: {to_controller: {min: 0.3 ms, max: 1 ms}, to_host: {min: 0.3 ms, max: 1 ms}, acknowledgement: {min: 0.3 ms, max: 2 ms}}
application:
  nodes:
    - name: n
      publishers: [{topic: v, message_size: 77 B, reliability: reliable}]
      subscriptions:
        - {name: cb, topic: r, message_size: 8 B, rate: 100 Hz, execution_time: {min: 1.2 ms, max: 1.4 ms}, publishes: [v]}
chains: [{name: rtt, path: [/r, cb, /v]}]
"""


@pytest.mark.early
@pytest.mark.parametrize("sample", ["robot-xrce", "robot-zenoh", "esp32-serial", "two-controllers-drive"])
def test_machine_code_executes_loops_alike(sample, monkeypatch):
    from amalthea_uros.services.subject import open_system
    from amalthea_uros.simulate.kernel import machine_code

    pytest.importorskip("numba")
    system, options = (
        open_system([ROOT / "samples" / f"{sample}.yaml"]).system,
        Options(duration=Duration(2 * SECOND), traced=(0, Duration(SECOND))),
    )
    results = []
    for is_compiled in (False, True):
        monkeypatch.setattr(machine_code, "is_worth_it", lambda *_, is_compiled=is_compiled: is_compiled)
        results.append(simulate_system(system, options))
    assert results[0] == results[1]


def test_nothing_is_compiled_where_the_machine_code_is_kept():
    from amalthea_uros.simulate.kernel import machine_code

    event = pytest.importorskip("numba.core.event")
    machine_code.compiled()
    with event.install_recorder("numba:compile") as recorder:
        machine_code.compiled.__wrapped__()
    assert recorder.buffer == []


def test_a_part_of_the_kernel_is_compiled_once_for_all_constants():
    numba = pytest.importorskip("numba")
    from amalthea_uros._internal.linked_parts import linked_part

    def add(first, second):
        return first + second

    part = linked_part(add)
    assert numba.njit(lambda number: part(number, 1) + part(number, 2) + part(3, number))(5) == 21
    assert part.signatures == [(numba.int64, numba.int64)]


@pytest.mark.parametrize(
    "sample", ["robot-xrce", "robot-zenoh", "esp32-serial", "stm32-usb-cdc", "two-controllers-drive", "two-controllers-lift"]
)
def test_all_chains_of_the_samples_are_followed(sample):
    simulation = simulate(ROOT / "samples" / f"{sample}.yaml", "500 ms")
    assert {chain.name: chain.reason for chain in simulation.chains if chain.reason or not chain.observations} == {}
    assert not simulation.left_out


POLLING = """
amuros: 1
name: polling
hardware: {platform: single-core, frequency: 1 GHz}
middleware:
  executor: {name: main, loop: {spin: 1 s}, semantics: SEMANTICS, trigger: TRIGGER, execution_time: 100 us}
  transport: {custom: {table: [{size: 512 B, time: 1 ms}]}}
application:
  nodes: [{name: n, timers: [{name: control, period: 10 ms, execution_time: 500 us, phase: 0 ms}]}]
"""


@pytest.mark.parametrize("semantics", ["ROS", "LET"])
@pytest.mark.parametrize("trigger", ["any", "{one: control}", "all"])
def test_polling_before_a_timer_is_iterations_of_its_executor(semantics, trigger):
    """With timers only, waits return at once: in each 10 ms, a call of 500 us, and iterations of 100 us all the time."""
    system = describe_text(POLLING.replace("SEMANTICS", semantics).replace("TRIGGER", trigger)).assembly.system
    for mode in (SimulationMode.WORST, SimulationMode.SAMPLED):
        simulation = simulate_system(system, Options(duration=Duration(100 * MS), mode=mode))
        (executor,) = simulation.executors
        assert executor.iterations == pytest.approx(10 * 95, abs=10)
        assert simulation["main"].response_time.max == 600 * US


def test_the_operating_system_activates_each_iteration_once():
    """Also if that takes an interrupt: 10 us for each iteration of 100 us, beside a call of 500 us in each 10 ms."""
    os = "os: {overhead: {activation: 10 us, activations_run_in: interrupt}}"
    text = POLLING.replace("SEMANTICS", "ROS").replace("TRIGGER", "any").replace("middleware:", f"{os}\nmiddleware:", 1)
    simulation = simulate_system(
        describe_text(text).assembly.system, Options(duration=Duration(100 * MS), mode=SimulationMode.WORST)
    )
    (executor,) = simulation.executors
    assert simulation["main_Activation"].jobs == pytest.approx(executor.iterations, abs=1)
    assert executor.iterations == pytest.approx(10 * (10_000 - 500) / 110, abs=5)


# Nothing that is unknown is taken to be harmless.

LEFT_OUT = {
    "agent": ("  agent:", "when 'r_topic_to_cb' is sent"),
    "acknowledgement": (", acknowledgement: {min: 0.3 ms, max: 2 ms}", "how long the publication of 'v' waits"),
    "polls of the host": ("{latency: {min: 0 ms, max: 1 ms}}", "how long 'r_topic_to_cb' takes besides the wire"),
}


def without(text, part):
    """A text without a part; without the lines that begin with it if it is a key of the middleware."""
    if part.startswith("  "):
        return "\n".join(line for line in text.splitlines() if not line.startswith(part))
    assert part in text
    return text.replace(part, "")


@pytest.mark.parametrize("case", LEFT_OUT)
def test_an_executor_of_which_something_is_unknown_is_left_out(case, tmp_path):
    part, reason = LEFT_OUT[case]
    path = tmp_path / "p.yaml"
    path.write_text(without(ROUND_TRIP, part).replace("usb_cdc: }", "usb_cdc: {}}"))
    simulation = simulate(path, "100 ms")
    assert reason in simulation.left_out["executor"].reason
    assert not simulation.executors
    assert all(chain.reason for chain in simulation.chains)
    assert simulation.errors


def test_a_chain_through_an_agent_of_unknown_time_is_not_followed(tmp_path):
    """Best effort does not wait for the agent, so that the executor is simulated, and not the chain that ends at the host."""
    path = tmp_path / "p.yaml"
    text = ROUND_TRIP.replace("rate: 100 Hz", "rate: 100 Hz, reliability: best-effort").replace(
        "reliability: reliable", "reliability: best-effort"
    )
    path.write_text(without(text, ", to_host: {min: 0.3 ms, max: 1 ms}"))
    simulation = simulate(path, "100 ms")
    assert simulation.executors["executor"].handles["cb"].calls
    assert "in the agent" in simulation.chains["rtt"].reason


def test_a_service_without_a_rate_makes_the_executor_unknown():
    (left_out,) = simulate_system(
        looping(message("cmd", None), timer("control", 10_000, 10), loop=SPIN, spin=10), Options(duration=Duration(SECOND))
    ).left_out
    assert "how often something arrives for 'cmd'" in left_out.reason


def test_who_waits_for_an_acknowledgement_outside_an_executor_is_left_out(tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text(ROUND_TRIP.replace("loop: {spin_some: 100 ms}", "period: 10 ms"))
    simulation = simulate(path, "100 ms")
    assert any("outside an executor with a loop" in each.reason for each in simulation.left_out)


def test_the_wait_of_an_iteration_is_no_job_that_is_late():
    """A run that ends in a wait of up to 1 s says nothing about a limit of the iterations."""
    found = looping(message("cmd", 400_000, 10, phase=MS, depth=1), loop=SPIN, spin=10)
    executor = simulate_system(found, Options(duration=Duration(SECOND), mode=SimulationMode.BEST))["Executor"]
    assert (executor.unfinished, executor.longest_unfinished) == (0, 0)


def test_a_guard_condition_that_ends_no_wait_disturbs_nobody():
    """It is triggered every 7 ms, while a task of lower priority executes half of the time."""
    below = Proc("below", (ticks(5000),), 10_000, priority=1)
    system = looping(
        guard("stop", 7000, phase=MS), message("cmd", 1_000_000, phase=2 * SECOND, depth=1), loop=SPIN, spin=10, others=(below,)
    )
    found = simulate_system(system, Options(duration=Duration(SECOND), mode=SimulationMode.BEST))
    assert found["below"].preemptions.total == 0


def test_a_depth_of_0_keeps_nothing():
    executor = simulated(message("cmd", 10_000, 10, depth=0), loop=SPIN, spin=10)
    assert (executor.handles["cmd"].calls, executor.handles["cmd"].lost) == (0, 100)


def test_a_timer_with_period_0_is_called_in_each_iteration_and_never_late():
    executor = simulated(timer("busy", 0, 500), loop=SPIN, spin=500, waiting=WaitBehaviour(polls_without_messages=False))
    assert executor.handles["busy"].calls == pytest.approx(1000, abs=1)
    assert executor.handles["busy"].response_time.max == 500 * US


def test_activities_around_the_iteration_are_executed():
    """A task that also executes 200 us by itself, before it spins."""
    found = looping(timer("control", 10_000, 300), loop=replace(SPIN, kind=LoopKind.SLEEPING, sleep=10 * MS), spin=100)
    (task,) = found.software.tasks
    busier = replace(task, activities=(Group(ordered=True, activities=(ticks(200),)), *task.activities))
    simulation = simulate_system(
        replace(found, software=replace(found.software, tasks=(busier,))),
        Options(duration=Duration(SECOND), mode=SimulationMode.BEST),
    )
    assert simulation["Executor"].response_time.max == 600 * US


def unstated(label):
    """A write of which it is not specified when it takes effect."""
    return LabelAccess(label=label, kind=WRITE)


def test_accesses_of_a_runnable_that_other_tasks_call_too_stay_as_they_are():
    shared = Runnable(name="log", activities=(unstated("entry"),))
    found = looping(timer("control", 10_000, 300), others=(Proc("other", (Call(runnable="log"),), 5000, priority=9),))
    control = next(each for each in found.software.runnables if each.name == "On_control")
    calling = replace(control, activities=(*control.activities, Call(runnable="log"), unstated("own")))
    others = [each for each in found.software.runnables if each is not control]
    stepped = with_steps(replace(found, software=replace(found.software, runnables=(*others, calling, shared))))
    communication = {name: stepped.runnables[name].activities[-1].communication for name in ("log", "On_control")}
    assert communication == {"log": None, "On_control": Communication.EXPLICIT}


SHARED_THREAD = """\
amuros: 1
name: shared
hardware: {platform: single-core, frequency: 1 GHz}
middleware:
  multithread: true
  transport: {serial: {baud_rate: 115200}}
  executors:
    - name: first
      priority: 50
      execution_time: 100 us
      loop: [{spin_some: 0 ms}, {spin_some: 0 ms, executor: second}, {sleep: 10 ms}]
    - {name: second, execution_time: 100 us}
application:
  nodes:
    - name: node
      timers:
        - {name: one, period: 10 ms, phase: 10 ms, execution_time: 2 ms, runs_in: first}
        - {name: two, period: 10 ms, phase: 10 ms, execution_time: 2 ms, runs_in: second}
tasks:
  - {name: equal, priority: 50, period: 7 ms, execution_time: 1 ms}
"""


def test_a_thread_keeps_its_turn_from_one_executor_to_the_next():
    """A task of equal priority waits for both executors if it becomes ready while the first one is busy: up to 4.2 ms."""
    system = describe_text(SHARED_THREAD).assembly.system
    simulation = simulate_system(system, Options(duration=Duration(SECOND), mode=SimulationMode.BEST))
    assert 4.5 * MS < simulation["equal"].response_time.max <= 5.2 * MS
