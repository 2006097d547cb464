"""Executors of the host in simulations: by hand, against a player that knows nothing of the product, and against bounds."""

import re
from dataclasses import replace
from random import Random

import pytest
from effort import every
from played_groups import Executor
from played_groups import play as play_groups
from played_host import Callback, Thread, play
from random_hosts import KINDS, multi_threaded_system_of, random_groups, random_threads, system_of
from support import ROOT

from amalthea_uros import analyze
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.host import (
    Host,
    HostCallback,
    HostComputer,
    HostExecutor,
    HostExecutorKind,
    HostPolicy,
    HostThread,
    RosRelease,
)
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import SECOND, Duration
from amalthea_uros.uros.described import describe_text

ROBOT = re.search(r'```yaml title="robot.yaml"\n(.*?)```', (ROOT / "docs" / "ros2-host.md").read_text(), re.DOTALL)[1]
SAMPLE = (ROOT / "samples" / "robot-with-host.yaml").read_text()


class Fixed:
    """Always the first possibility."""

    def sample(self, items, _count):
        return list(items)

    def choice(self, items):
        return items[0]

    def randint(self, first, _last):
        return first


def observed(system, duration, **options):
    """The callbacks of the simulated host by name."""
    found = simulate_system(system, Options(duration=Duration(duration), **options))
    assert not found.errors
    return {handle.name: handle for handle in callbacks_of(found)}


def callbacks_of(simulation):
    return [handle for executor in simulation.host for handle in executor.handles]


def timers(kind, rules, release=RosRelease.FOXY, **executor):
    """An executor of timers: name, period, execution time and, if there are several, group."""
    callbacks = tuple(
        HostCallback(
            name=name, kind=HandleKind.TIMER, period=period, execution=Span(least=time, most=time), group="".join(group)
        )
        for name, period, time, *group in rules
    )
    thread = {"name": "E", "thread": HostThread(policy=HostPolicy.FIFO, priority=1)}
    found = HostExecutor(computer="pc", kind=kind, callbacks=callbacks, **thread | executor)
    return System(host=Host(release=release, computers=(HostComputer(name="pc", cores=2),), executors=(found,)))


def test_a_late_timer_skips_periods_but_in_an_events_executor():
    """At 10, both are due. After Slow, at 45, the timer is 35 late: it leaves out those of 20, 30 and 40, or queues four events."""
    rules = [("Slow", 100, 35), ("Fast", 10, 1)]
    skipped = observed(timers(HostExecutorKind.SINGLE_THREADED, rules), 137, mode=SimulationMode.WORST)
    # Until 100, it is called 9 times in time, then for 100 after Slow at 135, instead of those of 110, 120 and 130.
    assert (skipped["Fast"].calls, skipped["Fast"].lost, skipped["Fast"].response_time.max) == (10, 3, 36)
    queued = observed(timers(HostExecutorKind.EVENTS, rules), 139, mode=SimulationMode.WORST)
    # The events of 110, 120 and 130 wait, and are worked off at 137, 138 and 139, which is not observed any more.
    assert (queued["Fast"].calls, queued["Fast"].lost, queued["Fast"].response_time.max) == (12, 0, 36)


@pytest.mark.parametrize(("group", "calls"), [("g", 0), ("h", 9)])
def test_a_member_of_a_group_can_starve_in_two_threads(group, calls):
    """Whenever the executor polls, another member of its group is running (H. Teper et al. 2024); not in a group of its own."""
    rules = [("A", 1000, 500, "a"), ("B", 1000, 500, "b"), ("C", 1000, 500, "g"), ("D", 1000, 10, group)]
    found = observed(timers(HostExecutorKind.MULTI_THREADED, rules, threads=2), 9900, mode=SimulationMode.WORST)
    assert found["D"].calls == calls
    assert found["C"].response_time.max == 1000


def reserved(rules, budget, period, name="E"):
    """An executor of timers in a reservation on core 0."""
    thread = HostThread(policy=HostPolicy.DEADLINE, budget=budget, period=period, cores=(0,))
    return timers(HostExecutorKind.SINGLE_THREADED, rules, thread=thread, name=name)


