"""The challenge model of 2019, as its first solution mapped it: four tasks wait for a graphics processor or for another task.

The figures are those of the timing analysis in the MobSTr dataset (org.panorama-research.mobstr.analysis/cloud-based_analysis/
dse_analysis/results.json, commit b2eaf82), by the tool of L. Krawczyk, M. Bazzal, R. P. Govindarajan and C. Wolff, "An analytical
approach for calculating end-to-end response times in autonomous driving applications", WATERS 2019. They are of another mapping,
so that only tasks on the same type of core and with the same tasks above them can be compared. The file has no event chains; those of
the analysis are chains of tasks, of which the latencies under LET depend on the periods only.
"""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise

import pytest
from support import SHARED

from amalthea_uros import Claim, Communication, LatencyQuantity, Settings, analyze_files, analyze_system, extract, load
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import parse_change
from amalthea_uros.perf.activities import AccessKind, LabelAccess, ProbabilitySwitch
from amalthea_uros.perf.events import EventChain, Events, ProcessChange, ProcessEvent, Segment, Sequence
from amalthea_uros.timing.basics.settings import MemoryModel

FOLDER = SHARED / "corpus" / "panorama-research+mobstr-dataset" / "org.panorama-research.mobstr.amalthea"
MODEL = FOLDER / "mapped+safety" / "mobstr-mapped+safety.amxmi"
NS = 1000
MS = 10**9
#: Times between which a job executes, in nanoseconds, cut off to whole ones; parts of a task that waits are added. Each part before
#: a wait has 2500 ns for offloading, which the file has in `PRE_Detection_gpu_POST` only.
EXECUTION_TIMES = {
    "DASM": (1_299_995, 1_859_995),
    "EKF": (3_979_670, 4_759_670),
    "CANbus_polling": (399_680, 599_680),
    "OS_Overhead": (50_000_000, 50_000_000),
    "SFM": (7_049_999, 7_899_999),
    "Detection": (107_999_999, 115_999_999),
    "PRE_SFM_gpu_POST": (2_578_212 - 2_500 + 2_834_784, 3_180_071 - 2_500 + 3_532_258),
    "PRE_Detection_gpu_POST": (3_191_780 + 820_000, 3_692_060 + 1_020_000),
}
#: Worst response times in nanoseconds, with 3520 ns for each access to a label, which the execution times do not have.
RESPONSE_TIMES = {"DASM": (1_874_075, 4), "EKF": (5_394_550, 10), "CANbus_polling": (603_200, 1)}

#: End-to-end latencies under LET in milliseconds (`endToEndLatencyLET`). Those with implicit communication contain 100 s for each task
#: without a response time.
LET_LATENCIES = {
    ("Lidar_Grabber", "PRE_Localization_gpu_POST", "EKF", "Planner", "DASM"): 875,
    ("CANbus_polling", "PRE_Localization_gpu_POST", "EKF", "Planner", "DASM"): 845,
    ("PRE_SFM_gpu_POST", "Planner", "DASM"): 65,
    ("PRE_Lane_detection_gpu_POST", "Planner", "DASM"): 98,
    ("PRE_Detection_gpu_POST", "Planner", "DASM"): 230,
}

#: The policy of the graphics processor has no name; another analysis in the dataset (rtana2sim) takes it for one by priorities,
#: with `SFM` above `Detection`.
BY_PRIORITY = ("GPU_Sched.policy=FixedPriorityPreemptive", "Detection.priority=0")

pytestmark = pytest.mark.skipif(not MODEL.exists(), reason="the challenge is not at hand")


@cache
def analysed(*changes):
    system = extract(load(MODEL)).system
    return analyze_system(*apply(system, Settings(), [parse_change(change) for change in changes]))


@pytest.mark.parametrize("task", EXECUTION_TIMES)
def test_execution_times_are_those_of_the_published_analysis(task):
    process = analysed(*BY_PRIORITY)[task]
    # Each of two parts can be cut off, and is rounded.
    assert [process.bcet / NS, process.wcet / NS] == pytest.approx(EXECUTION_TIMES[task], abs=2)


