"""The rules on event chains, against what the analysis of chains takes as carrying an effect."""

import re
from itertools import permutations

import pytest
from effort import every, examples
from excerpts import access, call, found, runnable
from hand_made_systems import of_parts
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT, analysis_of, corpus, hand_written

from amalthea_uros import build_model, check, load
from amalthea_uros.errors import ReadError, UnknownError
from amalthea_uros.perf.activities import (
    AccessKind,
    Call,
    Demand,
    Execute,
    Group,
    LabelAccess,
    RaiseEvent,
    Receive,
    Send,
    Trigger,
)
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.events import (
    ChannelChange,
    ChannelEvent,
    CustomEvent,
    EventChain,
    Events,
    LabelChange,
    LabelEvent,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
    StimulusEvent,
)
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import Channel, Label, Runnable, Task
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess, Periodic
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.dataflow.routes import UnlinkedError, routes
from amalthea_uros.units import MILLISECOND as MS

RULE = "TIM-CHAIN-CARRIED"


def told_by_analysis(analysis):
    """(chain, from, to) where nothing carries, and the chains that are not evaluated."""
    gaps, skipped = set(), set()
    for finding in analysis.findings:
        if finding.rule == "CHN002":
            gaps.add(tuple(re.findall(r"'([^']*)'", finding.message)))
        elif finding.rule in ("CHN001", "CHN004"):
            skipped.add(finding.object)
    return gaps, skipped


def told_by_rule(read):
    """The same by the rule."""
    messages = [(finding.object.split(".")[0], *re.findall(r"'([^']*)'", finding.message)) for finding in check(read, [RULE])]
    return set(messages)


SAMPLES = [pytest.param(path, id=path.name) for path in sorted((ROOT / "samples").glob("*.amxmi"))]


@pytest.mark.parametrize("path", [*SAMPLES, *every(3, corpus()), *hand_written()])
def test_the_gaps_are_those_of_the_analysis(path):
    try:
        read = load(path)
    except ReadError:
        pytest.skip("the file cannot be read")
    gaps, skipped = told_by_analysis(analysis_of(path))
    assert {gap for gap in told_by_rule(read) if gap[0] not in skipped} == gaps


# Random systems

RUNNABLES, LABELS, CHANNELS = ["R0", "R1", "R2"], ["L0", "L1"], ["C0"]
TASKS = ["T0", "T1", "T2"]


def bodies(runnables):
    single = [
        st.builds(LabelAccess, label=st.sampled_from(LABELS), kind=st.sampled_from(AccessKind)),
        st.builds(Send, channel=st.just("C0"), elements=st.just(1)),
        st.builds(Receive, channel=st.just("C0"), elements=st.just(1)),
        st.builds(Trigger, stimulus=st.just("triggered")),
        st.builds(RaiseEvent, event=st.just("custom")),
        st.just(Execute(demand=Demand(Constant(1)))),
    ]
    if runnables:
        single.append(st.builds(Call, runnable=st.sampled_from(runnables)))
        single.append(st.builds(Call, runnable=st.sampled_from(runnables)))
    activities = st.lists(st.one_of(single), max_size=3).map(tuple)
    return st.builds(lambda before, inner: (*before, Group(activities=inner)), activities, activities)


def event(name):
    """An event of any kind that occurs in jobs."""
    process, runnable = st.sampled_from(TASKS), st.sampled_from(RUNNABLES)
    anyone, named = st.none() | process, st.just(name)
    moments = st.sampled_from([ProcessChange.ACTIVATE, ProcessChange.START, ProcessChange.TERMINATE])
    ends = st.sampled_from([RunnableChange.START, RunnableChange.TERMINATE])
    label = {"label": st.sampled_from(LABELS), "runnable": st.none() | runnable, "process": anyone}
    return st.one_of(
        st.builds(ProcessEvent, name=named, process=process, change=moments),
        st.builds(RunnableEvent, name=named, runnable=runnable, process=anyone, change=ends),
        st.builds(LabelEvent, name=named, change=st.none() | st.sampled_from(LabelChange), **label),
        st.builds(ChannelEvent, name=named, channel=st.just("C0"), change=st.none() | st.sampled_from(ChannelChange)),
        st.builds(StimulusEvent, name=named, stimulus=st.sampled_from(["periodic", "triggered"])),
    )


