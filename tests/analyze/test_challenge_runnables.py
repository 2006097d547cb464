"""The challenge model of 2017 with its 1,250 runnables: cooperative tasks, and chains of label accesses.

The file is older than what this package reads, so that the test takes what it needs from the XML.
"""

import json
from fractions import Fraction

import pytest
from lxml import etree
from support import SHARED
from test_system import system

from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import AccessKind, Call, Communication, Demand, Execute, LabelAccess
from amalthea_uros.perf.distributions import Boundaries, Uniform
from amalthea_uros.perf.events import EventChain, Events, RunnableChange, RunnableEvent, Segment, Sequence
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import Preemption, Runnable, Task
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US

MODEL = SHARED / "corpus" / "WATERS_2017_v072.amxmi"
FIGURES = SHARED / "vectors" / "waters2017.json"
TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"

pytestmark = pytest.mark.skipif(not (MODEL.exists() and FIGURES.exists()), reason="the challenge is not at hand")


def name(reference):
    return reference.partition("?")[0]


def runnable(element):
    activities = []
    for item in element.findall("runnableItems"):
        if item.get(TYPE) == "am:LabelAccess":
            kind = AccessKind.READ if item.get("access") == "read" else AccessKind.WRITE
            activities.append(LabelAccess(label=name(item.get("data")), kind=kind))
        else:
            deviation = item.find("default/deviation")
            lower, upper = (int(deviation.find(bound).get("value")) for bound in ("lowerBound", "upperBound"))
            activities.append(Execute(demand=Demand(Boundaries(lower=lower, upper=upper))))
    return Runnable(name=element.get("name"), activities=tuple(activities))


@pytest.fixture(scope="module")
def figures():
    return json.loads(FIGURES.read_text())


@pytest.fixture(scope="module")
def built(figures):
    software = etree.parse(MODEL).getroot().find("swModel")
    rows = {row["name"]: row for row in figures["tasks"]}
    stimuli, tasks, allocations = [], [], []
    for element in software.findall("tasks"):
        row = rows[element.get("name")]
        stimulus, period = f"stimulus of {row['name']}", round(row["period_or_min_interarrival_us"] * US)
        if row["stimulus"] == "sporadic":
            upper = round(row["max_interarrival_us"] * US)
            stimuli.append(RelativePeriodic(name=stimulus, distance=Uniform(lower=period, upper=upper)))
        else:
            stimuli.append(Periodic(name=stimulus, period=period))
        calls = tuple(Call(runnable=name(call.get("runnable"))) for call in element.iter("calls"))
        how = Preemption(element.get("preemption"))
        tasks.append(Task(name=row["name"], stimuli=(stimulus,), activities=calls, preemption=how))
        allocations.append(TaskAllocation(task=row["name"], scheduler=row["core"], priority=row["priority"]))
    cores = sorted({row["core"] for row in figures["tasks"]})
    second = next(chain for chain in figures["chains"] if chain["name"] == "EffectChain_2")
    first, last = second["runnables"][0], second["runnables"][-1]
    middle = second["runnables"][1]
    events = Events(
        events=tuple(
            RunnableEvent(name=event, runnable=each, change=change)
            for event, each, change in (
                ("start", first, RunnableChange.START),
                ("middle", middle, RunnableChange.TERMINATE),
                ("end", last, RunnableChange.TERMINATE),
            )
        ),
        chains=(
            EventChain(
                name="EffectChain_2",
                stimulus="start",
                response="end",
                items=Sequence(
                    items=(Segment(stimulus="start", response="middle"), Segment(stimulus="middle", response="end"))
                ),
            ),
        ),
    )
    runnables = tuple(map(runnable, software.findall("runnables")))
    return system(cores, stimuli, tasks, allocations, runnables=runnables, events=events)


@pytest.mark.parametrize(("variant", "clock"), [("nominal_200MHz_nomem", 200), ("unimore_300MHz_nomem", 300)])
def test_response_times_of_all_tasks(figures, built, variant, clock):
    analysis = analyze_system(built, Settings(dict.fromkeys(built.cores, Fraction(clock * 10**6))))
    for row in figures["tasks"]:
        response, expected = analysis[row["name"]].response, row["wcrt_us"][variant]
        if expected is None:
            assert response.worst is None
        else:
            # A third of a picosecond is printed rounded to the nearest one; a bound is rounded up.
            assert response.worst == pytest.approx(expected * US, abs=1), row["name"]


def test_an_explicit_chain_ends_with_the_access(built):
    settings = Settings(dict.fromkeys(built.cores, Fraction(300 * 10**6)), communication=Communication.EXPLICIT)
    (chain,) = analyze_system(built, settings).chains
    reaction = chain.value(LatencyQuantity.MAX_REACTION_TIME)
    # From just after Runnable_100ms_7 has read until Runnable_2ms_8 has ended: at least the period that was just missed, at most the
    # bound that the University of Modena published for this chain.
    assert 100_000 * US < reaction.value <= 122_740 * US