def test_reservations_are_served_by_their_deadlines_and_before_priorities():
    """At 100, B with the earlier deadline has 8, A 10 until 118, and then nothing until 140 and 180; F takes the rest."""
    fifo = HostThread(policy=HostPolicy.FIFO, priority=99, cores=(0,))
    alone = timers(HostExecutorKind.SINGLE_THREADED, [("F", 100, 30)], thread=fifo, name="fifo")
    parts = [reserved([("A", 100, 25)], 10, 40, "a"), reserved([("B", 100, 8)], 8, 20, "b"), alone]
    executors = tuple(each for part in parts for each in part.host.executors)
    system = replace(alone, host=replace(alone.host, executors=executors))
    found = observed(system, 199, mode=SimulationMode.WORST)
    assert {name: each.response_time.max for name, each in found.items()} == {"A": 185 - 100, "B": 8, "F": 158 - 100}


def test_a_reservation_that_wakes_up_soon_has_the_rest_of_its_budget():
    """At 130, 2 are left until the deadline at 140, which is less than 10 for each 40 (CBS); the other 4 of B wait for 140."""
    found = observed(reserved([("A", 100, 8), ("B", 130, 6)], 10, 40), 395, mode=SimulationMode.WORST)
    assert {name: each.response_time.max for name, each in found.items()} == {"A": 8, "B": 144 - 130}


