"""What takes an effect from one process to another has one answer: paths, analysis and check agree on it."""

import textwrap

import pytest
from opponent.models import writing
from opponent.models.writing import Parts

from amalthea_uros import analyze_files, check_files
from amalthea_uros.services.chains import find_paths

PERIODIC = "every?type=PeriodicStimulus"
BY_EVENT = "reaction?type=EventStimulus"


def two_tasks(write, read, trigger=PERIODIC):
    """A task that writes a label, and one that takes it in some way or other; a chain from the one to the other."""
    parts = Parts(cores={"C": "100.0"}, schedulers=[writing.scheduler("S", "FixedPriorityPreemptive")])
    parts.allocations.append(writing.scheduler_allocation("S", "C"))
    for name, stimulus, activity in (("Writer", PERIODIC, write), ("Reader", trigger, read)):
        parts.tasks.append(writing.task(name, stimulus, writing.ticks(100, 100) + activity))
        parts.allocations.append(writing.task_allocation(name, "S", {}))
    parts.data.append(writing.label("L"))
    parts.stimuli.append(writing.stimulus("Periodic", "every", "", writing.time("recurrence", 10_000)))
    if trigger == BY_EVENT:
        parts.stimuli.append(writing.stimulus("Event", "reaction", 'triggeringEvents="written?type=LabelEvent"'))
    parts.events += [
        writing.process_event("in", "Writer", "Task", "start"),
        writing.process_event("out", "Reader", "Task", "terminate"),
        '<events xsi:type="am:LabelEvent" name="written" eventType="write" entity="L?type=Label"/>',
    ]
    parts.chains.append(writing.chain("chain", "in?type=ProcessEvent", "out?type=ProcessEvent", ()))
    return parts.text()


def access(kind):
    return writing.item("LabelAccess", f'data="L?type=Label" access="{kind}"')


def sender_receiver(kind):
    return writing.item(f"SenderReceiver{kind}", 'label="L?type=Label"')


def answers(path, start, end):
    """What links the processes of each path, how the analysis describes the chain, and what is found about its links."""
    (chain,) = analyze_files(path).analysis.chains
    rules = {finding.rule for finding in check_files(path).findings}
    return {
        "paths": [found.links for found in find_paths(path, start, end).paths],
        "routes": chain.routes,
        "gaps": rules & {"TIM-CHAIN-CARRIED", "UR130"},
    }


@pytest.mark.parametrize(
    ("model", "links", "link"),
    [
        (two_tasks(access("write"), access("read")), ("L",), "data L"),
        (two_tasks(sender_receiver("Write"), sender_receiver("Read")), ("L",), "data L"),
        (two_tasks(access("write"), "", BY_EVENT), ("reaction",), "a trigger reaction"),
        (two_tasks(sender_receiver("Write"), "", BY_EVENT), ("reaction",), "a trigger reaction"),
    ],
    ids=["label", "sender-receiver", "event stimulus", "event stimulus on sender-receiver"],
)
def test_a_link_in_a_model(model, links, link, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(model)
    assert answers(path, "Writer", "Reader") == {"paths": [(links,)], "routes": (f"in -[{link}]-> out",), "gaps": set()}


@pytest.mark.parametrize("model", [two_tasks("", access("read")), two_tasks(access("write"), "")])
def test_no_link_in_a_model(model, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(model)
    found = answers(path, "Writer", "Reader")
    assert found == {"paths": [], "routes": (), "gaps": {"TIM-CHAIN-CARRIED"}}


APPLICATION = """
    amuros: 1
    name: loop
    hardware: {platform: bodas-rc18-12-40}
    middleware: {executor: {callbacks: CALLBACKS}}
    application:
      nodes:
        - name: node
          publishers: [{topic: state, message_size: 8 B, reliability: best-effort}]
          timers: [{name: Publish, period: 100 ms, execution_time: 40 us, publishes: [state]}]
          subscriptions:
            - {name: On_State, topic: TOPIC, rate: 10 Hz, message_size: 8 B, reliability: best-effort, execution_time: 30 us}
    chains:
      - {name: loop, path: [Publish, On_State], reaction: {max: 10 s}}
"""


def application(folder, callbacks, topic):
    path = folder / "app.yaml"
    path.write_text(textwrap.dedent(APPLICATION).lstrip().replace("CALLBACKS", callbacks).replace("TOPIC", topic))
    return path


@pytest.mark.parametrize(
    ("callbacks", "ends", "routes", "links"),
    [
        (
            "own-task",
            ("Publish", "On_State"),
            "Publish_start -[a message state_topic]-> Take_On_State_finish -[data On_State_message]-> On_State_finish",
            (("state_topic",), ("On_State_message",)),
        ),
        (
            "in-executor",
            ("Publish_Callback", "On_State_Callback"),
            "Publish_start -[a message state_topic]-> Take_On_State_finish -[the same job]-> On_State_finish",
            (("state_topic",),),
        ),
    ],
)
def test_a_topic_within_an_application(callbacks, ends, routes, links, tmp_path):
    path = application(tmp_path, callbacks, "state")
    assert answers(path, *ends) == {"paths": [links], "routes": (routes,), "gaps": set()}
    # The message passes the agent: nobody stated how long that takes, so that no limit is met.
    analysis = analyze_files(path).analysis
    (requirement,) = analysis.requirements
    assert (requirement.verdict, analysis.chains["loop"].values) == ("unknown", ())
    assert "leaves the system" in requirement.reason


def test_another_topic_than_that_of_the_application(tmp_path):
    found = answers(application(tmp_path, "own-task", "other"), "Publish", "On_State")
    assert (found["paths"], found["gaps"]) == ([], {"TIM-CHAIN-CARRIED", "UR130"})