@st.composite
def systems(draw):
    every = (*(draw(event(f"E{number}")) for number in range(draw(st.integers(2, 4)))), CustomEvent(name="custom"))
    pairs = list(permutations([event.name for event in every], 2))
    chains = tuple(EventChain(name=f"{first} to {then}", stimulus=first, response=then) for first, then in pairs)
    stimuli = {"T0": ("periodic",), "T1": ("triggered",), "T2": ("reacting",)}
    return of_parts(
        [Task(name=task, stimuli=stimuli[task], activities=draw(bodies(RUNNABLES))) for task in TASKS],
        [TaskAllocation(task=task, scheduler="core", priority=n) for n, task in enumerate(TASKS)],
        [
            Periodic(name="periodic", period=10 * MS),
            InterProcess(name="triggered"),
            EventTriggered(name="reacting", events=("custom",)),
        ],
        runnables=[Runnable(name=name, activities=draw(bodies(RUNNABLES[:n]))) for n, name in enumerate(RUNNABLES)],
        labels=[Label(name=name) for name in LABELS],
        channels=[Channel(name=name) for name in CHANNELS],
        events=Events(events=every, chains=chains),
    )


@examples(8)
@given(systems())
def test_the_gaps_of_random_chains(system):
    dataflow = Dataflow(system)
    found = told_by_rule(build_model(system))
    for chain in system.events.chains:
        first, then = (system.events_by_name[name] for name in (chain.stimulus, chain.response))
        try:
            routes([first, then], dataflow)
            is_gap = False
        except UnlinkedError:
            is_gap = True
        except UnknownError:
            continue
        is_told = (chain.name, first.name, then.name) in found
        assert is_told is is_gap


# What the analysis does not know of, or sees otherwise

EVENTS = {
    "start of T": '<events t="ProcessEvent" name="start of T" eventType="start" entity="T?type=Task"/>',
    "end of U": '<events t="ProcessEvent" name="end of U" eventType="terminate" entity="U?type=Task"/>',
    "start of R": '<events t="RunnableEvent" name="start of R" eventType="start" entity="R?type=Runnable"/>',
    "end of R": '<events t="RunnableEvent" name="end of R" eventType="terminate" entity="R?type=Runnable"/>',
    "L is written": '<events t="LabelEvent" name="L is written" eventType="write" entity="L?type=Label"/>',
    "L is read": '<events t="LabelEvent" name="L is read" eventType="read" entity="L?type=Label"/>',
    "any of T": '<events t="ProcessEvent" name="any of T" entity="T?type=Task"/>',
}


def reference(event):
    kind = re.search(r' t="(\w+)"', EVENTS[event])[1]
    return f"{event.replace(' ', '+')}?type={kind}"


def chain(first, then, items="", attributes=""):
    """A chain, or a part of one; an end that is None is not stated."""
    ends = [f'{name}="{reference(end)}"' for name, end in (("stimulus", first), ("response", then)) if end]
    return f"{' '.join(ends)} {attributes}>{items}"


def part(first, then, items="", attributes=""):
    return f'<items t="EventChainContainer"><eventChain {chain(first, then, items, attributes)}</eventChain></items>'


def system(first="", then="", *, others="", stimulus="", chains=None, events=""):
    """What T and U do, and a chain from the start of T to the end of U."""
    chains = chains or f'<eventChains name="C" {chain("start of T", "end of U")}</eventChains>'
    return f"""
<eventModel>{"".join(EVENTS.values())}{events}</eventModel>
<stimuliModel>
  <stimuli t="EventStimulus" name="by L" triggeringEvents="{reference("L is written")}"/>
  <stimuli t="EventStimulus" name="by R" triggeringEvents="{reference("end of R")}"/>
</stimuliModel>
<swModel>
  <tasks name="T"><activityGraph>{first}</activityGraph></tasks>
  <tasks name="U" stimuli="{stimulus}"><activityGraph>{then}</activityGraph></tasks>
  {others}
  <labels name="L"/><labels name="M"/>
  <events name="E"/><events name="F"/>
  <modes t="NumericMode" name="N"/>
  <modeLabels name="K" mode="N?type=NumericMode"/>
</swModel>
<constraintsModel>{chains}</constraintsModel>"""


def mask(kind, events="E?type=OsEvent", attributes=""):
    return f'<items t="{kind}" {attributes}><eventMask events="{events}"/></items>'


CALL = call("R")
SERVER = '<items t="{}" serverRunnable="R?type=Runnable"/>'
SET_MODE = '<items t="ModeLabelAccess" data="K?type=ModeLabel" access="set" value="1"/>'
IS_ONE = '<entries t="ModeValueCondition" label="K?type=ModeLabel" relation="EQUAL" value="1"/>'
SWITCH = f'<items t="Switch"><entries name="one"><condition>{IS_ONE}</condition></entries></items>'
GAP = ["no data flow or trigger connects 'start of T' to 'end of U'"]


