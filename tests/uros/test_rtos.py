"""What the operating system means for tasks: sleeps in ticks, priorities, equal priorities, and stacks of cores."""

import pytest

from amalthea_uros import analyze
from amalthea_uros.spec.os import OsSection, SleepTicks
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.units import MICROSECOND, MILLISECOND, Duration
from amalthea_uros.uros.executors.sleeps import slept

MS = MILLISECOND
TASKS = """
    amuros: 1
    name: app
    hardware: {{frequency: 100 MHz}}
    os: {os}
    tasks:
      - {{name: A, period: 10 ms, execution_time: 1 ms, priority: {a}}}
      - {{name: B, period: 20 ms, execution_time: 1 ms, priority: {b}}}
      - {{name: C, period: 40 ms, execution_time: 1 ms}}
"""


@pytest.mark.parametrize(
    ("sleep", "tick", "ticks", "expected"),
    [
        # vTaskDelay(1) ends at the next tick, which may come at once.
        # The ends of two such sleeps are different ticks.
        (10 * MS, 10 * MS, {"early": 1}, (0, 10 * MS, 10 * MS)),
        (100 * MS, 10 * MS, {"early": 1}, (90 * MS, 100 * MS, 100 * MS)),
        # 15 ms are two ticks of 10 ms.
        (15 * MS, 10 * MS, {"early": 1}, (10 * MS, 20 * MS, 20 * MS)),
        # Zephyr waits for a tick more, as the one that is running does not count: 250 us are three ticks of 100 us.
        (250 * MICROSECOND, 100 * MICROSECOND, {"late": 1}, (300 * MICROSECOND, 400 * MICROSECOND, 300 * MICROSECOND)),
        # Of an unknown operating system both can be the case.
        (10 * MS, 10 * MS, None, (0, 20 * MS, 10 * MS)),
        # Less than a tick early can not become negative, and no sleep is none.
        (1 * MS, 10 * MS, {"early": 2}, (0, 10 * MS, 0)),
        (0, 10 * MS, {"late": 1}, (0, 0, 0)),
        (15 * MS, None, None, (15 * MS, 15 * MS, 15 * MS)),
    ],
)
def test_a_sleep_is_counted_in_ticks(sleep, tick, ticks, expected):
    assert slept(sleep, OsSection.model_construct(tick=tick, sleep_ticks=SleepTicks(**ticks) if ticks else None)) == expected


def test_a_sleep_of_part_of_a_tick_is_reported_at_its_place(author):
    assembly = author.describe("""
        amuros: 1
        name: app
        hardware: esp32
        middleware:
          executor:
            loop: {spin_some: 100 ms, sleep: 5 ms}
        application: {nodes: [{name: n, timers: [{name: T, period: 500 ms, execution_time: 1 ms}]}]}
    """)
    (finding,) = (finding for finding in assembly.findings if finding.rule == "UR161")
    assert finding.message == "'Executor_Task' sleeps 0 s to 10 ms instead of 5 ms: 'freertos' counts in ticks of 10 ms"
    assert finding.location.line == 6


def ranks(assembly):
    return {each.task: each.priority for each in assembly.system.mapping.tasks}


class TestPriorities:
    @pytest.mark.parametrize("os", ["{}", "{rtos: freertos}", "{priorities: higher-is-more-urgent}"])
    def test_a_higher_number_is_more_urgent(self, author, os):
        assert ranks(author.describe(TASKS.format(os=os, a=7, b=5))) == {"A": 7, "B": 5, "C": 1}

    def test_in_zephyr_a_lower_number_is_more_urgent(self, author):
        # 14 is the least urgent preemptive priority: 3 and 5 are 11 and 9 above it.
        assert ranks(author.describe(TASKS.format(os="{rtos: zephyr}", a=3, b=5))) == {"A": 11, "B": 9, "C": 1}

    @pytest.mark.parametrize("os", ["{priorities: lower-is-more-urgent}", "{rtos: zephyr}"])
    def test_the_order_is_that_of_the_file(self, author, os):
        found = ranks(author.describe(TASKS.format(os=os, a=0, b=9)))
        assert found["A"] > found["B"] > found["C"]

    def test_findings_show_the_numbers_of_the_file(self, author):
        assembly = author.describe(TASKS.format(os="{rtos: zephyr}", a=5, b=5))
        assert [finding.message for finding in assembly.findings] == ["'B' has the same priority 5 as 'A'"]

    @pytest.mark.parametrize(
        ("os", "number", "message"),
        [
            ("{rtos: zephyr}", 15, "the priority 15 of 'A' is outside -16 to 14, the range of 'zephyr'"),
            ("{rtos: freertos}", 56, "the priority 56 of 'A' is outside 0 to 55, the range of 'freertos'"),
            (
                "{priority_range: {lowest: 1, highest: 4}}",
                5,
                "the priority 5 of 'A' is outside 1 to 4, the range of the operating system",
            ),
        ],
    )
    def test_one_that_the_operating_system_does_not_have_is_reported(self, author, os, number, message):
        findings = author.describe(TASKS.format(os=os, a=number, b=2)).findings
        assert message in [finding.message for finding in findings if finding.rule == "UR160"]

    def test_more_priorities_than_there_are_are_reported(self, author):
        text = TASKS.format(os="{priority_range: {lowest: 1, highest: 4}}", a=4, b=4).replace(", priority: 4", "")
        text += "".join(f"      - {{name: T{i}, period: 80 ms, execution_time: 1 us}}\n" for i in range(3))
        # Six tasks, one priority each from 1 to 6: the two with the shortest periods get 5 and 6.
        messages = [finding.message for finding in author.describe(text).findings if finding.rule == "UR160"]
        assert [message.partition(",")[0] for message in messages] == ["'A' gets priority 6", "'B' gets priority 5"]


