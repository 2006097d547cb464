"""Messages that are lost on wires, and sent again: call by call as a player that shares no code with the simulation, and by hand."""

import random
from dataclasses import replace

import numpy as np
import pytest
from effort import IS_THOROUGH
from lossy_player import LossyPlayer, losses
from simulated_calls import Least, as_planned, first_difference
from test_whole_way import drawn
from traces import said
from whole_player import MS, S

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.diagnostics import Severity
from amalthea_uros.executors.semantics.steps import with_steps
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.network import Network
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.program.build import build_program
from amalthea_uros.simulate.runs import driver
from amalthea_uros.simulate.runs.evaluation import RunEvaluation
from amalthea_uros.simulate.runs.execution import SimulationRun
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.simulate.sampling.streams import ValueStream
from amalthea_uros.timing.activation.releases import with_first_arrivals
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.trace.sinks import EventRecorder
from amalthea_uros.trace.table import EventKind
from amalthea_uros.units import MILLISECOND, SECOND, Duration
from amalthea_uros.uros.described import describe_content, describe_text

BLOCK = 200 if IS_THOROUGH else 20
SEEDS = range(4000 if IS_THOROUGH else 60)
DIRECTIONS = ("to_controller", "to_agent")


class Run:
    """A run in which it is stated which messages are lost.

    Attributes
    ----------
    calls : response times of each handle in picoseconds
    result : as of every run
    at_host : times of responses of chains
    """

    def __init__(self, system, until, lost):
        options = Options(duration=Duration(until), mode=SimulationMode.AVERAGE)
        context = TimingContext.of_scheduling(with_first_arrivals(with_steps(system), {}), options.settings)
        program, jobs, observed = build_program(context, options), [], []
        assert program.left_out == {}
        for name, record in program.lossy.items():
            direction = "to_controller" if system.transmissions[name].direction == "to the controller" else "to_agent"
            first = program.memory[record + layout.LOSES]
            values = program.memory[program.memory[first] + layout.LOSS_VALUES]
            program.streams[program.memory[values + layout.STREAM_NUMBER]] = series(lost[direction])
        run = SimulationRun(context, options, program)
        observe = run.driver.observations
        run.driver.jobs = lambda rows: (jobs.append(rows.copy()), add(rows, run))
        run.driver.observations = lambda rows: (observed.append(rows.copy()), observe(rows))
        run.execute([])
        self.result, rows, first = (
            RunEvaluation(run).result(),
            np.concatenate(jobs),
            len(program.processes) + len(program.runnables),
        )
        self.calls = {
            key[1]: [(int(row[4]) - int(row[2])) // program.units for row in rows[rows[:, 0] == first + number]]
            for number, key in enumerate(program.handles)
        }
        self.ends = {
            key[1]: [int(row[4]) // program.units for row in rows[rows[:, 0] == first + number]]
            for number, key in enumerate(program.handles)
        }
        found = np.concatenate(observed) if observed else np.empty((0, 4), np.int64)
        self.at_host = [int(row[2]) // program.units for row in found[found[:, 1] == layout.RESPONSE]]


def add(rows, run):
    from amalthea_uros.simulate.metrics import jobs

    jobs.add_rows(rows, [*run.jobs, *run.runnables, *run.handles])


def series(values):
    """Values one after another, then zeros."""
    rest = iter(values)
    return ValueStream(0, 1, lambda count: np.array([int(next(rest, 0)) for _ in range(count)], np.int64))


def without_spans(content):
    """A description in which everything takes its least time."""
    match content:
        case {"min": least, "max": _}:
            return {"min": least, "max": least}
        case dict():
            return {key: without_spans(value) for key, value in content.items()}
        case list():
            return [without_spans(each) for each in content]
    return content


def without_polls(system):
    """A system whose waits do not poll in the last millisecond before a timer is due; the player does not, either."""
    runnables = [replace(each, activities=()) if each.name == "Executor_Poll" else each for each in system.software.runnables]
    return replace(system, software=replace(system.software, runnables=tuple(runnables)))


def on_lossy_wire(seed):
    """A random description with constant times and a wire that loses messages, and the plan of its player; None for other wires."""
    chance = random.Random(seed)
    content, plan = drawn(chance)
    if plan["wire"] not in ("udp", "tcp", "custom") or plan["tick"]:
        return None
    content = without_spans(content)
    for key in ("to_controller", "to_host", "acknowledgement", "link", "transfer"):
        if key in plan:
            plan[key] = (plan[key][0],) * 2
    for each in (*plan["handles"], *plan["tasks"]):
        each["cost"] = (each["cost"][0],) * 2
    plan["begin"] = 0
    for handle in plan["handles"]:
        handle["phase"] = chance.randrange(1, handle["period"])
    content["middleware"]["transport"]["losses"] = dict.fromkeys(DIRECTIONS, "50 %")
    plan["silence"] = chance.choice((1, 20, 100)) * MS
    content["middleware"]["limits"] = {"UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL": f"{plan['silence']} ps"}
    # With more losses, answers about the same gap can multiply what is sent again.
    share = chance.choice((0.01, 0.05, 0.1))
    return content, plan, {direction: losses(chance, share) for direction in DIRECTIONS}


@pytest.mark.parametrize("block", range(0, len(SEEDS), BLOCK))
def test_every_call_is_that_of_a_player(block):
    compared, lost = 0, 0
    for seed in SEEDS[block : block + BLOCK]:
        found = on_lossy_wire(seed)
        if found is None:
            continue
        content, plan, drawn_losses = found
        system = describe_content(content).assembly.system
        plan["blocks"] = system.network.wires[0].keeps_sender
        player = LossyPlayer(plan, Least(), drawn_losses)
        seen = player.play(S)
        run = Run(as_planned(without_polls(system), plan), S, drawn_losses)
        for handle, responses in run.calls.items():
            assert first_difference(responses, seen.responses[handle]) is None, (seed, handle, content)
            compared += len(responses)
        (executor,) = run.result.executors
        assert (executor.timeouts, executor.refusals) == (player.counts["timeouts"], player.counts["refused"]), seed
        lost += sum(each.lost for each in run.result.losses)
    assert compared > 20, "hardly anything was called"
    assert lost, "nothing was lost"


# By hand: a message is on the wire for 1 ms, during which its writer waits; the agent takes 1 ms for everything. An iteration has an
# overhead of 1 ms, and each callback takes 1 ms.

TEXT = """
amuros: 1
name: hand
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {name: Executor, loop: {spin: 1 s}, execution_time: {base: 1 ms}}
  transport:
    losses: {to_controller: 50 %, to_agent: 50 %}
    custom: {table: [{size: 512 B, time: 1 ms}]}
  agent: {to_controller: 1 ms, to_host: 1 ms, acknowledgement: 1 ms}
application:
  nodes:
    - name: node
      publishers: [{topic: out, message_size: 4 B, reliability: reliable}]
      subscriptions:
        - name: go
          topic: go
          interval: 2 s
          phase: 100 ms
          message_size: 4 B
          execution_time: 1 ms
          publishes: [out]
          reliability: best-effort
chains: [{name: way, path: [/go, go, /out]}]
"""
STATED, EVERY = "{to_controller: 50 %, to_agent: 50 %}", "2 s\n          phase: 100 ms"
DENSE = """        - name: dense
          topic: dense
          interval: 50 ms
          phase: 10 ms
          message_size: 4 B
          execution_time: 1 us
          reliability: best-effort
chains:"""
NEVER = {"to_controller": [], "to_agent": []}


def played(text=TEXT, *, until=400, **lost):
    return Run(describe_text(text).assembly.system, until * MS, NEVER | lost)


def milliseconds(times):
    return [time / MS for time in times]


def test_nothing_is_lost():
    """Published at 100, at the controller at 102; written from 104 to 105; acknowledged at 107."""
    run = played()
    assert milliseconds(run.calls["go"]) == [5]
    assert milliseconds(run.at_host) == [106]


def test_a_lost_message_of_best_effort_is_gone():
    run = played(TEXT.replace("size: 4 B, reliability: reliable", "size: 4 B, reliability: best-effort"), to_agent=[1])
    assert milliseconds(run.calls["go"]) == [3]
    assert run.at_host == []
    assert [(each.sent, each.lost, each.sent_again) for each in run.result.losses if each.lost] == [(1, 1, 0)]
    assert run.result.chains["way"].unanswered == 1


def test_a_lost_message_is_sent_again_after_a_silence():
    """The client asks at 205; the answer is there at 208, the message on the wire until 209, its acknowledgement there at 211."""
    run = played(to_agent=[1])
    assert milliseconds(run.calls["go"]) == [109]
    assert milliseconds(run.at_host) == [210]
    assert [(each.lost, each.sent_again) for each in run.result.losses if each.lost] == [(1, 1)]


def test_a_lost_acknowledgement_is_asked_for():
    """The message is at the host at 106; the client asks at 205, and has the answer at 208."""
    run = played(to_controller=[0, 1])
    assert milliseconds(run.calls["go"]) == [106]
    assert milliseconds(run.at_host) == [106]


def test_dense_input_postpones_the_recovery_to_the_timeout():
    """Something arrives every 50 ms, so that there is no silence of 100 ms from 105 to 1105.

    The next message, of 2105, makes the agent say at 2107 what is missing; both are sent again, and the first one arrives at 2108.
    """
    run = played(TEXT.replace("chains:", DENSE), until=2500, to_agent=[1])
    assert milliseconds(run.calls["go"])[0] == 1003
    assert run.result.executors["Executor"].timeouts == 1
    assert milliseconds(run.at_host) == [2109, 2109]


RELIABLE = TEXT.replace("publishes: [out]\n          reliability: best-effort", "reliability: reliable").replace(
    "[/go, go, /out]", "[/go, go]"
)
LATER = """        - name: second
          topic: second
          interval: 2 s
          phase: 110 ms
          message_size: 4 B
          execution_time: 1 ms
          reliability: reliable
chains:"""


def test_a_message_to_the_controller_is_sent_again_after_a_heartbeat_of_the_agent():
    """It asks at 200, has the answer at 202, and sends it again until 204; acknowledged until 205, the callback ends at 207."""
    run = played(RELIABLE, to_controller=[1])
    assert milliseconds(run.ends["go"]) == [207]
    assert milliseconds(run.calls["go"]) == [3]


def test_later_messages_wait_for_a_missing_one():
    """The second one arrives at 112; the acknowledgement says at 113 that one is missing, which is there at 115."""
    run = played(RELIABLE.replace("chains:", LATER), to_controller=[1])
    assert milliseconds(run.ends["go"]) == [118]
    assert milliseconds(run.ends["second"]) == [119]
    assert milliseconds(run.calls["second"]) == [4]


LONG = TEXT.replace("topic: out, message_size: 4 B", "topic: out, message_size: 900 B")


def test_only_the_parts_that_are_missing_are_sent_again():
    """Of two parts, on the wire until 105 and 106, the second one is lost; the acknowledgement of the first one comes at 107.

    The client asks at 207, has the answer at 210, sends the second part until 211, and its acknowledgement is there at 213.
    """
    run = played(LONG, to_agent=[0, 1])
    assert milliseconds(run.at_host) == [212]
    assert milliseconds(run.calls["go"]) == [111]


LOOP, WITH_PING = "{spin: 1 s}", "[{spin_some: 10 ms}, {ping: 20 ms, attempts: 2, every: 10 s}, {sleep: 1 ms}]"
PINGING = TEXT.replace(LOOP, WITH_PING)


def test_a_ping_that_is_lost_is_sent_again_until_its_last_attempt():
    """Each attempt waits for its 10 ms and 100 ms more; of the second one, request and reply take 1 ms each, and the agent 1 ms."""
    assert milliseconds(played(PINGING, to_agent=[1]).calls["Executor_ping"]) == [1 + 110 + 3]
    lost = played(PINGING, to_agent=[1, 1], until=600)
    assert milliseconds(lost.calls["Executor_ping"]) == [2 * (1 + 110)]
    assert [each.timeouts for each in lost.result.executors] == [0, 1]


# What is stated decides what is lost.


def lost(losses, mode, *, until=20, seed=1):
    """The numbers of lost messages to the agent and to the controller in a run of some seconds, with a message to each every 50 ms."""
    text = TEXT.replace(STATED, losses).replace("2 s\n          phase: 100 ms", "50 ms\n          phase: 10 ms")
    text = text.replace("size: 4 B, reliability: reliable", "size: 4 B, reliability: best-effort")
    system = describe_text(text).assembly.system
    found = simulate_system(system, Options(duration=Duration(until * SECOND), mode=mode, seed=seed)).losses
    return [sum(each.lost for each in found if each.name.startswith(topic)) for topic in ("out", "go")]


@pytest.mark.parametrize(
    ("losses", "mode", "found"),
    [
        # In 20 s, 2 in any 5 s are 8 at most, and in the mode `worst` the first ones that are sent.
        ("{to_agent: 2 per 5 s}", SimulationMode.WORST, [8, 0]),
        ("{to_controller: 2 per 5 s}", SimulationMode.WORST, [0, 8]),
        ("{to_controller: 2 per 5 s}", SimulationMode.BEST, [0, 0]),
        ("50 %", SimulationMode.BEST, [0, 0]),
    ],
)
def test_a_mode_decides_what_is_lost(losses, mode, found):
    assert lost(losses, mode) == found


def test_a_number_is_that_of_both_directions_together():
    assert sum(lost("2 per 5 s", SimulationMode.WORST)) == 8


@pytest.mark.parametrize("seed", range(5))
def test_no_more_are_lost_than_stated(seed):
    assert 0 < sum(lost("2 per 5 s", SimulationMode.SAMPLED, seed=seed)) <= 8


def test_a_probability_is_that_of_each_message():
    """Of 2000 messages to the controller, 10 % are 200, with a standard deviation of 13."""
    (_, found) = lost("{to_controller: 10 %}", SimulationMode.SAMPLED, until=100)
    assert 200 - 5 * 13 < found < 200 + 5 * 13


def test_other_random_values_do_not_change():
    """A message of which none can be lost arrives as it does without losses."""
    text = TEXT.replace("to_controller: 1 ms, to_host", "to_controller: {min: 0 ms, max: 20 ms}, to_host")
    found = []
    for stated in ("{to_agent: 1 per 10 s}", "{to_agent: 10 %}"):
        system = describe_text(text.replace(STATED, stated)).assembly.system
        found.append(simulate_system(system, Options(duration=Duration(SECOND))).processes["go_topic_to_go"].metrics)
    assert found[0] == found[1]


def test_a_trace_shows_what_is_lost_and_sent_again():
    """In the mode `worst`, the first message is lost: on the wire until 105, and again until 209."""
    system = describe_text(TEXT.replace(STATED, "{to_agent: 1 per 10 s}")).assembly.system
    recorder = EventRecorder()
    simulate_system(
        system, Options(duration=Duration(SECOND), mode=SimulationMode.WORST, traced=(0, Duration(SECOND))), [recorder]
    )
    seen = [(time // MS, kind, target.name) for time, kind, _, _, target, *_ in said([recorder.table])]
    assert [time for time, *what in seen if what == [EventKind.TRIGGER, "losses on Transport"]] == [105]
    assert [time for time, *what in seen if what == [EventKind.TERMINATE, "out_topic_from_go"]] == [105, 209]


# Elsewhere.


@pytest.mark.early
def test_machine_code_loses_alike(monkeypatch):
    from amalthea_uros.simulate.kernel import machine_code

    pytest.importorskip("numba")
    text = RELIABLE.replace(EVERY, "70 ms\n          phase: 10 ms").replace("chains:", LATER.replace("2 s", "90 ms"))
    text = text.replace(STATED, "10 %").replace(LOOP, WITH_PING.replace("10 s", "300 ms"))
    system, options = (
        describe_text(text).assembly.system,
        Options(duration=Duration(5 * SECOND), traced=(0, Duration(5 * SECOND))),
    )
    results = []
    for is_compiled in (False, True):
        monkeypatch.setattr(machine_code, "is_worth_it", lambda *_, is_compiled=is_compiled: is_compiled)
        recorder = EventRecorder()
        results.append((simulate_system(system, options, [recorder]), said([recorder.table])))
    assert results[0] == results[1]


def test_the_assumptions_state_the_losses():
    system = describe_text(TEXT.replace(STATED, "1 per 10 s")).assembly.system
    assumptions = simulate_system(system, Options(duration=Duration(SECOND))).assumptions
    assert "'Transport' loses at most 1 message in any 10 s" in assumptions
    assert not any("no message is lost" in each for each in assumptions)


def test_the_best_mode_says_that_nothing_is_lost():
    system = describe_text(TEXT.replace(STATED, "1 per 10 s")).assembly.system
    assumptions = simulate_system(system, Options(duration=Duration(SECOND), mode=SimulationMode.BEST)).assumptions
    assert "no message is lost on 'Transport' in the mode best, whatever losses are stated" in assumptions


def test_a_run_in_which_answers_multiply_ends_and_says_so(monkeypatch):
    """Every 2 ms something is sent to an executor that reads every 400 ms; each answer about a gap makes the agent send again."""
    monkeypatch.setattr(driver, "MOST_MESSAGES", 1024)
    text = RELIABLE.replace("loop: {spin: 1 s}", "loop: {spin_some: 10 ms, sleep: 400 ms}").replace(
        "time: 1 ms}]}", "time: 1 us}]}"
    )
    text = text.replace(EVERY, "2 ms\n          phase: 10 ms").replace(STATED, "30 %")
    found = simulate_system(describe_text(text).assembly.system, Options(duration=Duration(1000 * SECOND)))
    (finding,) = [each for each in found.findings if each.rule == "SIM006"]
    assert finding.severity is Severity.ERROR
    assert "more than 1,024 messages" in finding.message
    assert found.executors["Executor"].iterations < 1000 * SECOND // (400 * MILLISECOND)


def test_an_executor_whose_messages_are_undefined_is_left_out():
    system = replace(describe_text(TEXT).assembly.system, network=Network())
    reasons = {each.name: each.reason for each in simulate_system(system, Options(duration=Duration(SECOND))).left_out}
    assert reasons["Executor"] == "it receives messages for 'go': 'go_topic_to_go' is undefined"


def test_a_reliable_message_of_a_task_without_a_loop_is_left_out():
    """Nobody who is simulated sends it again."""
    text = TEXT.replace("loop: {spin: 1 s}", "period: 10 ms")
    text = text.replace("  transport:", "  reliable: {waits: false}\n  transport:")
    (left_out,) = simulate_system(describe_text(text).assembly.system, Options(duration=Duration(SECOND))).left_out
    assert "sends or receives it again" in left_out.reason


def test_nothing_is_met_that_a_loss_can_delay():
    text = TEXT.replace("/out]}", "/out], reaction: 1 h}").replace("{to_controller: 50 %, to_agent: 50 %}", "1 per 10 s")
    analysis = analyze_system(describe_text(text).assembly.system)
    assert {each.verdict for each in analysis.requirements} == {Verdict.UNKNOWN}
    assert all(handle.response.worst is None for executor in analysis.executors for handle in executor.handles)