@pytest.mark.parametrize(
    ("excerpt", "expected"),
    [
        (system(), GAP),
        (system(access("write"), access("read")), []),
        (system(access("read"), access("write")), GAP),
        (system(access("write"), access("read", label="M")), GAP),
        # Data in runnables, and by sender-receiver communication.
        (system(CALL, access("read"), others=runnable("R", access("write"))), []),
        (
            system(
                '<items t="SenderReceiverWrite" label="L?type=Label"/>', '<items t="SenderReceiverRead" label="L?type=Label"/>'
            ),
            [],
        ),
        # A mode that is set, and on which a branch or a runnable depends.
        (system(SET_MODE, SWITCH), []),
        (system("", SWITCH), GAP),
        (
            system(SET_MODE, CALL, others=f'<runnables name="R"><executionCondition>{IS_ONE}</executionCondition></runnables>'),
            [],
        ),
        # Events of the operating system: for all, or for one process.
        (system(mask("SetEvent"), mask("WaitEvent")), []),
        (system(mask("SetEvent", attributes='process="U?type=Task"'), mask("WaitEvent")), []),
        (system(mask("SetEvent", attributes='process="T?type=Task"'), mask("WaitEvent")), GAP),
        (system(mask("SetEvent"), mask("WaitEvent", "F?type=OsEvent")), GAP),
        (system(mask("ClearEvent"), mask("WaitEvent")), GAP),
        # Events that activate: an access, the end of a runnable.
        (system(access("write"), "", stimulus="by+L?type=EventStimulus"), []),
        (system(access("read"), "", stimulus="by+L?type=EventStimulus"), GAP),
        (system(CALL, "", stimulus="by+R?type=EventStimulus", others=runnable("R")), []),
        # A client and its server, and back.
        (system(SERVER.format("SynchronousServerCall"), CALL, others=runnable("R")), []),
        (system(CALL, SERVER.format("GetResultServerCall"), others=runnable("R")), []),
        (system(SERVER.format("SynchronousServerCall"), "", others=runnable("R")), GAP),
    ],
)
def test_what_carries(excerpt, expected, tmp_path):
    assert found(RULE, excerpt, tmp_path) == expected


def gap(first, then):
    return [f"no data flow or trigger connects {first!r} to {then!r}"]


@pytest.mark.parametrize(
    ("first", "then", "is_carried"),
    [
        ("start of R", "L is written", True),
        ("L is written", "end of R", True),
        # What is written may take effect at the end.
        ("end of R", "L is written", False),
        ("L is written", "start of R", False),
        ("end of R", "start of R", False),
        ("start of T", "end of R", True),
        ("end of R", "start of T", False),
        ("start of R", "start of R", True),
        # Whatever moment it is.
        ("any of T", "end of U", False),
        # What occurs nowhere is not judged.
        ("L is read", "end of U", True),
        (None, "end of U", True),
        ("start of T", None, True),
    ],
)
def test_the_order_within_a_job(first, then, is_carried, tmp_path):
    chains = f'<eventChains name="C" {chain(first, then)}</eventChains>'
    excerpt = system(CALL, others=runnable("R", access("write")), chains=chains)
    assert found(RULE, excerpt, tmp_path) == ([] if is_carried else gap(first, then))


def test_a_runnable_that_is_called_again_may_come_before_itself(tmp_path):
    chains = f'<eventChains name="C" {chain("end of R", "start of R")}</eventChains>'
    assert found(RULE, system(CALL + CALL, others=runnable("R"), chains=chains), tmp_path) == []


CARRIED = (access("write"), access("read"))
A, B, W, D = "start of T", "end of U", "L is written", "L is read"


@pytest.mark.parametrize(
    ("items", "attributes", "expected"),
    [
        (part(A, W) + part(W, D) + part(D, B), 'itemType="sequence"', []),
        (part(A, W) + part(D, B), "", []),
        # From one segment to the next.
        (part(A, D) + part(W, B), "", gap(D, W)),
        (part(A, D) + part(W, B), 'itemType="parallel"', []),
        (part(A, B) + part(A, B), 'itemType="parallel"', []),
        (part(W, A) + part(A, B), "", gap(W, A)),
        ('<items t="EventChainContainer"/><items t="EventChainReference"/>', "", []),
        # A chain that is part of itself ends nowhere.
        ('<items t="EventChainReference" eventChain="C?type=EventChain"/>', "", []),
    ],
)
def test_the_parts_of_a_chain(items, attributes, expected, tmp_path):
    chains = f'<eventChains name="C" {chain(A, B, items, attributes)}</eventChains>'
    # D comes behind W, in another task; nothing leads from U back to T.
    told = found(RULE, system(*CARRIED, chains=chains), tmp_path)
    assert sorted(told) == sorted(expected)


