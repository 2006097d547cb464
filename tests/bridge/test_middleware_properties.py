"""Executors and the network are kept in models, as properties; what cannot be read is a finding and never taken for less."""

from dataclasses import replace

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from migration import model

from amalthea_uros.bridge.basics.json_text import from_text, to_text, typed_value
from amalthea_uros.bridge.basics.middleware_flaws import flaw_of_executor, flaw_of_host
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.diagnostics import Location
from amalthea_uros.errors import UnknownError, WriteError
from amalthea_uros.metamodel import classes as am
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, LoopKind, ThreadLoop, TriggerCondition, TriggerKind
from amalthea_uros.perf.hardware import Core, Hardware, Structure
from amalthea_uros.perf.host import Host, HostCallback, HostComputer, HostExecutor, HostTopic
from amalthea_uros.perf.network import Direction, Losses, Network, Purpose, Recovery, Span, Transmission, Wire, WireKind
from amalthea_uros.perf.software import Runnable, Software, Task
from amalthea_uros.perf.stimuli import Custom
from amalthea_uros.perf.system import System
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save

EXECUTOR = Executor(
    name="Main loop",
    task="Main",
    spin="Spin",
    loop=ThreadLoop(kind=LoopKind.SLEEPING, timeout=10**11, sleep=10**10),
    handles=(
        Handle(name='A "quoted"\tname', kind=HandleKind.SUBSCRIPTION, runnable="On_A", take="Take", interval=None, always=True),
        Handle(name="ü", kind=HandleKind.TIMER, runnable="On_A", interval=2**60 + 1, phase=0),
    ),
    trigger=TriggerCondition(kind=TriggerKind.CUSTOM, sets=(frozenset({"b", "a"}), frozenset())),
)
NETWORK = Network(
    agent="Agent of mine",
    wires=(
        Wire(
            name="W",
            kind=WireKind.SERIAL,
            cores=("C",),
            loses_messages=True,
            losses=(
                Losses(directions=(Direction.TO_AGENT,), count=1, window=10**13),
                Losses(directions=(Direction.TO_CONTROLLER,), per_billion=10**6),
            ),
            recovery=Recovery(asks_after=10**11, agent_asks_every=2 * 10**11, sent_parts=4),
        ),
    ),
    transmissions=(
        Transmission(
            name="Sent", wire="W", direction=Direction.TO_AGENT, purpose=Purpose.DATA, topic="t", length=20, processes=("Main",)
        ),
        Transmission(name="Received", wire="W", direction=Direction.TO_CONTROLLER, agent=Span(least=5, most=7)),
    ),
)
SYSTEM = System(
    hardware=Hardware(structures=(Structure(name="S", cores=(Core(name="C"),)),)),
    software=Software(
        tasks=(Task(name="Main"), Task(name="Sent"), Task(name="Received")),
        runnables=(Runnable(name="Spin"), Runnable(name="On_A"), Runnable(name="Take")),
    ),
    executors=(EXECUTOR,),
    network=NETWORK,
)


st.register_type_strategy(Location, st.none())  # where something comes from has no part in what it is
st.register_type_strategy(int, st.integers(-(2**63) + 1, 2**63 - 1))  # others are refused when they are read
EXECUTORS, NETWORKS = st.from_type(Executor), st.from_type(Network)


def extracted(system, path, change=lambda text: text):
    """What a file of a system is extracted to, with its text changed before it is read."""
    save(build_model(system), path)
    path.write_text(change(path.read_text()))
    return extract(load(path))


def test_executors_and_the_network_come_back(tmp_path):
    found = extracted(SYSTEM, tmp_path / "model.amxmi")
    assert found.findings == ()
    assert found.system == SYSTEM
    assert found.system.executors[0].origin.path == tmp_path / "model.amxmi"


def test_acknowledgements_in_files_of_the_first_builds_are_known_by_their_names(tmp_path):
    name = "Sent_acknowledgement"
    unnamed = Transmission(name=name, wire="W", direction=Direction.TO_CONTROLLER, purpose=Purpose.ACKNOWLEDGEMENT)
    tasks = (*SYSTEM.software.tasks, Task(name=name))
    network = replace(NETWORK, transmissions=(*NETWORK.transmissions, unnamed))
    older = replace(SYSTEM, software=replace(SYSTEM.software, tasks=tasks), network=network)
    found = extracted(older, tmp_path / "model.amxmi").system
    assert [each.acknowledges for each in found.network.transmissions] == [None, None, "Sent"]


