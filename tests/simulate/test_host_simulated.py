"""Executors of the host in simulations: by hand, against a player that knows nothing of the product, and against bounds."""

import re
from random import Random

import pytest
from effort import every
from played_host import Thread, play
from random_hosts import KINDS, random_threads, system_of
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
from amalthea_uros.units import SECOND
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
    found = simulate_system(system, Options(duration=duration, **options))
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
    thread = HostThread(policy=HostPolicy.FIFO, priority=1)
    found = HostExecutor(name="E", computer="pc", kind=kind, thread=thread, callbacks=callbacks, **executor)
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
        found = [simulate_system(describe_text(ROBOT).assembly.system, Options(duration=10 * SECOND))]
        for kind in KINDS:
            found.append(simulate_system(system_of(*random_threads(Random(f"{kind} 7"), kind)), Options(duration=5000)))
        results.append([(each.processes, each.host, each.chains) for each in found])
    assert results[0] == results[1]


@pytest.mark.parametrize(("text", "seed"), [(ROBOT, 1), (ROBOT, 2), (SAMPLE, 1)], ids=["robot-1", "robot-2", "sample"])
def test_a_robot_with_its_host_is_within_its_bounds(text, seed):
    analysis = analyze(text)
    simulation = simulate_system(describe_text(text).assembly.system, Options(duration=20 * SECOND, seed=seed))
    for bounds, seen in ((analysis.executors, simulation.executors), (analysis.host, simulation.host)):
        for handle in (handle for executor in seen for handle in executor.handles):
            bound = next(each.handles[handle.name] for each in bounds if handle.name in each.handles.names)
            assert handle.calls > 100
            assert handle.response_time.max <= bound.response.worst
    chain, *others = simulation.chains
    # Each message of the controller comes back.
    assert chain.observations > 190
    assert chain.quantities[ChainQuantity.REDUCED_REACTION_TIME].max <= analysis.chains[chain.name].worst
    assert all("several threads" in other.reason for other in others)


def test_several_publishers_of_the_host_send_what_the_controller_gets():
    """Watch publishes every 20 ms, and On_Odom every 100 ms: up to 60 messages in a second instead of the 10 that are stated."""
    text = ROBOT.replace("max: 3 ms}}", "max: 3 ms}, publishes: [cmd_vel]}")
    (spin,) = simulate_system(describe_text(text).assembly.system, Options(duration=10 * SECOND)).executors
    assert 550 < spin.handles["On_Cmd"].calls + spin.handles["On_Cmd"].lost <= 600


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("policy: fifo, priority: 80, core: 0", "core: 0", "the policy 'other'"),
        ("policy: fifo, priority: 20, core: 0", "policy: deadline, budget: 2 ms, period: 10 ms", "the reservation of 'log'"),
        ("  latency: {min: 50 us, max: 400 us}\n", "", "the latency of the topic 'odom'"),
        ("topic: odom, depth", "topic: scan, depth", "publishes 'scan'"),
    ],
)
def test_a_host_is_left_out_with_its_reason(old, new, reason):
    """Then messages come as the controller states."""
    simulation = simulate_system(describe_text(ROBOT.replace(old, new)).assembly.system, Options(duration=1 * SECOND))
    assert not simulation.host
    assert any("the host is not simulated" in each and reason in each for each in simulation.assumptions)
    assert 9 <= simulation.executors[0].handles["On_Cmd"].calls <= 11
    assert "host" in simulation.chains[0].reason
    assert not simulation.chains[0].observations


def test_the_host_is_left_out_with_what_sends_to_it():
    """It is unknown how long the controller waits for acknowledgements; without it, no odometry would come."""
    text = ROBOT.replace(", acknowledgement: {min: 0.2 ms, max: 2 ms}", "").replace("best-effort}]", "reliable}]")
    simulation = simulate_system(describe_text(text).assembly.system, Options(duration=1 * SECOND))
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


@pytest.mark.parametrize(("kind", "seed"), SEEDS)
def test_nothing_that_is_simulated_exceeds_a_bound(kind, seed):
    threads, sources, paths = random_threads(Random(f"{kind} {seed}"), kind)
    system = system_of(threads, sources, paths)
    analysis, simulation = analyze_system(system), simulate_system(system, Options(duration=5000, seed=seed))
    bounds = {handle.name: handle.response.worst for executor in analysis.host for handle in executor.handles}
    for handle in callbacks_of(simulation):
        assert bounds[handle.name] is None or not handle.calls or handle.response_time.max <= bounds[handle.name], handle.name
    for chain in simulation.chains:
        bound, lost = analysis.chains[chain.name].worst_if_not_lost, sum(each.lost for each in callbacks_of(simulation))
        assert chain.observations, chain.reason
        assert bound is None or lost or chain.quantities[ChainQuantity.REDUCED_REACTION_TIME].max <= bound, chain.name