@pytest.mark.parametrize("task", RESPONSE_TIMES)
def test_response_times_are_those_of_the_published_analysis(task):
    published, accesses = RESPONSE_TIMES[task]
    assert analysed()[task].response.worst / NS == published - 3520 * accesses


def test_waits_for_the_graphics_processor_are_bounded_once_its_policy_is_stated():
    found = analysed(*BY_PRIORITY)
    assert found["SFM"].response.worst == 7_900_000 * NS
    # Nothing preempts it, nor `SFM`.
    assert found["PRE_SFM_gpu_POST"].response.worst / NS == pytest.approx(3_177_571 + 7_900_000 + 3_532_258, abs=2)
    # Five jobs of `SFM`, whose activations vary by less than the 9.5 ms that are left of 5 * 33 ms.
    assert found["Detection"].response.worst / NS == 116_000_000 + 5 * 7_900_000
    # A job of `Lidar_Grabber` before each part.
    lidar = found["Lidar_Grabber"].wcet / NS
    expected = 4_712_060 + 155_500_000 + 2 * lidar
    assert found["PRE_Detection_gpu_POST"].response.worst / NS == pytest.approx(expected, abs=2)
    assert [found[name].verdict for name in ("PRE_SFM_gpu_POST", "PRE_Detection_gpu_POST")] == ["met", "met"]


def test_copies_to_and_from_the_graphics_processor_take_the_time_of_its_data_rate():
    # An image and a bounding box are read and written: 2 MB and 0.75 MB at 20 GB/s, with 5 cycles of 1.5 GHz for each access at most.
    system = extract(load(MODEL)).system
    with_copies = analyze_system(system, Settings(memory=MemoryModel.EXPLICIT))["Detection"].wcet
    accesses = [size for size in (2.0, 0.75) for _ in range(2)]
    expected = sum(size / 20_000 * 10**9 for size in accesses) + 4 * 5 / 1.5
    assert (with_copies - analysed()["Detection"].wcet) / NS == pytest.approx(expected, abs=2)


BY_ROUND_ROBIN = ("GPU_Sched.policy=PriorityBasedRoundRobin", "Detection.priority=1")


@pytest.mark.parametrize("policy", [BY_ROUND_ROBIN, ()], ids=["round robin", "without a name"])
def test_waits_for_the_graphics_processor_are_bounded_by_time_slices_that_are_short_enough(policy):
    found = analysed(*policy, "Detection.time_slice=9ms", "SFM.time_slice=3950us")
    # 7.9 ms in two slices, a slice of the other one before each; 116 ms in 13 slices.
    assert found["SFM"].response.worst == 7_900_000 * NS + 2 * 9_000_000 * NS
    assert found["Detection"].response.worst == 116_000_000 * NS + 13 * 3_950_000 * NS
    assert [found[name].verdict for name in ("PRE_SFM_gpu_POST", "PRE_Detection_gpu_POST")] == ["met", "met"]


def test_time_slices_of_the_file_bound_waits_without_a_named_policy():
    found = analysed()
    # `TimeSlice_Detection` and `TimeSlice_SFM`: 116 ms in three slices of 50 ms, one of 7.2 ms of `SFM` before each.
    assert found["Detection"].response.worst == 116_000_000 * NS + 3 * 7_200_000 * NS
    lidar = found["Lidar_Grabber"].wcet
    expected = found["Detection"].response.worst + 2 * lidar
    assert (found["PRE_Detection_gpu_POST"].response.worst - expected) / NS == pytest.approx(3_692_060 + 1_020_000, abs=2)
    assert found["PRE_Detection_gpu_POST"].verdict == "met"
    # Two slices of 50 ms before the end of 7.9 ms, every 33 ms.
    assert found["PRE_SFM_gpu_POST"].reason.endswith("the time slices of the others leave it too little time")
    assert any("'GPU_Sched', each task that is pending gets its time slice" in each for each in found.assumptions)


