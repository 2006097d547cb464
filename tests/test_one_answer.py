"""What takes an effect from one process to another has one answer: paths, analysis and check agree on it."""

import textwrap

import pytest
from support import MODEL

from amalthea_uros import analyze_files, check_files
from amalthea_uros.services.chains import find_paths

RATE = '<stimuli xsi:type="am:PeriodicStimulus" name="every 10 ms"><recurrence value="10" unit="ms"/></stimuli>'
PLATFORM = """
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="PU"/>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="C" frequencyDomain="F?type=FrequencyDomain"
      definition="PU?type=ProcessingUnitDefinition"/>
  </structures>
  <domains xsi:type="am:FrequencyDomain" name="F"><defaultValue value="100" unit="MHz"/></domains>
</hwModel>
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"><schedulingAlgorithm xsi:type="am:FixedPriorityPreemptive"/></taskSchedulers>
  </operatingSystems>
</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="C?type=ProcessingUnit"/>
  <taskAllocation task="Writer?type=Task" scheduler="S?type=TaskScheduler" schedulingParameters="p"/>
  <taskAllocation task="Reader?type=Task" scheduler="S?type=TaskScheduler" schedulingParameters="p"/>
</mappingModel>
"""
CHAIN = """
<eventModel>
  <events xsi:type="am:ProcessEvent" name="in" eventType="start" entity="Writer?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="out" eventType="terminate" entity="Reader?type=Task"/>
  <events xsi:type="am:LabelEvent" name="written" eventType="write" entity="L?type=Label"/>
</eventModel>
<constraintsModel>
  <eventChains name="chain" stimulus="in?type=ProcessEvent" response="out?type=ProcessEvent"/>
</constraintsModel>
"""


def two_tasks(write, read, stimulus, more=""):
    """A task that writes a label, and one that takes it in some way or other."""
    ticks = '<items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="100"/></items>'
    tasks = "".join(
        f'<tasks name="{name}" stimuli="{trigger}"><activityGraph>{ticks}{activity}</activityGraph></tasks>'
        for name, trigger, activity in (
            ("Writer", "every+10+ms?type=PeriodicStimulus", write),
            ("Reader", stimulus, read),
        )
    )
    software = f'<swModel>{tasks}<labels name="L"/></swModel>'
    return MODEL.format(
        software + PLATFORM.replace(' schedulingParameters="p"', "") + f"<stimuliModel>{RATE}{more}</stimuliModel>" + CHAIN
    )


def access(kind):
    return f'<items xsi:type="am:LabelAccess" data="L?type=Label" access="{kind}"/>'


def sender_receiver(kind):
    return f'<items xsi:type="am:SenderReceiver{kind}" label="L?type=Label"/>'


PERIODIC = "every+10+ms?type=PeriodicStimulus"
REACTION = '<stimuli xsi:type="am:EventStimulus" name="reaction" triggeringEvents="written?type=LabelEvent"/>'


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
        (two_tasks(access("write"), access("read"), PERIODIC), ("L",), "data L"),
        (two_tasks(sender_receiver("Write"), sender_receiver("Read"), PERIODIC), ("L",), "data L"),
        (two_tasks(access("write"), "", "reaction?type=EventStimulus", REACTION), ("reaction",), "a trigger reaction"),
        (two_tasks(sender_receiver("Write"), "", "reaction?type=EventStimulus", REACTION), ("reaction",), "a trigger reaction"),
    ],
    ids=["label", "sender-receiver", "event stimulus", "event stimulus on sender-receiver"],
)
def test_a_link_in_a_model(model, links, link, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(model)
    assert answers(path, "Writer", "Reader") == {"paths": [(links,)], "routes": (f"in -[{link}]-> out",), "gaps": set()}


@pytest.mark.parametrize("model", [two_tasks("", access("read"), PERIODIC), two_tasks(access("write"), "", PERIODIC)])
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
    (requirement,) = analyze_files(path).analysis.requirements
    assert (requirement.verdict, analyze_files(path).analysis.chains["loop"].values) == ("unknown", ())
    assert "leaves the system" in requirement.reason


@pytest.mark.parametrize(("callbacks", "ends"), [("own-task", ("Publish", "On_State"))])
def test_another_topic_than_that_of_the_application(callbacks, ends, tmp_path):
    found = answers(application(tmp_path, callbacks, "other"), *ends)
    assert (found["paths"], found["gaps"]) == ([], {"TIM-CHAIN-CARRIED", "UR130"})
