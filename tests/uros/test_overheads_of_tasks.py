"""Overheads of the operating system: in the description, in the model, and in the times of jobs."""

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.software import IsrCategory
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.demand.overheads import ASSUMPTION
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration

HEAD = """
amuros: 1
name: overheads
hardware: {platform: single-core}
"""


def runnables(system):
    """What each process calls."""
    return {
        name: [call.runnable for call in process.activities if isinstance(call, Call)]
        for name, process in system.processes.items()
    }


def responses(system):
    """The shortest and the longest response times in microseconds; those of a run are the same."""
    analysis, run = analyze_system(system), simulate_system(system, Options(duration=Duration(200 * MS)))
    found = {process.name: (process.bcrt / US, process.wcrt / US) for process in analysis.processes}
    assert found == {
        process.name: (process.response_time.min / US, process.response_time.max / US) for process in run.processes
    }
    return found


class TestOfTheThesis:
    """S. R. Bappanadu 2022, tables 6.1 and 6.2: empty tasks of 41 us at 1 kHz and 31 us at 50 Hz."""

    def test_an_empty_task_has_nothing_but_its_overhead(self, author):
        system = author.describe(
            HEAD
            + """
tasks:
  - {name: Empty_1kHz, period: 1 ms, offset: 100 us, overhead: {activation: 30 us, termination: 11 us}}
  - {name: Empty_50Hz, period: 20 ms, overhead: 31 us}
"""
        ).system
        assert responses(system) == {"Empty_1kHz": (41, 41), "Empty_50Hz": (31, 31)}

    def test_executor_and_control_function_share_one_task(self):
        # 12 + 4 + 41 = 57 us without a message, 13 us more with one, which is one of 20: 57.65 us on average.
        system = amuros.describe(ROOT / "samples" / "bodas-test-measured.yaml").system
        analysis = analyze_system(system)
        metric = analysis["Control_Function"].metrics[amuros.JobMetric.RESPONSE_TIME]
        assert (metric.min / US, float(metric.mean) / US, metric.max / US) == (57, 57.65, 70)
        run = simulate_system(system, Options(duration=Duration(20 * MS)))
        assert run.processes["Control_Function"].response_time.mean == 57.65 * US

    def test_the_chain_takes_what_the_thesis_simulated(self):
        # Table 6.5: at most 20070 us.
        (chain,) = amuros.analyze_files(ROOT / "samples" / "bodas-test-measured.yaml").analysis.chains
        assert chain.value(amuros.LatencyQuantity.MAX_REDUCED_REACTION_TIME).value == 20_070 * US


ALL = (
    HEAD
    + """
os: {overhead: {activation: 20 us, termination: 10 us, isr: {activation: 3 us, termination: 1 us}}}
middleware:
  executor: {name: E, period: 1 ms, execution_time: 5 us}
  transport: {can: {bitrate: 250 kbit/s, interrupt: {name: Frame, execution_time: 2 us, overhead: 0}}}
application:
  nodes:
    - name: n
      subscriptions:
        - {name: S, topic: t, interval: 10 ms, message_size: 4 B, execution_time: 2 us, overhead: {termination: 0 us}}
        - {name: Inside, topic: u, interval: 10 ms, message_size: 4 B, execution_time: 2 us, runs_in: executor}
tasks:
  - {name: T, period: 5 ms, execution_time: 7 us, overhead: 6 us}
isrs:
  - {name: I, period: 5 ms, execution_time: 7 us}
"""
)


ONE = HEAD + "tasks: [{name: T, period: 5 ms, execution_time: 7 us, overhead: 6 us}]\n"


def test_each_process_has_its_own_overhead_or_that_of_the_system(author):
    assert runnables(author.describe(ALL).system) == {
        "E": ["E_Activation", "E_Spin", "Take_S", "Take_Inside", "Inside_Callback", "E_Termination"],
        "S": ["S_Activation", "S_Callback"],
        "T": ["T_Activation", "T_Runnable"],
        "Frame": ["Frame_Frame"],
        "I": ["I_Activation", "I_Runnable", "I_Termination"],
    }


