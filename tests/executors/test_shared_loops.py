"""Several executors in the loop of a thread, busy waits, and what a loop does besides; the figures are computed by hand."""

from random import Random

import pytest
import yaml
from effort import IS_THOROUGH
from fuzzing.contradictions import contradictions

from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.errors import ReadError
from amalthea_uros.services.analyze import analyze
from amalthea_uros.services.build import describe
from amalthea_uros.services.check import check
from amalthea_uros.services.simulate import simulate
from amalthea_uros.spec.read import read_description
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.uros.described import describe_content

HEAD = """amuros: 1
name: app
hardware: {platform: generic, frequency: 100 MHz}
"""
WIRE = """  transport: {udp: {bitrate: 10 Mbit/s, latency: {min: 0, max: 500 us}}}
  agent: {to_controller: {min: 100 us, max: 600 us}, to_host: {min: 100 us, max: 1 ms}, acknowledgement: {min: 200 us, max: 800 us}}
  limits: {RMW_UXRCE_MAX_HISTORY: 16}
"""


def text_of(loop, callbacks, executors=1, tasks="", others=""):
    """A description whose executors e0, e1 ... spin in the loop of e0; callbacks are lines of timers or subscriptions."""
    found = f"{HEAD}middleware:\n  executors:\n"
    for number in range(executors):
        stated = f", priority: 5, loop: [{', '.join(loop)}]" if number == 0 else ""
        found += f"    - {{name: e{number}{stated}, execution_time: {{base: 20 us, per_message: 10 us}}}}\n"
    found += (
        others
        + WIRE
        + tasks
        + "application:\n  nodes:\n    - name: n\n      publishers: [{topic: p, message_size: 8 B, reliability: best-effort}]\n"
    )
    for key, lines in callbacks.items():
        found += f"      {key}:\n" + "".join(f"        - {{{line}}}\n" for line in lines)
    return found


def timer(name, period, time, executor="e0", more=""):
    return f"name: {name}, period: {period} ms, execution_time: {time} us, runs_in: {executor}{more}"


def subscription(name, rate, time, executor="e0"):
    message = f"topic: {name}_topic, message_size: 8 B, reliability: best-effort"
    return f"name: {name}, {message}, rate: {rate} Hz, execution_time: {time} us, runs_in: {executor}"


TWO = text_of(
    ["{spin_some: 10 ms}", "{spin_some: 100 ms, executor: e1}"],
    {"timers": [timer("t", 20, 100)], "subscriptions": [subscription("a", 1, 200), subscription("b", 1, 300, "e1")]},
    executors=2,
)


LOW = "tasks:\n  - {name: Low, period: 50 ms, priority: 1, execution_time: 1 ms}\n"


def with_item(item, *more):
    """An executor with a subscription, in whose loop its thread does something else, too, and sleeps 5 ms."""
    return text_of(
        ["{spin_some: 10 ms}", item, *more, "{sleep: 5 ms}"], {"subscriptions": [subscription("a", 1, 100)]}, tasks=LOW
    )


def test_a_timer_waits_for_the_other_executor_of_its_loop():
    # Ready just after a check: what is left of this iteration, 20 + 100 + 210 us; the wait of 100 ms and an iteration of the other one,
    # 20 + 310 us; then the check, 20 us, and its place in the iteration. As the overhead can be on either side of a check, it counts
    # at both ends of the time until the call, 20 us more.
    found = analyze(TWO).executors["e0"].handles["t"]
    assert 100 * MS + 680 * US <= found.lateness.most <= 100 * MS + 1 * MS
    assert found.lost is not None
    # 100 ms after it is due, 5 expirations have passed.
    assert found.lost.most == 5
    observed = simulate(TWO, "20 s").executors["e0"].handles["t"]
    assert 90 * MS < observed.lateness.max <= found.lateness.most
    assert observed.lost > 0


@pytest.mark.parametrize("text", [TWO, with_item("{ping: 100 ms}")])
def test_executors_of_one_thread_are_not_several_threads(text, tmp_path):
    assert {finding.rule for finding in analyze(text).findings} & {"EXE008", "UR106", "EXE022"} == set()
    (tmp_path / "app.yaml").write_text(text)
    model = build_model(describe(tmp_path / "app.yaml").system)
    assert check(model, ["TIM-PRIORITY-SHARED"]) == []


def test_a_loop_has_so_many_items_at_most(tmp_path):
    (tmp_path / "app.yaml").write_text(with_item(", ".join(["{publish: [p]}", "{sleep: 1 ms}"] * 50)))
    with pytest.raises(ReadError, match="at most 100 items"):
        describe(tmp_path / "app.yaml")


