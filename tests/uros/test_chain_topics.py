"""Topics in the paths of chains: what they mean in the model, and what is wrong with them."""

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.events import CustomEvent, ProcessChange, ProcessEvent, RunnableEvent
from amalthea_uros.perf.network import Direction

TEXT = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  executor: {{name: Executor, {executor}, execution_time: 10 us}}
  transport: {{{transport}}}
  agent: {{to_controller: 1 ms, to_host: 1 ms, acknowledgement: 1 ms}}
application:
  nodes:
    - name: node
      subscriptions:
        - {{name: drive, topic: cmd_vel, rate: 4 Hz, message_size: 48 B, execution_time: 100 us, writes: [speed], publishes: [odom]}}
        - {{name: on_odom, topic: {own}, rate: 4 Hz, jitter: 10 ms, message_size: 4 B, execution_time: 100 us}}
        - {{name: log, topic: {own}, rate: 4 Hz, jitter: 10 ms, message_size: 4 B, execution_time: 100 us}}
        - {{name: stop, topic: halt, rate: 1 Hz, message_size: 4 B, execution_time: 100 us, {stop}}}
      publishers: [{{topic: odom, message_size: 4 B, reliability: best-effort}}]
tasks:
  - {{name: pwm, period: 5 ms, execution_time: 50 us, reads: [speed]}}
  - {{name: brake, period: 5 ms, execution_time: 50 us, reads: [stopped]}}
chains:
  - {{name: way, path: [{path}]}}
"""
LOOP, PERIODIC, SERIAL = "loop: {spin_some: 100 ms, sleep: 10 ms}", "period: 1 ms", "serial: {baud_rate: 921600}"


@pytest.fixture
def app(author):
    """Describes the application with a path."""

    def described(path, executor=LOOP, transport=SERIAL, stop="writes: [stopped]", own="odom"):
        return author.describe(TEXT.format(path=path, executor=executor, transport=transport, stop=stop, own=own))

    return described


def events_of(described):
    """The events of the chain, in order."""
    system = described.system
    (chain,) = system.events.chains
    names = [chain.stimulus, *(segment.response for segment in chain.items.items)] if chain.items else None
    return [system.events_by_name[name] for name in names or (chain.stimulus, chain.response)]


@pytest.mark.parametrize("path", ["/cmd_vel, drive, speed, pwm", "cmd_vel, drive, speed, pwm"])
def test_a_chain_begins_when_the_message_of_its_topic_is_queued_for_the_wire(app, path):
    described = app(path)
    first, *_, last = events_of(described)
    assert (first.change, last.process) == (ProcessChange.ACTIVATE, "pwm")
    transmission = described.system.transmissions[first.process]
    assert (transmission.callback, transmission.direction) == ("drive", Direction.TO_CONTROLLER)


def test_a_chain_ends_when_the_message_of_its_topic_has_passed_the_wire(app):
    described = app("/cmd_vel, drive, /odom")
    *_, last = events_of(described)
    transmission = described.system.transmissions[last.process]
    assert (last.change, transmission.callback, transmission.direction) == (
        ProcessChange.TERMINATE,
        "drive",
        Direction.TO_AGENT,
    )


def test_a_topic_in_the_middle_is_sent_and_received(app):
    described = app("/cmd_vel, drive, /odom, log")
    on_wire = [event.process for event in events_of(described) if isinstance(event, ProcessEvent)]
    callbacks = [described.system.transmissions[name].callback for name in on_wire]
    assert callbacks == ["drive", "drive", "log"]
    way = analyze_system(described.system).chains["way"]
    # There, back, and to log; the agent takes 1 ms each time.
    assert [hop.worst for hop in way.hops if hop.kind == "agent"] == [10**9] * 3
    assert way.worst == sum(hop.worst for hop in way.hops)


def test_a_callback_that_the_path_leaves_out_is_on_the_way(app):
    events = events_of(app("/cmd_vel, speed, pwm"))
    assert "Executor" in {event.process for event in events if isinstance(event, RunnableEvent)}


def test_a_task_of_a_callback_gets_its_messages_from_the_executor(app):
    described = app("/halt, stop, stopped, brake", stop="writes: [stopped], runs_in: own-task")
    way = analyze_system(described.system).chains["way"]
    assert [hop.kind for hop in way.hops] == ["agent", "wire", "executor", "tasks"]
    assert way.worst is not None


def test_an_executor_without_a_loop_looks_for_messages_in_each_job(app):
    described = app("/halt, stop, stopped, brake", executor=PERIODIC)
    way = analyze_system(described.system).chains["way"]
    assert [hop.kind for hop in way.hops] == ["agent", "wire", "polling"]
    wait, _ = way.hops[-1].parts
    # A message that comes just after a job has begun waits for the period.
    assert wait.most == 10**9
    assert any("'Executor' takes each message" in sentence for sentence in way.assumptions)


def test_without_a_transport_the_latency_is_unknown(app):
    described = app("/cmd_vel, drive, speed, pwm", transport="", own="pose")
    assert [(each.rule, each.location.line) for each in described.findings if each.rule.startswith("CHN")] == [("CHN010", 21)]
    assert isinstance(events_of(described)[0], CustomEvent)
    assert "describe 'transport'" in analyze_system(described.system).chains["way"].reason


@pytest.mark.parametrize(
    ("path", "rule", "message"),
    [
        ("/cmd_vl, drive", "APP001", "undefined topic '/cmd_vl'"),
        ("/cmd_vel", "APP004", "the path only has the topic '/cmd_vel'"),
        ("drive, /cmd_vel", "CHN011", "no callback publishes '/cmd_vel'"),
        ("/odom, pwm", "CHN011", "more than one callback receives '/odom': 'on_odom', 'log'"),
        ("/cmd_vel, pwm, drive", "CHN011", "'pwm' does not receive '/cmd_vel'"),
        ("drive, pwm, /odom", "CHN011", "'pwm' does not publish '/odom'"),
    ],
)
def test_a_topic_that_is_out_of_place(author, path, rule, message):
    text = TEXT.format(path=path, executor=LOOP, transport=SERIAL, stop="writes: [stopped]", own="odom")
    assert (21, rule, message) in author.findings(text)


def test_own_messages_without_a_transport_are_refused(author):
    # The subscriptions state 4 Hz, but `drive` publishes whenever it is called, and the time on the wire is unknown.
    text = TEXT.format(path="/cmd_vel, drive", executor=LOOP, transport="", stop="writes: [stopped]", own="odom")
    refused = [message for _, rule, message in author.findings(text) if rule == "APP003"]
    assert refused == [
        f"'{name}' receives 'odom', which is published here, too, but no wire is described on which it comes"
        for name in ("on_odom", "log")
    ]