@pytest.mark.parametrize("seed", every(4, range(60)))
def test_nothing_in_a_reservation_exceeds_its_bound(seed):
    random = Random(f"reserved {seed}")
    threads, sources, paths = random_threads(random, random.choice(list(KINDS)))
    system, share = system_of(threads, sources, paths), 90 // len(threads)
    executors = []
    for each in system.host.executors:
        period = random.choice([5, 10, 20])
        thread = HostThread(policy=HostPolicy.DEADLINE, budget=max(1, period * share // 100), period=period, cores=(0,))
        executors.append(replace(each, thread=thread))
    system = replace(system, host=replace(system.host, executors=tuple(executors)))
    analysis, simulation = analyze_system(system), simulate_system(system, Options(duration=Duration(5000), seed=seed))
    bounds = {handle.name: handle.response.worst for executor in analysis.host for handle in executor.handles}
    assert any(each.calls for each in callbacks_of(simulation))
    for handle in callbacks_of(simulation):
        assert bounds[handle.name] is None or not handle.calls or handle.response_time.max <= bounds[handle.name], handle.name


def test_the_only_thread_of_sched_other_of_an_isolated_core_runs_if_none_of_sched_fifo_does():
    """On_Log of up to 1 ms waits for the executor of SCHED_FIFO on its core."""
    isolated = ROBOT.replace("cores: 4}", "cores: 4, isolated: [0]}").replace(
        "{policy: fifo, priority: 20, core: 0}", "{core: 0}"
    )
    found = observed(describe_text(isolated).assembly.system, 10 * SECOND)
    fifo = observed(describe_text(ROBOT).assembly.system, 10 * SECOND)
    assert found["On_Log"].response_time == fifo["On_Log"].response_time


def test_a_chain_is_followed_through_calls_that_overlap():
    """A callback that is called again while it runs publishes for each call what this very call was for."""
    head, *others = (Callback(name, cost, cost) for name, cost in (("A", 10), ("B", 150), ("C", 1)))
    head.period = 100
    for each, (before, topic) in zip(others, ((head, "b"), (others[0], "c")), strict=True):
        each.topic, before.sends[topic] = topic, 0
    callbacks = [head, *others]
    system = multi_threaded_system_of(callbacks, dict.fromkeys("ABC", ""), {}, [["A", "B", "C"]], 3, RosRelease.FOXY)
    (chain,) = simulate_system(system, Options(duration=Duration(2050), mode=SimulationMode.WORST)).chains
    latencies = chain.quantities[ChainQuantity.LAST_TO_LAST]
    # From the start of A to the end of C; the first A is due at 100, and the last C ends at 1900 + 161.
    assert (latencies.min, latencies.max) == (10 + 150 + 1, 10 + 150 + 1)
    assert chain.quantities[ChainQuantity.DATA_AGE].max == 161 + 100


def test_a_static_executor_of_jazzy_starves_what_comes_last():
    """It calls one callback for each wait, and the first one is always due again."""
    rules = [("Fast", 10, 10), ("Slow", 100, 1)]
    late, before = (
        observed(timers(HostExecutorKind.STATIC, rules, release), 995, mode=SimulationMode.WORST)["Slow"].calls
        for release in (RosRelease.JAZZY, RosRelease.IRON)
    )
    assert (late, before) == (0, 9)


@pytest.mark.early
def test_machine_code_has_the_same_results(monkeypatch):
    results = []
    for is_compiled in (False, True):
        monkeypatch.setattr(machine_code, "is_worth_it", lambda *_, is_compiled=is_compiled: is_compiled)
        found = [simulate_system(describe_text(ROBOT).assembly.system, Options(duration=Duration(10 * SECOND)))]
        for kind in KINDS:
            found.append(
                simulate_system(system_of(*random_threads(Random(f"{kind} 7"), kind)), Options(duration=Duration(5000)))
            )
        found.append(simulate_system(reserved([("A", 100, 8), ("B", 130, 6)], 10, 40), Options(duration=Duration(5000))))
        results.append([(each.processes, each.host, each.chains) for each in found])
    assert results[0] == results[1]


@pytest.mark.parametrize(("text", "seed"), [(ROBOT, 1), (ROBOT, 2), (SAMPLE, 1)], ids=["robot-1", "robot-2", "sample"])
def test_a_robot_with_its_host_is_within_its_bounds(text, seed):
    analysis = analyze(text)
    simulation = simulate_system(describe_text(text).assembly.system, Options(duration=Duration(20 * SECOND), seed=seed))
    for bounds, seen in ((analysis.executors, simulation.executors), (analysis.host, simulation.host)):
        for handle in (handle for executor in seen for handle in executor.handles):
            bound = next(each.handles[handle.name] for each in bounds if handle.name in each.handles.names)
            assert handle.calls > 100
            assert handle.response_time.max <= bound.response.worst
    for chain in simulation.chains:
        # Each message of the controller comes back, and each image is looked at.
        assert chain.observations > 190
        assert chain.quantities[ChainQuantity.REDUCED_REACTION_TIME].max <= analysis.chains[chain.name].worst


def test_several_publishers_of_the_host_send_what_the_controller_gets():
    """Watch publishes every 20 ms, and On_Odom every 100 ms: up to 60 messages in a second instead of the 10 that are stated."""
    text = ROBOT.replace("max: 3 ms}}", "max: 3 ms}, publishes: [cmd_vel]}")
    (spin,) = simulate_system(describe_text(text).assembly.system, Options(duration=Duration(10 * SECOND))).executors
    assert 550 < spin.handles["On_Cmd"].calls + spin.handles["On_Cmd"].lost <= 600


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("policy: fifo, priority: 80, core: 0", "core: 0", "the policy 'other'"),
        ("policy: fifo, priority: 20, core: 0", "policy: deadline, budget: 2 ms, period: 10 ms", "the reservation of 'log'"),
        (
            "log, thread: {policy: fifo, priority: 20,",
            "log, type: multi-threaded, threads: 2, thread: {policy: deadline, budget: 2 ms, period: 10 ms,",
            "the reservations of the multi-threaded executor 'log'",
        ),
        ("  latency: {min: 50 us, max: 400 us}\n", "", "the latency of the topic 'odom'"),
        ("topic: odom, depth", "topic: scan, depth", "publishes 'scan'"),
    ],
)
def test_a_host_is_left_out_with_its_reason(old, new, reason):
    """Then messages come as the controller states."""
    simulation = simulate_system(describe_text(ROBOT.replace(old, new)).assembly.system, Options(duration=Duration(1 * SECOND)))
    assert not simulation.host
    assert any("the host is not simulated" in each and reason in each for each in simulation.assumptions)
    assert 9 <= simulation.executors[0].handles["On_Cmd"].calls <= 11
    assert "host" in simulation.chains[0].reason
    assert not simulation.chains[0].observations