class TestEqualPriorities:
    def test_they_take_turns_where_the_operating_system_says_so(self, author):
        assembly = author.describe(TASKS.format(os="{rtos: freertos}", a=5, b=5))
        (scheduler,) = assembly.system.os.systems[0].schedulers
        assert (scheduler.policy, scheduler.parameters[0].values) == ("PriorityBasedRoundRobin", (Duration(MS),))
        assert not assembly.findings

    @pytest.mark.parametrize(
        ("os", "b"), [("{rtos: freertos}", 4), ("{rtos: freertos, time_slice: 0}", 5), ("{rtos: osek}", 5), ("{}", 5)]
    )
    def test_there_is_no_time_slice_without_need(self, author, os, b):
        (scheduler,) = author.describe(TASKS.format(os=os, a=5, b=b)).system.os.systems[0].schedulers
        assert scheduler.policy in ("FixedPriorityPreemptive", "OSEK")
        assert not scheduler.parameters


MEMORIES = """
    amuros: 1
    name: app
    hardware:
      frequency: 1 MHz
      cores: 2
      memories:
        - {name: Near, size: 1 kB, kind: SRAM, accesses: [{cores: [Core_0], read_cycles: 1, write_cycles: 1}], read_cycles: 9}
        - {name: Far, size: 1 kB, accesses: [{cores: [Core_0], read_cycles: 7, write_cycles: 5}]}
    tasks:
      - {name: A, period: 10 ms, execution_time: 1 ms, reads: [x]}
      - {name: B, period: 10 ms, execution_time: 1 ms, reads: [x], core: Core_1}
    labels: {x: {size: 4 B, memory: MEMORY}}
"""


class TestMemoriesOfCores:
    @pytest.mark.parametrize(
        ("memory", "a", "b"),
        [
            # A read from the own memory takes a cycle of 1 us; from another core nine, as stated for all others.
            ("Near", 1001 * MICROSECOND, 1009 * MICROSECOND),
            # Nobody states what an access from Core_1 takes.
            ("Far", 1007 * MICROSECOND, None),
        ],
    )
    def test_an_access_costs_what_its_core_needs(self, author, memory, a, b):
        author.describe(MEMORIES.replace("MEMORY", memory))
        analysis = analyze(author.path, Settings(memory=MemoryModel.EXPLICIT))
        responses = [analysis[name].response for name in ("A", "B")]
        assert [response and response.worst for response in responses] == [a, b]

    @pytest.mark.parametrize(
        ("cores", "message"),
        [
            ("[Core_9]", "undefined core 'Core_9'"),
            ("[Core_1, Core_1]", "the memory 'Far' states twice what accesses from 'Core_1' cost"),
        ],
    )
    def test_wrong_cores_are_reported(self, author, cores, message):
        text = MEMORIES.replace("[{cores: [Core_0], read_cycles: 7", f"[{{cores: {cores}, read_cycles: 7")
        assert [found[2] for found in author.findings(text)] == [message]


def test_a_platform_without_a_clock_asks_for_it(author, tmp_path):
    (tmp_path / "teensy32.yaml").write_text("amuros: 1\nplatform: teensy32\nhardware: {core_type: Cortex-M4, cores: 1}\n")
    text = "amuros: 1\nname: a\nhardware: ./teensy32.yaml\ntasks: [{name: A, period: 10 ms, execution_time: 1 ms}]\n"
    assert [found[1:] for found in author.findings(text)] == [("APP005", "the frequency of core 'Core_0' is unknown")]
    assert author.describe(text.replace("./teensy32.yaml", "{platform: ./teensy32.yaml, frequency: 72 MHz}"))
