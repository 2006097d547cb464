"""System pictures: every process and flow is drawn, no line runs through a box, and large systems stay small."""

import re
from itertools import combinations, pairwise

import pytest
from effort import every
from hand_made_systems import of_parts, read, write
from hypothesis import given, settings
from hypothesis import strategies as st
from support import ROOT
from svg_reading import NASTY, assert_readable, contents, tooltips

from amalthea_uros import analyze_files
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import Label, Software, Task
from amalthea_uros.perf.system import System
from amalthea_uros.report.pictures.system_layout import BOX, LayoutWire, lay_out
from amalthea_uros.report.pictures.system_picture import MOST_PROCESSES, draw_system

SAMPLES = sorted((ROOT / "samples").glob("*.yaml"))


def writing(name, *labels, reading=()):
    return Task(name=name, activities=(*map(write, labels), *map(read, reading)))


def system_of(*tasks, cores=1):
    names = [f"Core_{number}" for number in range(cores)]
    labels = sorted({access.label for task in tasks for access in task.activities})
    allocations = [TaskAllocation(task=task.name, scheduler=names[i % cores], priority=i) for i, task in enumerate(tasks)]
    return of_parts(tasks, allocations, (), cores=names, labels=[Label(name=name) for name in labels])


def test_processes_are_ordered_by_priority_on_their_cores():
    names = contents(draw_system(analyze_files(ROOT / "samples" / "bodas-test-advanced.yaml").system))
    order = ["Executor_Task", "Control_Function", "Message_Factor"]
    assert [name for name in names if name in order] == order
    assert {"Core_0", "every 20 ms", "priority 1", "memory_1", "memory_2", "event chain factor-to-output"} <= set(names)


def test_loads_and_verdicts_are_those_of_the_analysis():
    result = analyze_files(ROOT / "samples" / "bodas-test-advanced.yaml")
    picture = draw_system(result.system, result.analysis)
    # 12 us in each millisecond, 13 us more in each twentieth one, 4 us in each, and 2 us in each twentieth one.
    assert {"Core_0, load 1.675 %", "priority 2, load 0.4 %", "priority 1, load 0.01 %"} <= set(contents(picture))
    assert tooltips(picture).count("met") == 4


@pytest.mark.parametrize("sample", every(4, SAMPLES), ids=lambda path: path.stem)
def test_every_process_flow_and_source_of_a_sample_is_drawn_and_readable(sample):
    result = analyze_files(sample)
    picture = draw_system(result.system, result.analysis)
    assert set(result.system.processes) <= {title.split(",")[0] for title in tooltips(picture)}
    assert_readable(picture)


def test_flows_of_a_sample():
    found = tooltips(draw_system(analyze_files(ROOT / "samples" / "drive-and-lift.yaml").system))
    assert {
        "Task_5ms to Control_Speed, Report_Odometry: wheel_speed",
        "Task_Hydraulics to Control_Lift: height",
        "Task_Hydraulics to Task_Log: trigger_of_Task_Log",
        "event chain height-to-valve: Task_Hydraulics, Control_Lift",
    } <= set(found)


def test_names_are_escaped():
    picture = draw_system(system_of(writing(NASTY, NASTY), writing("B", reading=[NASTY])))
    # The task and what it writes have the same name.
    assert contents(picture).count(NASTY) == 2
    assert f"{NASTY} to B: {NASTY}" in tooltips(picture)


def test_systems_without_processes_or_cores_say_so():
    assert "the model has no processes" in contents(draw_system(System()))
    assert {"A", "no core, or several ones"} <= set(contents(draw_system(System(software=Software(tasks=(Task(name="A"),))))))


def test_large_systems_are_shown_by_cores():
    tasks = [writing(f"T{n}", f"L{n}", reading=[f"L{n - 1}"]) for n in range(1000)]
    picture = draw_system(system_of(*tasks, cores=4))
    assert any(text.startswith("Only cores are shown: there are 1,000 processes.") for text in contents(picture))
    assert contents(picture).count("250 tasks") == 4
    # Task n passes data on to task n + 1 on the next core: 250 times from each core, but from the last one to the first one 249 times.
    assert [contents(picture).count(number) for number in ("250", "249")] == [3, 1]
    assert len(picture) < 30_000


def all_to_all(count, cores=1):
    """Each task writes a label for each other one."""
    every = range(count)
    tasks = [writing(f"T{n}", *(f"L{n}_{m}" for m in every), reading=[f"L{m}_{n}" for m in every]) for n in every]
    return draw_system(system_of(*tasks, cores=cores))


def test_many_flows_become_one_line_for_each_process():
    picture = all_to_all(20)
    assert any(text.startswith("Data of a process are drawn as one line") for text in contents(picture))
    assert contents(picture).count("19") == 20
    assert len(picture) < 100_000
    assert len(all_to_all(MOST_PROCESSES, cores=8)) < 400_000


NAMES = [f"B{number}" for number in range(9)]
WIRES = st.lists(
    st.tuples(st.sampled_from(NAMES), st.lists(st.sampled_from(NAMES), min_size=1, max_size=4, unique=True), st.booleans()),
    max_size=12,
)


@settings(deadline=None)
@given(WIRES, st.integers(0, 9))
def test_no_line_runs_through_a_box_or_along_another_one(ends, size):
    wires = [
        LayoutWire(source, tuple(target for target in targets if is_outer or target != source), "label", is_outer)
        for source, targets, is_outer in ends
    ]
    wires = [wire for wire in wires if wire.targets]
    layout = lay_out([NAMES[:size], NAMES[size:]], wires, 0, 0)
    for one, other in combinations(layout.boxes.values(), 2):
        assert one.top + one.height < other.top or other.top + other.height < one.top
    lines = []
    for number, wire in enumerate(layout.wires):
        assert set(wire.ways) == set(wire.wire.targets)
        for target, way in wire.ways.items():
            assert way[-1][0] in (layout.boxes[target].left, layout.boxes[target].right)
            lines += ((number, *sorted(segment)) for segment in pairwise(way))
    for _number, (left, top), (right, bottom) in lines:
        for box in layout.boxes.values():
            assert right <= box.left or left >= box.right or bottom <= box.top or top >= box.top + box.height
    for (one, *first), (other, *second) in combinations(lines, 2):
        for axis in (0, 1):
            along = 1 - axis
            if one != other and first[0][axis] == first[1][axis] == second[0][axis] == second[1][axis]:
                assert first[1][along] <= second[0][along] or second[1][along] <= first[0][along]


def test_columns_follow_the_longest_path_and_circles_go_back():
    wires = [LayoutWire("B0", ("B1", "B2"), ""), LayoutWire("B1", ("B2",), ""), LayoutWire("B2", ("B0",), "")]
    layout = lay_out([NAMES[:3]], wires, 0, 0)
    lefts = [layout.boxes[name].left for name in NAMES[:3]]
    assert lefts == sorted(set(lefts))
    back = layout.wires[2].ways["B0"]
    assert back[-1][0] == layout.boxes["B0"].left + BOX


def test_colours_follow_the_colour_scheme():
    assert re.search(r"prefers-color-scheme:dark\)\{.*\.box\{fill", draw_system(System()), re.DOTALL)