def test_branches_that_start_elsewhere_than_their_chain(tmp_path):
    branches = chain(B, B, part(A, A), 'itemType="parallel"')
    chains = f'<eventChains name="C" {branches}</eventChains>'
    assert found(RULE, system(*CARRIED, chains=chains), tmp_path) == gap(B, A)


def test_sets_of_events(tmp_path):
    events = '<events t="EventSet" name="all" events="start+of+T?type=ProcessEvent L+is+written?type=LabelEvent"/>'
    chains = f'<eventChains name="C" stimulus="all?type=EventSet" response="{reference(B)}"/>'
    assert found(RULE, system(*CARRIED, chains=chains, events=events), tmp_path) == []
    assert found(RULE, system(access("write"), chains=chains, events=events), tmp_path) == gap(A, B) + gap(W, B)


def test_many_candidates_are_not_tried(tmp_path):
    # 200 tasks that write and 200 that read something else: more pairs than are looked at.
    tasks = "".join(
        f'<tasks name="{kind}{number}"><activityGraph>{access(kind)}</activityGraph></tasks>'
        for number in range(200)
        for kind in ("write", "read")
    )
    chains = f'<eventChains name="C" {chain(D, W)}</eventChains>'
    assert found(RULE, system(others=tasks, chains=chains), tmp_path) == []
    few = tasks[: tasks.index('<tasks name="write1"')]
    assert found(RULE, system(others=few, chains=chains), tmp_path) == gap(D, W)


# Clocks


def controllers(kinds, items="", second="core1", events="sent got"):
    """T on the core 0, U on a core, in structures of some kinds."""
    first, then = events.split()
    return f"""
<eventModel>
  <events t="ProcessEvent" name="sent" eventType="terminate" entity="T?type=Task"/>
  <events t="ProcessEvent" name="got" eventType="start" entity="U?type=Task"/>
  <events t="EventSet" name="both" events="sent?type=ProcessEvent got?type=ProcessEvent"/>
</eventModel>
<swModel><tasks name="T"/><tasks name="U"/></swModel>
<hwModel>
  <structures name="car" structureType="System">
    <structures name="A" structureType="{kinds[0]}">
      <structures name="chip" structureType="Microcontroller"><modules t="ProcessingUnit" name="core0"/></structures>
    </structures>
    <structures name="B" structureType="{kinds[1]}"><modules t="ProcessingUnit" name="core1"/></structures>
  </structures>
</hwModel>
<osModel>
  <operatingSystems name="OS"><taskSchedulers name="S0"/><taskSchedulers name="S1"/></operatingSystems>
</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S0?type=TaskScheduler" responsibility="core0?type=ProcessingUnit"/>
  <schedulerAllocation scheduler="S1?type=TaskScheduler" responsibility="{second}?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S0?type=TaskScheduler"/>
  <taskAllocation task="U?type=Task" scheduler="S1?type=TaskScheduler"/>
</mappingModel>
<constraintsModel>
  <eventChains name="C" stimulus="{first}" response="{then}">{items}</eventChains>
</constraintsModel>"""


SENT, GOT, BOTH = "sent?type=ProcessEvent", "got?type=ProcessEvent", "both?type=EventSet"
TOLD = ["'C' goes through 'A' and 'B', which have no common clock"]


@pytest.mark.parametrize(
    ("excerpt", "expected"),
    [
        (controllers(("ECU", "ECU"), events=f"{SENT} {GOT}"), TOLD),
        (controllers(("ECU", "ECU"), events=f"{SENT} {SENT}"), []),
        (controllers(("ECU", "ECU"), events=f"{SENT} {GOT}", second="core0"), []),
        (controllers(("Microcontroller", "Microcontroller"), events=f"{SENT} {GOT}"), []),
        # Of a core outside of all controllers nothing is known.
        (controllers(("ECU", "Microcontroller"), events=f"{SENT} {GOT}"), []),
        # Nor of a task that may be here or there.
        (controllers(("ECU", "ECU"), events=f"{SENT} {GOT}", second="core0?type=ProcessingUnit core1"), []),
        (controllers(("ECU", "ECU"), events=f"{SENT} {BOTH}"), TOLD),
        (
            controllers(
                ("ECU", "ECU"),
                f'<items t="EventChainContainer"><eventChain stimulus="{SENT}" response="{GOT}"/></items>',
                events=f"{SENT} {SENT}",
            ),
            TOLD,
        ),
        (
            controllers(
                ("ECU", "ECU"), '<items t="EventChainReference" eventChain="C?type=EventChain"/>', events=f"{SENT} {SENT}"
            ),
            [],
        ),
    ],
)
def test_chains_through_several_controllers(excerpt, expected, tmp_path):
    assert found("TIM-SEPARATE-CLOCKS", excerpt, tmp_path) == expected