def test_the_order_and_the_sleeps_of_a_loop_are_kept():
    # Nothing arrives: e0 waits 10 ms, the thread sleeps 3 ms, e1 waits 20 ms, and it sleeps 7 ms: a round of 40 ms and the overheads.
    loop = ["{spin_some: 10 ms}", "{sleep: 3 ms}", "{spin_some: 20 ms, executor: e1}", "{sleep: 7 ms}"]
    callbacks = {
        "subscriptions": [
            "name: b, topic: x, message_size: 8 B, reliability: best-effort, rate: 0.001 Hz, execution_time: 1 us, runs_in: e1",
            subscription("a", 0.001, 1),
        ]
    }
    text = text_of(loop, callbacks, executors=2)
    rounds = simulate(text, "10 s").executors["e0"].iterations
    assert 10_000 // 41 <= rounds <= 10_000 // 40 + 2
    found = analyze(text).executors
    assert found["e0"].loop.most == found["e1"].loop.most
    assert 40 * MS < found["e0"].loop.most < 41 * MS
    assert found["e0"].loop.least >= 10 * MS


def test_a_busy_wait_lets_nothing_of_lower_priority_execute():
    tasks = "tasks:\n  - {name: Low, period: 50 ms, priority: 1, execution_time: 1 ms}\n"
    callbacks = {"subscriptions": [subscription("a", 1, 100)]}
    waiting = {
        kind: analyze(text_of(["{spin_some: 1 ms}", f"{{{kind}: 5 ms}}", "{sleep: 2 ms}"], callbacks, tasks=tasks)).processes[
            "Low"
        ]
        for kind in ("busy_wait", "sleep")
    }
    # The busy wait of 5 ms, up to a tick of 1 ms more.
    assert waiting["busy_wait"].response.worst >= waiting["sleep"].response.worst + 5 * MS


def calls_of(name, simulation):
    handles = (handle for executor in simulation.executors for handle in executor.handles)
    return next(handle.response_time.count for handle in handles if handle.name == name)


def test_a_publication_of_the_loop_is_written_in_every_pass():
    found, observed = analyze(with_item("{publish: [p]}")), simulate(with_item("{publish: [p]}"), "10 s")
    # Of 8 bytes, which take 10 Mbit/s 86 bytes of 0.8 us each, headers included.
    assert found.executors["e0_sends"].handles["e0_publishes_p"].response.worst == 86 * 800_000
    # It just missed a check: 20 + 100 us of the iteration, 68.8 us, the sleep, and the 20 us before its call.
    assert 5 * MS + 308.8 * US <= found.executors["e0"].handles["a"].response.worst <= 5 * MS + 400 * US
    passes = observed.executors["e0"].iterations
    assert abs(calls_of("e0_publishes_p", observed) - passes) <= 1
    # Ten messages end a wait early.
    assert 10_000 // 16 <= passes <= 10_000 // 15 + 10


@pytest.mark.parametrize(("item", "answer"), [("{ping: 100 ms}", 36), ("{sync: 100 ms}", 32)])
def test_a_loop_waits_for_the_answer_of_the_agent(item, answer):
    (handle,) = analyze(with_item(item)).executors["e0_sends"].handles
    # 16 bytes there and the answer back, each with 68 of headers; both links, and the agent.
    wire = (16 + 68) * 800 + (answer + 68) * 800
    least_round_trip = 2 * 0 + 200 * US + wire * 1000
    most = 2 * 500 * US + 800 * US + wire * 1000
    assert most <= handle.response.worst <= most + 200 * US
    (seen,) = simulate(with_item(item), "10 s").executors["e0_sends"].handles
    assert least_round_trip <= seen.response_time.min <= seen.response_time.max <= handle.response.worst


def test_a_ping_without_an_answer_takes_its_timeouts():
    # Nothing is known of the agent: three attempts of 100 ms, each of which can last 100 ms longer.
    text = with_item("{ping: 300 ms, attempts: 3}").replace(", acknowledgement: {min: 200 us, max: 800 us}", "")
    (handle,) = analyze(text).executors["e0_sends"].handles
    assert 600 * MS <= handle.response.worst <= 601 * MS


def test_what_is_done_every_so_often_is_done_no_more_often():
    observed = simulate(with_item("{ping: 100 ms, every: 200 ms}"), "10 s")
    # Passes of 15.02 ms, or a little more: it is due again after 14 of them.
    assert 10_000 // 225 <= calls_of("e0_ping", observed) <= 10_000 // 200 + 1
    assert observed.executors["e0"].iterations > 500


def test_several_items_are_sent_in_their_order():
    observed = simulate(with_item("{publish: [p]}", "{ping: 100 ms}", "{sync: 100 ms}"), "5 s")
    assert [each.name for each in observed.executors["e0_sends"].handles] == ["e0_publishes_p", "e0_ping", "e0_sync"]
    assert len({each.response_time.count for each in observed.executors["e0_sends"].handles}) == 1