def test_the_host_is_left_out_with_what_sends_to_it():
    """It is unknown how long the controller waits for acknowledgements; without it, no odometry would come."""
    text = ROBOT.replace(", acknowledgement: {min: 0.2 ms, max: 2 ms}", "").replace("best-effort}]", "reliable}]")
    simulation = simulate_system(describe_text(text).assembly.system, Options(duration=Duration(1 * SECOND)))
    assert "Spin" in {each.name for each in simulation.left_out}
    assert any("'host/control' is not simulated: depends on 'Spin'" in each for each in simulation.errors)
    assert not simulation.host


SEEDS = every(4, [(kind, seed) for kind in KINDS for seed in range(120)])


@pytest.mark.parametrize(("kind", "seed"), SEEDS)
def test_a_simulation_is_the_schedule_of_the_player(kind, seed):
    """With the longest execution times, no jitter, and callbacks of a kind in the order of registration."""
    threads, sources, paths = random_threads(Random(f"{kind} {seed}"), kind)
    sources = {topic: (period, 0) for topic, (period, _) in sources.items()}
    found = observed(system_of(threads, sources, paths), 1501, mode=SimulationMode.WORST)
    fresh = [Thread(each.kind, each.priority, each.callbacks) for each in threads]
    for thread in fresh:
        thread.due = {each.name: each.period for each in thread.callbacks if each.period}
    own, _ = play(fresh, {topic: range(0, 1501, period) for topic, (period, _) in sources.items()}, 1500, Fixed())
    assert {name: handle.response_time.max for name, handle in found.items() if handle.calls} == own


@pytest.mark.parametrize("seed", every(8, range(120)))
def test_a_simulation_of_several_threads_is_the_schedule_of_the_player(seed):
    callbacks, groups, sources, paths, threads = random_groups(Random(f"groups {seed}"))
    sources = {topic: (period, 0) for topic, (period, _) in sources.items()}
    system = multi_threaded_system_of(callbacks, groups, sources, paths, threads, RosRelease.FOXY)
    simulation = simulate_system(system, Options(duration=Duration(1501), mode=SimulationMode.WORST))
    due = {each.name: each.period for each in callbacks if each.period}
    outside = {topic: range(0, 1501, period) for topic, (period, _) in sources.items()}
    own, whole = play_groups(Executor(callbacks, groups, threads, False, due), outside, 1501, Fixed())
    assert {each.name: each.response_time.max for each in callbacks_of(simulation) if each.calls} == own
    for chain, path in zip(simulation.chains, paths, strict=True):
        latency = chain.quantities.get(ChainQuantity.LAST_TO_LAST)
        # The player counts from the release of the first callback, which may wait before it starts.
        waiting = own[path[0]] - next(each.worst for each in callbacks if each.name == path[0])
        assert latency is None or whole[path[-1]] - waiting <= latency.max <= whole[path[-1]], chain.name


@pytest.mark.parametrize(("kind", "seed"), SEEDS)
def test_nothing_that_is_simulated_exceeds_a_bound(kind, seed):
    threads, sources, paths = random_threads(Random(f"{kind} {seed}"), kind)
    system = system_of(threads, sources, paths)
    analysis, simulation = analyze_system(system), simulate_system(system, Options(duration=Duration(5000), seed=seed))
    bounds = {handle.name: handle.response.worst for executor in analysis.host for handle in executor.handles}
    for handle in callbacks_of(simulation):
        assert bounds[handle.name] is None or not handle.calls or handle.response_time.max <= bounds[handle.name], handle.name
    for chain in simulation.chains:
        bound, lost = analysis.chains[chain.name].worst_if_not_lost, sum(each.lost for each in callbacks_of(simulation))
        assert chain.observations, chain.reason
        assert bound is None or lost or chain.quantities[ChainQuantity.REDUCED_REACTION_TIME].max <= bound, chain.name
