"""Bounds of published programs, to the last digit, and small examples computed by hand."""

import json
from dataclasses import replace
from itertools import pairwise

import pytest
from host_vectors import every_entry, host_of, paths, with_chains
from support import SHARED

from amalthea_uros.analyze.host import busy_window_aware, fifo, polled, polling_points
from amalthea_uros.analyze.host.reentrant import ReentrantChain, latencies
from amalthea_uros.analyze.host.starvation_free import ReadySet, improved
from amalthea_uros.analyze.host.topics import HostTopics
from amalthea_uros.analyze.host.windows import Windows
from amalthea_uros.analyze.response_times import non_preemptive
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.host import Host, HostCallback, HostComputer, HostExecutor, HostPolicy, HostThread, HostTopic
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import PeriodicEvents

FOLDER = SHARED / "vectors" / "ros2"
#: The methods that are used; the others of the vectors only hold for distributions that cannot be described, or are not used.
METHODS = ("ecrts19-polled", "rtss21-rr", "rtss21-rr-unordered", "rtss21-bw", "fifo", "np-fp", "rtss22-jiang")


def vectors():
    """The systems of which releases are known without an analysis: each callback has a source or a period of its own."""
    if not FOLDER.exists():
        return
    for path in sorted(FOLDER.glob("*.json")):
        for entry in json.loads(path.read_text())["systems"]:
            system, bounds = entry["system"], {name: entry["bounds"].get(name) for name in METHODS}
            executor = system["executors"][0]
            topics = {each["topic"] for each in system.get("sources", ())}
            is_flat = all(each["kind"] == "timer" or each["topic"] in topics for each in system["callbacks"])
            is_usual = executor["distro"] != "dashing" and len(system["executors"]) == 1
            if is_usual and any(bounds.values()) and (is_flat or bounds["rtss22-jiang"]):
                yield pytest.param(system, executor, entry, id=system["name"])


def task(callback, sources):
    source = next((each for each in sources if each["topic"] == callback.get("topic")), {})
    period = callback.get("period") or source["period"]
    demand = MultiframeDemand.constant(callback["wcet"], callback.get("bcet", callback["wcet"]))
    return AnalysedTask(name=callback["name"], events=PeriodicEvents(period, source.get("jitter", 0)), demand=demand)


def results(system, executor):
    """The bounds of all methods for one thread, by method and callback."""
    is_static = executor["type"] == "static"
    callbacks = sorted(system["callbacks"], key=lambda each: (each["kind"] == "timer") is is_static)
    tasks = [task(each, system.get("sources", ())) for each in callbacks]
    supply = FULL
    if reserved := executor.get("reservation"):
        budget, period = reserved["budget"], reserved["period"]
        supply = Supply(budget=budget, period=period, wait=2 * (period - budget))
    any_order = polled.response_times(tasks, supply=supply)
    yield "ecrts19-polled", any_order
    for method, is_ordered in (("rtss21-rr", True), ("rtss21-rr-unordered", False)):
        yield method, improved(polling_points, ReadySet(tasks, is_ordered, supply), any_order)
    # The published values are those of one step from the bounds for any order.
    ready, known = ReadySet(tasks, True, supply), {name: response.worst for name, response in any_order.items()}
    after_one = {task.name: busy_window_aware.latest(index, ready, known) for index, task in enumerate(tasks)}
    yield "rtss21-bw", {name: replace(response, worst=after_one[name]) for name, response in any_order.items()}
    yield "fifo", fifo.response_times(tasks)
    blocking = [max((other.demand.worst - 1 for other in tasks[index + 1 :]), default=0) for index in range(len(tasks))]
    yield (
        "np-fp",
        {each.name: non_preemptive.response_time(each, tasks[:index], blocking[index]) for index, each in enumerate(tasks)},
    )


def chains(system):
    by_name = {each["name"]: each for each in system["callbacks"]}
    for chain in system["chains"]:
        route = [by_name[name] for name in chain["path"]]
        head = task(route[0], system.get("sources", ()))
        yield ReentrantChain(head.events.period, sum(each["wcet"] for each in route), route[-1]["wcet"])


@pytest.mark.parametrize(("system", "executor", "entry"), list(vectors()))
def test_published_bounds(system, executor, entry):
    bounds, observed = entry["bounds"], entry["observed"]
    if "rtss22-jiang" in bounds:
        responses = latencies(list(chains(system)), executor["threads"])
        by_name = {chain["name"]: each.worst for chain, each in zip(system["chains"], responses, strict=True)}
        if entry["holds"]["rtss22-jiang"] == "holds":
            assert by_name == bounds["rtss22-jiang"]
        elif "period" in entry["holds"]["rtss22-jiang"]:
            assert set(by_name.values()) == {None}
        return
    for method, responses in results(system, executor):
        if method in bounds:
            assert {name: response.worst for name, response in responses.items()} == bounds[method]
            assert all(response.worst >= observed[name]["response"] for name, response in responses.items())