def test_what_one_thread_writes_does_not_wait_for_itself():
    def handles(*items):
        serial = "{serial: {baud_rate: 1000000, driver: {write: polling}}}"
        text = with_item(*items).replace("{udp: {bitrate: 10 Mbit/s, latency: {min: 0, max: 500 us}}}", serial)
        return [each.response.worst for each in analyze(text).executors["e0_sends"].handles]

    # A write returns when the message is on the wire: what is written after it never finds it there.
    published, ping = handles("{publish: [p]}", "{ping: 100 ms}")
    assert ping == published + handles("{ping: 100 ms}")[0]
    assert published == handles("{publish: [p]}")[0]


def test_a_thread_can_send_without_an_executor():
    sender = "    - {name: imu, priority: 6, loop: [publish: [p], sleep: 20 ms]}\n"
    text = text_of(["{spin_some: 10 ms}"], {"subscriptions": [subscription("a", 1, 100)]}, others=sender)
    found = analyze(text)
    assert "EXE008" in {finding.rule for finding in found.findings}
    assert found.executors["imu"].handles["imu_publishes_p"].response.worst is not None
    assert 10_000 // 21 <= calls_of("imu_publishes_p", simulate(text, "10 s")) <= 10_000 // 20 + 1


def test_equal_items_are_callbacks_of_their_own():
    loop = [
        {"spin_some": "10 ms"},
        {"publish": ["p"]},
        {"ping": "100 ms"},
        {"publish": ["p"]},
        {"ping": "100 ms"},
        {"sleep": "5 ms"},
    ]
    content = yaml.safe_load(text_of(["{spin_some: 10 ms}"], {"subscriptions": [subscription("a", 1, 100)]}))
    content["middleware"]["executors"][0]["loop"] = loop
    (sending,) = [each for each in describe_content(content).assembly.system.executors if each.name == "e0_sends"]
    assert [each.name for each in sending.handles] == ["e0_publishes_p", "e0_ping", "e0_publishes_p_2", "e0_ping_2"]


@pytest.mark.parametrize("name", ["e0_sends", "e0_ping"])
def test_a_task_cannot_have_the_name_of_what_a_loop_sends(name, tmp_path):
    (tmp_path / "app.yaml").write_text(with_item("{ping: 100 ms}").replace("name: Low", f"name: {name}"))
    with pytest.raises(ReadError, match=f"duplicate process name '{name}' .*line 6"):
        describe(tmp_path / "app.yaml")


@pytest.mark.parametrize("spin", ["spin_some: 10 ms, ", ""])
def test_a_loop_that_sends_needs_a_node(spin, tmp_path):
    (tmp_path / "app.yaml").write_text(f"{HEAD}middleware: {{executor: {{name: e0, loop: [{spin}publish: [p]]}}}}\n{LOW}")
    with pytest.raises(ReadError, match="the loop of 'e0' sends, but the application has no node"):
        describe(tmp_path / "app.yaml")


def test_a_chain_can_begin_with_what_a_loop_publishes():
    text = with_item("{publish: [p]}") + "chains: [{name: c, path: [e0_publishes_p, /p]}]\n"
    bounds, observed = analyze(text).chains["c"], simulate(text, "10 s").chains["c"]
    reaction = observed.quantities[ChainQuantity.REDUCED_REACTION_TIME]
    # Written in 68.8 us at once, then 0 to 500 us to the agent and 0.1 to 1 ms in it.
    assert 168_800_000 <= bounds.best <= reaction.min <= reaction.max <= bounds.worst == 1_568_800_000


def test_a_topic_that_nobody_publishes_has_its_place_in_the_loop(tmp_path):
    (tmp_path / "app.yaml").write_text(with_item("{publish: [q]}"))
    with pytest.raises(ReadError, match=r"app.yaml:6:.*undefined publisher 'q'"):
        describe(tmp_path / "app.yaml")


@pytest.mark.parametrize("text", [TWO, with_item("{publish: [p]}")])
def test_a_thread_has_one_stack(text, tmp_path):
    (tmp_path / "app.yaml").write_text(text.replace("name: e0, ", "name: e0, stack: 4 kB, "))
    (stack,) = [each for each in describe(tmp_path / "app.yaml").memory.stacks.users if each.name.startswith("e")]
    assert (stack.name, stack.size) == ("e0", 4000)


@pytest.mark.parametrize("text", [TWO, with_item("{publish: [p]}", "{ping: 300 ms, attempts: 3, every: 1 s}")])
def test_a_model_keeps_the_thread_of_its_executors(text, tmp_path):
    (tmp_path / "app.yaml").write_text(text)
    system = describe(tmp_path / "app.yaml").system
    assert extract(build_model(system)).system.executors == system.executors