def test_the_model_keeps_it(author):
    system = author.describe(ALL).system
    assert extract(build_model(system)).system == system
    overheads = {runnable.name for runnable in system.software.runnables if runnable.is_overhead}
    assert overheads == {*(f"{name}_Activation" for name in "ESTI"), "E_Termination", "I_Termination"}


def test_whom_it_delays_is_an_assumption_of_each_result(author):
    assert ASSUMPTION in analyze_system(author.describe(ONE).system).assumptions
    without = analyze_system(amuros.describe(ROOT / "samples" / "bodas-test-simple.yaml").system)
    assert ASSUMPTION not in without.assumptions


def test_an_execution_time_is_changed_without_the_overhead(author):
    author.describe(ONE)
    found = amuros.analyze(author.path, changes=["T.execution_time=1us"])
    assert found["T"].wcet == 7 * US


TWO = (
    HEAD
    + """
os: {overhead: {activation: 20 us, activations_run_in: PLACE}}
tasks:
  - {name: Fast, period: 1 ms, execution_time: 100 us}
  - {name: Slow, period: 2 ms, execution_time: 50 us, overhead: {activation: 30 us}}
"""
)


def test_in_a_task_it_delays_no_task_of_higher_priority(author):
    assert responses(author.describe(TWO.replace("PLACE", "task")).system) == {"Fast": (120, 120), "Slow": (200, 200)}


def test_in_an_interrupt_it_delays_all_tasks(author):
    system = author.describe(TWO.replace("PLACE", "interrupt")).system
    # Fast waits for its own 20, and every second time for the 30 of Slow, too.
    found = responses(system)
    assert (found["Fast"], found["Slow"]) == ((120, 150), (200, 200))
    assert {isr.category for isr in system.software.isrs} == {IsrCategory.CATEGORY_1}


@pytest.mark.parametrize(
    ("old", "new", "rule", "message"),
    [
        (
            *("runs_in: executor", "runs_in: executor, overhead: 0"),
            *("APP003", "'overhead' of 'Inside' has no effect, because it runs in"),
        ),
        (
            *(
                "I, period: 5 ms, execution_time: 7 us",
                "I, period: 5 ms, runnables: [{name: T_Activation, execution_time: 1 us}]",
            ),
            *("APP002", "runnable 'T_Activation' has the name of an overhead of the operating system"),
        ),
        ("overhead: 6 us", "overhead: 6", "YML012", "'6' has no unit"),
        ("overhead: 6 us", "overhead: -6 us", "YML012", "must not be negative"),
    ],
)
def test_a_mistake(author, old, new, rule, message):
    (found, *_) = author.findings(ALL.replace(old, new))
    assert found[1] == rule
    assert message in found[2]


def test_names_of_interrupts_that_activate_are_taken(author):
    text = ALL.replace("activation: 20 us,", "activation: 20 us, activations_run_in: interrupt,")
    (found, *_) = author.findings(text.replace("name: I,", "name: T_Activation,"))
    assert found[1:] == ("APP002", "'T_Activation' is the interrupt that activates 'T'")


def test_rounds_of_executors_have_overhead(author):
    text = """
        amuros: 1
        name: app
        hardware: {frequency: 100 MHz, cores: 1}
        os: {overhead: {activation: 2 us, termination: 1 us}}
        middleware:
          executor: {name: Spinner, loop: {spin_some: 100 ms, sleep: 10 ms}, execution_time: 5 us}
        application:
          nodes:
            - name: node
              timers: [{name: Blink, period: 100 ms, execution_time: 300 us}]
    """
    author.describe(text)
    # The executor takes 5 us, its callback 300 us; the operating system takes 2 us before and 1 us after them.
    assert amuros.analyze_files(author.path).analysis.processes["Spinner"].response.worst == 308 * 10**6