def windows(name):
    """The system of a name in the vectors with its windows and bounds."""
    entry = next((each for each in every_entry() if each["system"]["name"] == name), None)
    if entry is None:
        pytest.skip("the vectors are not at hand")
    host = host_of(entry["system"])
    return entry, host, Windows(sum(callback.execution.most for callback in host.callbacks))


@pytest.mark.parametrize("kind", [f"{load}-{kinds}" for load in ("over", "under") for kinds in ("SS", "ST", "TS", "TT")])
def test_published_bounds_from_any_time(kind):
    """A chain is in parts: of messages from its timer on, and from a timer to what reads a variable, and to the end of the part."""
    entry, host, bound = windows(f"fusion-{kind}")
    topics = HostTopics(host, analyze_system(with_chains(host, [])).solution)
    for name, path in paths(entry["system"]).items():
        callbacks = [topics.callbacks[each] for each in path]
        last = [one for one, other in pairwise(callbacks) if topics.source(other) != one] + callbacks[-1:]
        assert sum(bound.from_any_time(topics.route(each)) for each in last) == entry["bounds"]["rtss22-e2e"][name]


def test_a_chain_of_an_overloaded_executor_takes_as_long_as_its_windows():
    """The player finds 2,159, in six windows of 360; one tick less, as a timer that is due at the poll is in its set."""
    entry, host, _ = windows("fusion-over-SS")
    chains = analyze_system(with_chains(host, paths(entry["system"]).items())).chains
    assert chains["from-1"].worst == entry["observed"]["from-1"]["latency"] == 6 * 360 - 1


@pytest.mark.parametrize(("period", "worst"), [(100, 100 + 5), (1, 5 + 5)])
def test_the_next_call_of_a_timer_that_is_alone(period, worst):
    """It began just before: the next one begins when it is due, or when this one ends, and takes 5."""
    timer = HostCallback(name="t", kind=HandleKind.TIMER, period=period, execution=Span(least=5, most=5))
    assert Windows(5).from_any_time([timer]) == worst


def constant(name, period, cost, jitter=0):
    return AnalysedTask(name=name, events=PeriodicEvents(period, jitter), demand=MultiframeDemand.constant(cost))


def test_a_callback_waits_for_the_whole_ready_set():
    """A timer that is due just after the poll waits for three callbacks of 20, and takes 5."""
    timer, *others = (constant("t", 100, 5), *(constant(f"s{index}", 100, 20) for index in range(3)))
    assert polled.response_times([timer, *others])["t"].worst == 3 * 20 + 5


def test_two_messages_of_one_call_are_two():
    """The second one waits for the first one, which takes 20."""
    rules = {"kind": HandleKind.TIMER, "period": 100, "execution": Span(least=5, most=5), "publishes": ("m", "m")}
    taken = {"kind": HandleKind.SUBSCRIPTION, "topic": "m", "execution": Span(least=20, most=20)}
    callbacks = (HostCallback(name="t", **rules), HostCallback(name="s", **taken))
    thread = HostThread(policy=HostPolicy.FIFO, priority=1, cores=(0,))
    host = Host(
        computers=(HostComputer(name="pc", cores=1),),
        executors=(HostExecutor(name="E", computer="pc", thread=thread, callbacks=callbacks),),
        topics=(HostTopic(name="m", latency=Span(most=0)),),
    )
    (executor,) = analyze_system(with_chains(host, [])).host
    assert executor.handles["s"].response.worst >= 2 * 20


def test_a_thread_of_higher_priority_preempts_it():
    """Of 12 after 5 of the other thread, which comes again after 20 only."""
    assert polled.response_times([constant("l", 40, 12)], [constant("h", 20, 5)])["l"].worst == 5 + 12


def test_a_burst_is_called_once_for_each_polling_point():
    """Three messages of the burst are pending at once; alone, the other callback would wait for all of them.

    It is pending at one polling point, so that one of them comes before it at most, and one more if it is called before it.
    """
    burst, other = constant("burst", 100, 5, jitter=200), constant("other", 100, 20)
    known = polled.response_times([burst, other])
    assert known["other"].worst == 3 * 5 + 20
    assert improved(polling_points, ReadySet([burst, other], is_ordered=True), known)["other"].worst == 2 * 5 + 20
    assert improved(polling_points, ReadySet([other, burst], is_ordered=True), known)["other"].worst == 1 * 5 + 20


def test_chains_share_the_threads():
    """A whole job of the other chain is pending, and its next one can follow at once, as it ended at the end of its period.

    Before its last callback, the first chain needs 5. In a window of 12, the other one executes 10 + 2: 5 + 12 / 2 = 11, where the
    last one starts. The second chain has nothing before its only callback, and waits for 20 / 2.
    """
    first, second = latencies([ReentrantChain(100, 20, 15), ReentrantChain(100, 10, 10)], 2)
    assert (first.worst, second.worst) == (11 + 15, 10 + 10)


def test_a_chain_that_can_exceed_its_period_leaves_all_unknown():
    responses = latencies([ReentrantChain(100, 99, 1), ReentrantChain(100, 90, 10)], 2)
    assert [each.worst for each in responses] == [None, None]
    assert "period" in responses[0].reason