@pytest.mark.parametrize(
    ("loop", "reason"),
    [
        ("[sleep: 1 ms]", "expected one 'spin_some' without 'executor'"),
        ("[spin_some: 1 ms, spin_some: 1 ms]", "expected one 'spin_some' without 'executor'"),
        ("[spin_some: 1 ms, {spin_some: 1 ms, executor: b}, {spin_some: 1 ms, executor: b}]", "spins twice"),
        ("[{spin_some: 1 ms, sleep: 1 ms}]", "expected one of"),
        ("[spin_some: 1 ms, publish: [p, p]]", "a topic occurs twice"),
        ("[spin_some: 1 ms, {sleep: 1 ms, executor: b}]", "'executor' has no effect"),
        ("[spin_some: 1 ms, {sync: 1 s, attempts: 2}]", "'attempts' has no effect without 'ping'"),
        ("[spin_some: 1 ms, {sleep: 1 ms, every: 1 s}]", "'every' has no effect"),
    ],
)
def test_a_loop_that_cannot_be_is_refused(loop, reason, tmp_path):
    (tmp_path / "app.yaml").write_text(f"{HEAD}middleware: {{executor: {{loop: {loop}}}}}\n")
    with pytest.raises(ReadError, match=reason):
        read_description(tmp_path / "app.yaml")


@pytest.mark.parametrize(
    ("name", "more", "reason"),
    [
        ("nobody", "", "undefined executor"),
        ("e1", ", loop: {spin: 1 s}", "and elsewhere"),
        ("e1", ", priority: 4", "another priority"),
    ],
)
def test_an_executor_spins_in_one_thread(name, more, reason, tmp_path):
    text = TWO.replace("executor: e1", f"executor: {name}").replace("{name: e1,", f"{{name: e1{more},")
    (tmp_path / "app.yaml").write_text(text)
    with pytest.raises(ReadError, match=reason):
        describe(tmp_path / "app.yaml")


def random_text(rng):
    """An application with up to three executors in a loop, sleeps, busy waits and other tasks."""
    count = rng.choice([1, 2, 2, 3])
    loop = [f"{{spin_some: {rng.choice([0, 1, 5, 20])} ms{'' if n == 0 else f', executor: e{n}'}}}" for n in range(count)]
    for _ in range(rng.choice([0, 1, 1, 2])):
        waits = ["sleep: 1 ms", "sleep: 5 ms", "busy_wait: 2 ms", "busy_wait: 500 us"]
        sends = ["publish: [p]", "ping: 2 ms", "ping: 100 ms, every: 50 ms", "sync: 100 ms"]
        item = rng.choice(waits if rng.random() < 0.6 else sends)
        loop.insert(rng.randrange(len(loop) + 1), f"{{{item}}}")
    callbacks = {"timers": [], "subscriptions": []}
    for number in range(count * 2):
        executor, time = f"e{number % count}", rng.choice([50, 500, 2000])
        if rng.random() < 0.5:
            more = (
                ", publishes: [p]"
                if rng.random() < 0.2 and not any("publishes" in each for each in callbacks["timers"])
                else ""
            )
            callbacks["timers"].append(timer(f"t{number}", rng.choice([5, 20, 50]), time, executor, more))
        else:
            callbacks["subscriptions"].append(subscription(f"s{number}", rng.choice([1, 5, 10]), time, executor))
    tasks = "tasks:\n  - {name: High, period: 10 ms, priority: 9, execution_time: 500 us}\n"
    tasks += "  - {name: Low, period: 50 ms, priority: 1, execution_time: 1 ms}\n"
    if rng.random() < 0.3:
        tasks += "  - {name: Equal, period: 20 ms, priority: 5, execution_time: 1 ms}\n"
    kept = {key: lines for key, lines in callbacks.items() if lines}
    return text_of(loop, kept, executors=count, tasks=rng.choice(["", tasks]))


@pytest.mark.parametrize("seed", range(300 if IS_THOROUGH else 6))
def test_nothing_observed_exceeds_a_bound(seed):
    text = random_text(Random(seed))
    analysis = analyze(text)
    for mode in ("sampled", "worst"):
        simulation = simulate(text, "1 s", seed=seed, mode=mode)
        assert list(contradictions(analysis, simulation)) == []
        for executor in simulation.executors:
            for observed in executor.handles:
                bound = analysis.executors[executor.name].handles[observed.name]
                worst, seen = bound.response.worst, observed.response_time
                assert worst is None or seen is None or seen.max <= worst, (executor.name, observed.name)
                assert bound.lost is not None or not observed.lost, (executor.name, observed.name)