@given(data=st.data())
@examples(8)
def test_any_executor_comes_back_from_its_text(data):
    executor = data.draw(EXECUTORS)
    assert from_text(Executor, to_text(executor, without=("task",)), task=executor.task) == executor
    network = data.draw(NETWORKS)
    assert from_text(Network, to_text(network)) == network


def test_a_system_without_them_has_no_properties():
    model = build_model(replace(SYSTEM, executors=(), network=Network()))
    assert not [element for element in model.walk() if isinstance(element, am.CustomProperty)]


def test_an_executor_needs_its_task():
    with pytest.raises(WriteError, match="undefined process 'Gone'"):
        build_model(replace(SYSTEM, executors=(replace(EXECUTOR, task="Gone"),)))


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("&quot;spin&quot;:&quot;Spin&quot;", "&quot;spin&quot;:1", "Executor.spin is not of type str"),
        ("&quot;spin&quot;:&quot;Spin&quot;", "&quot;spin&quot;:&quot;Gone&quot;", "undefined runnable 'Gone'"),
        ("&quot;spin&quot;:&quot;Spin&quot;,", "", "Executor needs 'spin'"),
        ("&quot;spin&quot;:", "&quot;spun&quot;:1,&quot;spin&quot;:", "Executor has no 'spun'"),
        ("&quot;always&quot;:true", "&quot;always&quot;:1", "Handle.always is not of type bool"),
        ("spin_some", "spin_more", "'spin_more' is not a value of ThreadLoop.kind"),
        ("[&quot;a&quot;,&quot;b&quot;]", "[[],&quot;b&quot;]", "TriggerCondition.sets is not of type str"),
        ("[&quot;a&quot;,&quot;b&quot;]", "3", "TriggerCondition.sets is not a list"),
        ("{&quot;name&quot;:&quot;Main loop", "{", "not valid JSON"),
        # Such a loop would begin its next iteration before it ends the last one.
        (
            f"&quot;sleep&quot;:{10**10}",
            f"&quot;sleep&quot;:{10**10},&quot;sleep_early&quot;:{10**10 + 1}",
            "by more than its time",
        ),
        (f"&quot;sleep&quot;:{10**10}", "&quot;sleep&quot;:-1", "by more than its time"),
    ],
)
def test_an_executor_that_cannot_be_read_is_a_finding_and_its_task_unknown(before, after, message, tmp_path):
    def change(text):
        assert before in text
        return text.replace(before, after)

    found = extracted(SYSTEM, tmp_path / "model.amxmi", change)
    (finding,) = [finding for finding in found.findings if finding.rule == "EXT005"]
    assert message in finding.message
    assert finding.object == "Main"
    assert found.system.executors == ()
    assert found.system.network == NETWORK
    (stimulus,) = found.system.processes["Main"].stimuli
    assert isinstance(found.system.stimuli_by_name[stimulus], Custom)


@pytest.mark.parametrize(
    ("before", "after", "message", "left"),
    [
        ("&quot;cores&quot;:[&quot;C&quot;]", "&quot;cores&quot;:[&quot;D&quot;]", "undefined core 'D'", set()),
        (
            "&quot;processes&quot;:[&quot;Main&quot;]",
            "&quot;processes&quot;:[&quot;X&quot;]",
            "undefined process 'X'",
            {"Received"},
        ),
        ("&quot;count&quot;:1", "&quot;count&quot;:0", "neither a number in a time nor a probability", set()),
        ("&quot;count&quot;:1", "&quot;count&quot;:-1", "neither a number in a time nor a probability", set()),
        ("&quot;count&quot;:1", "&quot;count&quot;:1001", "neither a number in a time nor a probability", set()),
        ("&quot;window&quot;:1", "&quot;window&quot;:-1", "neither a number in a time nor a probability", set()),
        # More than a word of memory holds, in which it would lose nothing.
        ("&quot;window&quot;:1", "&quot;window&quot;:1" + 9 * "0", "Losses.window is out of range", set()),
        ("&quot;per_billion&quot;:1", "&quot;per_billion&quot;:-1", "neither a number in a time nor a probability", set()),
        ("&quot;per_billion&quot;:1", "&quot;per_billion&quot;:1000", "neither a number in a time nor a probability", set()),
        ("&quot;directions&quot;:[&quot;to the agent&quot;]", "&quot;directions&quot;:[]", "need one direction or both", set()),
        ("&quot;asks_after&quot;:1", "&quot;asks_after&quot;:-1", "not above zero", set()),
        ("&quot;agent_asks_every&quot;:2", "&quot;agent_asks_every&quot;:-2", "not above zero", set()),
        ("&quot;sent_parts&quot;:4", "&quot;sent_parts&quot;:0", "not above zero", set()),
    ],
)
def test_a_network_that_cannot_be_read_is_a_finding(before, after, message, left, tmp_path):
    def change(text):
        assert before in text
        return text.replace(before, after)

    found = extracted(SYSTEM, tmp_path / "model.amxmi", change)
    assert message in "\n".join(finding.message for finding in found.findings)
    assert set(found.system.transmissions) == left


