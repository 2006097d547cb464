"""The challenge model of 2017: its loads and response times, with its 1,250 runnables, and chains of label accesses.

The file is older than what this package reads, so that the test takes what it needs from the XML; the figures agree with pyCPA and
with the published solutions, and are printed to a picosecond.
"""

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache

import pytest
from hand_made_systems import chain, of_parts, ticks
from lxml import etree
from support import SHARED

from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import AccessKind, Call, Communication, LabelAccess
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.events import Events, RunnableChange, RunnableEvent
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import Preemption, Runnable, Software, Task
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
            activities.append(ticks(upper, lower))
    return Runnable(name=element.get("name"), activities=tuple(activities))


@cache
def figures():
    return json.loads(FIGURES.read_text())


@cache
def preemptive():
    """The system of the figures: each task as one stretch of its upper bound of instructions."""
    stimuli, tasks, allocations = [], [], []
    for row in figures()["tasks"]:
        stimulus, period = f"stimulus of {row['name']}", round(row["period_or_min_interarrival_us"] * US)
        if row["stimulus"] == "sporadic":
            upper = round(row["max_interarrival_us"] * US)
            stimuli.append(RelativePeriodic(name=stimulus, distance=Uniform(lower=period, upper=upper)))
        else:
            stimuli.append(Periodic(name=stimulus, period=period))
        body = (ticks(row["instructions"]["upper"], row["instructions"]["lower"]),)
        tasks.append(Task(name=row["name"], stimuli=(stimulus,), activities=body))
        allocations.append(TaskAllocation(task=row["name"], scheduler=row["core"], priority=row["priority"]))
    cores = sorted({row["core"] for row in figures()["tasks"]})
    return of_parts(tasks, allocations, stimuli, cores=cores, frequency=200 * 10**6)


@cache
def cooperative():
    """The system of the model, with its runnables and the second effect chain."""
    software = etree.parse(MODEL).getroot().find("swModel")
    elements = {element.get("name"): element for element in software.findall("tasks")}
    tasks = [
        replace(
            task,
            activities=tuple(Call(runnable=name(call.get("runnable"))) for call in elements[task.name].iter("calls")),
            preemption=Preemption(elements[task.name].get("preemption")),
        )
        for task in preemptive().software.tasks
    ]
    second = next(chain for chain in figures()["chains"] if chain["name"] == "EffectChain_2")
    first, middle, last = second["runnables"][0], second["runnables"][1], second["runnables"][-1]
    events = (
        RunnableEvent(name="start", runnable=first, change=RunnableChange.START),
        RunnableEvent(name="middle", runnable=middle, change=RunnableChange.TERMINATE),
        RunnableEvent(name="end", runnable=last, change=RunnableChange.TERMINATE),
    )
    return replace(
        preemptive(),
        software=Software(tasks=tuple(tasks), runnables=tuple(map(runnable, software.findall("runnables")))),
        events=Events(events=events, chains=(chain("EffectChain_2", "start", "middle", "end"),)),
    )


def at_megahertz(built, frequency, **settings):
    return analyze_system(built, Settings(dict.fromkeys(built.cores, Fraction(frequency * 10**6)), **settings))


@pytest.mark.parametrize(
    ("build", "variant", "clock"),
    [
        (cooperative, "nominal_200MHz_nomem", 200),
        (cooperative, "unimore_300MHz_nomem", 300),
        (preemptive, "preemptive_300MHz_nomem", 300),
    ],
)
def test_response_times(build, variant, clock):
    analysis = at_megahertz(build(), clock)
    for row in figures()["tasks"]:
        process, expected = analysis[row["name"]], row["wcrt_us"][variant]
        if expected is None:
            assert (process.response.worst, process.verdict) == (None, "unbounded")
        else:
            # A third of a picosecond is printed rounded to the nearest one; a bound is rounded up.
            assert 0 <= process.response.worst - round(expected * US) <= (clock == 300), row["name"]


@pytest.mark.parametrize(("variant", "clock"), [("nominal_200MHz_nomem", 200), ("unimore_300MHz_nomem", 300)])
def test_loads(variant, clock):
    loads = {processor.name: round(float(processor.worst), 6) for processor in at_megahertz(preemptive(), clock).processors}
    assert loads == figures()["variants"][variant]["core_utilisation"]


def test_a_clock_and_a_factor_say_the_same():
    scaled = analyze_system(preemptive(), Settings(scale=Fraction(1, 2)))
    assert [p.response for p in at_megahertz(preemptive(), 400).processes] == [p.response for p in scaled.processes]


def test_an_explicit_chain_ends_with_the_access():
    (found,) = at_megahertz(cooperative(), 300, communication=Communication.EXPLICIT).chains
    reaction = found.value(LatencyQuantity.MAX_REACTION_TIME)
    # From just after Runnable_100ms_7 has read until Runnable_2ms_8 has ended: at least the period that was just missed, at most the
    # bound that the University of Modena published for this chain.
    assert 100_000 * US < reaction.value <= 122_740 * US