def test_the_time_slices_of_the_file_are_too_long_for_the_period_of_who_waits():
    reason = analysed(*BY_ROUND_ROBIN)["PRE_SFM_gpu_POST"].reason
    assert reason == "it waits for 'SFM', which 'SFM' sets after up to 107.9 ms, so that activations may be lost"


def test_a_policy_by_priorities_is_proposed_with_the_long_task_below_the_short_one():
    # `Detection` above `SFM` would give nothing that the time slices do not give.
    missing = analyze_files(MODEL, with_missing=True).missing
    assert list(map(str, missing.changes)) == ["GPU_Sched.policy=FixedPriorityPreemptive", "Detection.priority=-1"]
    assert set(missing.gained) == {"SFM", "PRE_SFM_gpu_POST"}


@pytest.mark.parametrize("task", ["Localization", "Lane_detection"])
def test_who_polls_for_a_task_of_its_own_priority_on_its_core_waits_for_ever(task):
    reason = analysed(*BY_PRIORITY)[f"PRE_{task}_gpu_POST"].reason
    assert reason.endswith(f"it polls for that on the same core, where '{task}' cannot preempt it, and so never sets it")


def with_published_chains(system):
    """The system with the chains of the published analysis, on its mapping of four tasks to the graphics processor.

    As in the model of the analysis, a lidar does not fail, and a task writes at its end what it had computed by another one.
    """
    runnables = []
    for runnable in system.software.runnables:
        activities = runnable.activities
        if runnable.name == "Lidar_and_Camera_Function":
            without_failures = (
                each.branches[1].activities if isinstance(each, ProbabilitySwitch) else (each,) for each in activities
            )
            activities = tuple(inner for part in without_failures for inner in part)
        elif runnable.name == "SFM_Postprocessing":
            activities = (*activities, LabelAccess(label="Matrix_SFM_host", kind=AccessKind.WRITE))
        runnables.append(replace(runnable, activities=activities))
    events, chains = {}, []
    for tasks in LET_LATENCIES:
        points = [f"start of {tasks[0]}", *(f"end of {task}" for task in tasks)]
        events[points[0]] = ProcessEvent(name=points[0], process=tasks[0], change=ProcessChange.START)
        for name, task in zip(points[1:], tasks, strict=True):
            events[name] = ProcessEvent(name=name, process=task, change=ProcessChange.TERMINATE)
        parts = tuple(Segment(stimulus=before, response=after) for before, after in pairwise(points))
        chains.append(EventChain(name=tasks[0], stimulus=points[0], response=points[-1], items=Sequence(parts)))
    software = replace(system.software, runnables=tuple(runnables))
    return replace(system, software=software, events=Events(events=tuple(events.values()), chains=tuple(chains)))


def test_latencies_of_chains_are_those_of_the_published_analysis():
    system = with_published_chains(extract(load(MODEL)).system)
    # All jobs have to end within their periods; the graphics processor would need 154 % of its clock of 1.5 GHz.
    settings = Settings(dict.fromkeys(system.cores, Fraction(4 * 10**9)), communication=Communication.LET)
    on_graphics_processor = [f"{task}.core=GP10B" for task in ("Localization", "Lane_detection")]
    order = [f"{task}.priority={20 + n}" for n, task in enumerate(("Detection", "Localization", "Lane_detection", "SFM"))]
    changes = ["GPU_Sched.policy=FixedPriorityPreemptive", *on_graphics_processor, *order]
    found = analyze_system(*apply(system, settings, list(map(parse_change, changes))))
    latencies = {chain.name: chain.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME) for chain in found.chains}
    assert {name: value.value / MS for name, value in latencies.items()} == {
        tasks[0]: latency for tasks, latency in LET_LATENCIES.items()
    }
    assert {value.claim for value in latencies.values()} == {Claim.EXACT}