@pytest.mark.parametrize("text", ["", "[]", "1", "null", "{}", "[" * 100_000, '{"name": null}', '{"name": "x", "loop": []}'])
def test_no_text_is_a_crash(text):
    with pytest.raises(UnknownError):
        from_text(Executor, text, task="T")


@pytest.mark.parametrize(
    ("name", "topic", "is_old"),
    [
        ("add_request_to_Serve", "add", True),
        ("arm_add_response_from_add", "add", True),
        ("add_request_to_Serve", "add/request", False),
        ("move/_action/send_goal_request_to_Move", "move/_action/send_goal/request", False),
        ("add_topic_to_add_request_again", "add", False),
        ("any", None, False),
    ],
)
def test_messages_of_services_in_older_builds_are_findings(name, topic, is_old):
    task, core = Task(name=name), Core(name="C", type=None, clock=None)
    network = replace(
        NETWORK, transmissions=(Transmission(name=name, wire="W", direction=Direction.TO_CONTROLLER, topic=topic),)
    )
    system = System(
        hardware=Hardware(structures=(Structure(name="S", cores=(core,)),)), software=Software(tasks=(task,)), network=network
    )
    assert ("EXT006" in [each.rule for each in extract(build_model(system)).findings]) is is_old


@pytest.mark.parametrize("number", [2**63, -(2**63)])
def test_a_number_that_no_description_can_have_is_refused(number):
    with pytest.raises(UnknownError, match=r"Handle\.jitter is out of range"):
        typed_value(int, number, "Handle.jitter")


@pytest.mark.parametrize("times", [{"interval": 0}, {"interval": -1}, {"interval": 1, "jitter": -1}])
def test_messages_come_after_some_time(times):
    handle = Handle(name="H", kind=HandleKind.SUBSCRIPTION, runnable="R", **times)
    executor = Executor(name="E", task="T", spin="R", loop=ThreadLoop(kind=LoopKind.CONTINUOUS, timeout=1), handles=(handle,))
    assert "'H' is not valid" in flaw_of_executor(executor, System())
    assert flaw_of_host(Host(topics=(HostTopic(name="t", **times),))) == "the topic 't' is not valid"


def test_a_timer_of_the_host_has_a_period():
    span = Span(least=1, most=1)
    timer = HostCallback(name="C", kind=HandleKind.TIMER, execution=span, period=0)
    executor = HostExecutor(name="E", computer="c", callbacks=(timer,))
    host = Host(computers=(HostComputer(name="c", cores=1),), executors=(executor,))
    assert flaw_of_host(host) == "the callback 'C' is not valid"


def test_a_probability_is_a_number(tmp_path):
    entries = '<entries probability="1.0"/><entries probability="1e999"/>'
    task = f'<tasks name="A"><activityGraph><items t="ProbabilitySwitch">{entries}</items></activityGraph></tasks>'
    path = tmp_path / "model.amxmi"
    path.write_text(model("3.3.0", f"<swModel>{task}</swModel>"))
    result = analyze_files([path])
    assert "ProbabilitySwitch is incomplete: a probability is no number" in {finding.message for finding in result.findings}
    assert result.analysis.processes[0].response is None
