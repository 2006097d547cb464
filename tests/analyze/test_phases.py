"""What comes from outside can come at any time: the worst phase counts, and nothing is known if there are too many of them."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest
from effort import IS_THOROUGH, every
from hand_made_systems import READ, WRITE, Proc, access, chain, system, ticks
from support import ROOT, SHARED, analysis_of

from amalthea_uros import Settings, analyze_system, describe
from amalthea_uros.analyze import system as whole
from amalthea_uros.analyze.explanations.processes import shares
from amalthea_uros.analyze.phases import cases as phases
from amalthea_uros.analyze.phases import merged
from amalthea_uros.analyze.priorities.assignment import propose_priorities
from amalthea_uros.analyze.sensitivity import max_growth
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.activities import Call, Incomplete
from amalthea_uros.perf.events import ProcessChange, ProcessEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.software import Label, Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import time_text
from amalthea_uros.uros.described import describe_text

SAMPLE = ROOT / "samples" / "bodas-test-advanced.yaml"
UNKNOWN = "Message_Factor is due regularly, in one of 20 jobs of Executor_Task, and its phase is unknown"
DESIGN = json.loads((SHARED / "vectors" / "design.json").read_text()) if (SHARED / "vectors").exists() else {}


def analyze(text, settings=None):
    return analyze_system(describe_text(text).assembly.system, settings)


def sample(**changes):
    """The sample with some of its texts replaced."""
    text = SAMPLE.read_text()
    for old, new in changes.values():
        assert old in text
        text = text.replace(old, new)
    return text


def times(analysis, name):
    response = analysis[name].response
    return response.best // US, response.worst // US, response.claim


def latency(analysis, quantity="max_reduced_reaction_time"):
    (chain,) = analysis.chains
    return next(value.value for value in chain.values if value.quantity == quantity) / US


class TestTheSample:
    """Executor 12 us, with a message 25 us, every 1 ms; control function 4 us every 1 ms; the message every 20 ms, its task 2 us."""

    def test_response_times(self):
        analysis = analysis_of(SAMPLE)
        assert times(analysis, "Executor_Task") == (12, 25, Claim.EXACT)
        assert times(analysis, "Control_Function") == (12 + 4, 25 + 4, Claim.EXACT)
        # Message_Factor waits for the long job of the executor only if the message is taken when it is released.
        assert times(analysis, "Message_Factor") == (12 + 4 + 2, 25 + 4 + 2, Claim.EXACT)
        found = {share.name: (share.jobs, share.time // US) for share in shares(analysis, "Message_Factor")}
        assert found == {"Executor_Task": (1, 25), "Control_Function": (1, 4)}
        assert f"{UNKNOWN}: all phases are evaluated" in analysis.assumptions

    def test_a_limit_that_only_the_modelled_phase_meets_is_missed(self):
        analysis = analyze(sample(limit=("reaction: 25 ms", "reaction: 15 ms")))
        result = analysis.requirements["factor-to-output_reaction"]
        assert (result.verdict, result.value / US) == (Verdict.MISSED, 20029)
        assert analysis.summary.schedulable == "no"

    @pytest.mark.parametrize("phase", range(0, 40, 3) if IS_THOROUGH else (0, 3, 20, 39))
    def test_a_stated_phase(self, phase):
        stated = analyze(sample(phase=("rate: 50 Hz", f"rate: 50 Hz, phase: {phase} ms")))
        for_once = analyze_system(describe(SAMPLE).system, Settings(phases={"Message_Factor": f"{phase} ms"}))
        assert stated.processes == for_once.processes
        assert stated.assumptions == for_once.assumptions
        assert f"first in job {phase + 1}, at {time_text(phase * MS)}, as stated" in stated.assumptions[-1]
        assert times(stated, "Message_Factor")[1] == (31 if phase % 20 == 0 else 18)
        # Until Message_Factor runs in the next activation of its task, and from then to the end of the next control function.
        wait = -phase % 20 * 1000
        assert latency(stated) == wait + (1016 if wait != 19_000 else 1029)

    def test_factors_are_those_of_all_phases(self):
        analysis = analyze(sample(limit=("reaction: 25 ms", "reaction: 20.058 ms")))
        # 20 ms + 29 us * factor <= 20.058 ms.
        system = analysis.solution.context.system
        grown = [analyze_system(system, Settings(growth=Fraction(factor, 1000))) for factor in (2000, 2001)]
        assert [each.summary.schedulable == "yes" for each in grown] == [True, False]
        if IS_THOROUGH:
            assert 0 <= 2 - max_growth(analysis) < Fraction(4, 1000)

    def test_proposals_do_not_depend_on_a_phase(self):
        limit = ("period: 1 ms, execution_time: {base", "period: 1 ms, deadline: 1 ms, execution_time: {base")
        more = ("rate: 50 Hz", "rate: 50 Hz, deadline: 31 us")
        proposal = propose_priorities(analyze(sample(limit=limit, more=more)))[0]
        # Alone above the others it needs 2 us; with the long job of the executor and the control function just 31 us.
        assert proposal.priorities is not None


class TestTooManyPhases:
    """With more combinations than are tried, any job can be the one that is due."""

    @pytest.fixture(autouse=True)
    def _few(self, monkeypatch):
        monkeypatch.setattr(phases, "MAX_COMBINATIONS", 19)

    def test_there_are_bounds_and_a_reason(self):
        analysis = analyze_system(describe(SAMPLE).system)
        for name, best, worst in (("Executor_Task", 12, 25), ("Control_Function", 16, 29), ("Message_Factor", 18, 31)):
            found = times(analysis, name)
            assert found[0] <= best
            assert found[1] >= worst
            assert found[2] is Claim.BOUND
        (chain,) = analysis.chains
        assert latency(analysis) >= 20029
        assert {value.claim for value in chain.values} == {Claim.BOUND}
        assert "phase" in chain.why
        assert f"{UNKNOWN}: any job can be that one" in analysis.assumptions

    def test_a_chain_needs_only_the_phases_of_its_own_jobs(self, monkeypatch):
        # 20 * 10 combinations; the chain passes the job that takes the factor.
        monkeypatch.setattr(phases, "MAX_COMBINATIONS", 100)
        other = "        - {name: Other, topic: other, rate: 100 Hz, message_size: 4 B, execution_time: 1 us}\n      timers:"
        analysis = analyze(sample(other=("      timers:", other)))
        assert latency(analysis) >= 20029
        (chain,) = analysis.chains
        assert "over all 20 phases" in chain.values[0].method

    def test_the_phases_of_single_chains_take_a_limited_work_together(self, monkeypatch):
        monkeypatch.setattr(phases, "MAX_COMBINATIONS", 100)
        other = "        - {name: Other, topic: other, rate: 100 Hz, message_size: 4 B, execution_time: 1 us}\n      timers:"
        second = "chains:\n  - {name: first, path: [Executor_Task, Message_Factor, Control_Function]}\n"
        text = sample(other=("      timers:", other), second=("chains:\n", second))
        both = analyze(text)
        assert ["over all 20 phases" in chain.values[0].method for chain in both.chains] == [True, True]
        monkeypatch.setattr(merged, "_MAX_WORK_OF_CHAINS", both.work * 3 // 4)
        first = analyze(text)
        assert ["over all 20 phases" in chain.values[0].method for chain in first.chains] == [True, False]
        assert first.work < both.work * 3 // 4


def test_loads_are_computed_once_for_all_phases(monkeypatch):
    computed, one = [], whole.processor_results
    monkeypatch.setattr(whole, "processor_results", lambda solution: computed.append(solution) or one(solution))
    analysis = analyze(sample())
    # Those of the phase that was solved first are those of the schedule for unknown phases, too.
    assert len(computed) == 1
    assert [(each.best, each.worst) for each in analysis.processors] == [
        (each.best, each.worst) for each in one(analysis.solution)
    ]


@pytest.mark.parametrize(("limit", "value"), [("MAX_JOBS", 100), ("_JOBS_PER_PROCESS", 10_000)])
def test_what_takes_too_long_is_too_many_phases(limit, value, monkeypatch):
    monkeypatch.setattr(phases, limit, value)
    analysis = analyze_system(describe(SAMPLE).system)
    assert times(analysis, "Message_Factor")[2] is Claim.BOUND


class TestTheWorkOfEachCombination:
    """A callback that accesses 500 labels, with 50 * 10 * 2 phases."""

    READS = ", ".join(f"label_{number}" for number in range(500))
    PLAIN = (SAMPLE.parent / "rclc-in-executor.yaml").read_text()
    ACCESSING = PLAIN.replace("reads: [command", f"reads: [{READS}, command")
    #: With a task whose jobs overlap several iterations of the executor, no two phases are alike.
    BRIEF, LONG = "period: 500 ms, execution_time: 2 us", "period: 500 ms, execution_time: 100 ms"
    OVERLAPPING = ACCESSING.replace(BRIEF, LONG)

    @pytest.fixture(autouse=True)
    def analyses(self, monkeypatch):
        found, one = [], whole._analysis
        monkeypatch.setattr(whole, "_analysis", lambda *given: found.append(given) or one(*given))
        return found

    def test_only_the_combinations_that_are_solved_count(self, analyses):
        assert times(analyze(self.ACCESSING), "rclc_executor")[2] is Claim.EXACT
        assert len(analyses) == 24

    def test_activities_count(self, analyses):
        analysis = analyze(self.OVERLAPPING)
        assert len(analyses) == 1
        assert times(analysis, "rclc_executor")[2] is Claim.BOUND
        assert any(each.endswith("any job can be that one") for each in analysis.assumptions)

    def test_so_do_chains(self, analyses):
        chains = "".join(f"  - {{name: chain_{number}, path: [On_Imu, Control]}}\n" for number in range(30))
        analyze(self.PLAIN.replace(self.BRIEF, self.LONG).replace("chains:\n", f"chains:\n{chains}"))
        assert len(analyses) == 1

    def test_so_do_processes_without_a_response_time(self, analyses):
        system = describe_text(self.OVERLAPPING).assembly.system
        incomplete = Incomplete(reason="an incomplete Ticks")
        runnables = tuple(replace(each, activities=(incomplete, *each.activities)) for each in system.software.runnables)
        analysis = analyze_system(replace(system, software=replace(system.software, runnables=runnables)))
        assert len(analyses) == 1
        assert [each.response for each in analysis.processes] == [None, None]


def test_jobs_that_repeat_after_millions_of_others_are_not_looked_at_one_by_one():
    text = (SAMPLE.parent / "rclc-in-executor.yaml").read_text().replace("Control, period: 20 ms", "Control, period: 4000000 s")
    analysis = analyze(text)
    (rare,) = (each for each in analysis.callbacks if each.name == "Control_Callback")
    # The callback takes 150 us to 220 us.
    assert 150 * US <= rare.response.best <= 220 * US < rare.response.worst


THESIS = [row for problem in DESIGN.get("thesis", ()) for row in problem["rows"] if "breaks" not in row]


@pytest.mark.parametrize("row", every(10, THESIS), ids=lambda row: str(row["change"]))
def test_the_application_of_the_thesis_with_changes(row):
    text = SAMPLE.read_text().replace("1 ms, 10 ms", "500 us, 1 ms, 2 ms, 5 ms, 10 ms")
    keys = {
        "Executor_Task.period": ("period: 1 ms, execution_time: {base", "period: {} us, execution_time: {{base"),
        "Executor_Task.offset": ("period: 1 ms, execution_time: {base", "period: 1 ms, offset: {} us, execution_time: {{base"),
        "Message_Factor.period": ("rate: 50 Hz", "rate: 50 Hz, task_period: {} us"),
        "Message_Factor.offset": ("rate: 50 Hz", "rate: 50 Hz, offset: {} us"),
        "Control_Function.period": ("period: 1 ms, execution_time: 4", "period: {} us, execution_time: 4"),
        "Control_Function.offset": ("period: 1 ms, execution_time: 4", "period: 1 ms, offset: {} us, execution_time: 4"),
    }
    order = row["change"].get("priority_order", ["Executor_Task", "Control_Function", "Message_Factor"])
    for priority, name in enumerate(reversed(order), start=1):
        text = text.replace(f"- {{name: {name},", f"- {{name: {name}, priority: {priority},")
        text = text.replace(f"executor: {{name: {name},", f"executor: {{name: {name}, priority: {priority},")
    for key, value in row["change"].items():
        if key != "priority_order":
            old, new = keys[key]
            text = text.replace(old, new.format(value))
    analysis = analyze(text)
    assert (latency(analysis, "min_first_to_first"), latency(analysis)) == (row["best"], row["worst"])


PERIODS = [
    pytest.param(problem, row, id=f"{problem['id']}-{'-'.join(map(str, row[:3]))}")
    for problem in DESIGN.get("period_problems", ())
    for row in (*problem["feasible"], *problem["too_slow"])[::7]
    if problem["message_interval"] % row[0] == 0
]


@pytest.mark.parametrize(("problem", "row"), every(11, PERIODS))
def test_other_periods(problem, row):
    *periods, worst, best = row
    # Rate monotonic; at equal periods the executor, then the timer, then the subscription.
    order = sorted(zip(periods, (0, 2, 1), ("executor", "subscription", "timer"), strict=True), reverse=True)
    priority = {name: number for number, (*_, name) in enumerate(order, start=1)}
    executor, subscription, timer = periods
    cost, extra = problem["executor"]["base"], problem["executor"]["with_message"] - problem["executor"]["base"]
    text = f"""
amuros: 1
name: periods
hardware: single-core
middleware:
  executor:
    name: Executor_Task
    period: {executor} us
    priority: {priority["executor"]}
    execution_time: {{base: {cost} us, per_message: {extra} us}}
application:
  nodes:
    - name: node
      timers:
        - name: Control_Function
          period: {timer} us
          priority: {priority["timer"]}
          execution_time: {problem["timer"]["execution_time"]} us
          reads: [memory_2]
      subscriptions:
        - name: Message_Factor
          topic: factor
          interval: {problem["message_interval"]} us
          task_period: {subscription} us
          priority: {priority["subscription"]}
          message_size: 4 B
          execution_time: {problem["subscription"]["execution_time"]} us
          writes: [memory_2]
chains:
  - {{name: chain, path: [Executor_Task, Message_Factor, Control_Function]}}
"""
    analysis = analyze(text)
    assert (latency(analysis, "min_first_to_first"), latency(analysis)) == (best, worst)


class TestWhatRunsWhenItIsDue:
    """Message_Factor in a task of 1 ms, below the control function."""

    def test_it_does_not_run_in_the_other_activations_of_its_task(self):
        every, due = (
            analyze(sample(task=("rate: 50 Hz", f"rate: 200 Hz, priority: 0, task_period: 1 ms, runs_when: {when}")))
            for when in ("activated", "due")
        )
        load = Fraction(2 * US, MS)
        assert every.processors[0].worst - due.processors[0].worst == load - load / 5
        # Message and task are not synchronised: the message can wait for the callback for up to 4 ms.
        assert (latency(every), latency(due)) == (1016, 5029)

    def test_its_phase_can_be_stated(self):
        # The task runs in the activation in which the message is taken, after the control function: the next one uses it.
        task = "rate: 50 Hz, priority: 0, task_period: 1 ms, runs_when: due, phase: 7 ms"
        assert latency(analyze(sample(task=("rate: 50 Hz", task)))) == 1016


class TestAnIntervalThatIsNoMultipleOfThePeriod:
    """A message every 2.5 ms is taken after 2 and after 3 activations of the executor in turn."""

    def test_an_event_can_miss_an_activation_and_wait_for_three(self):
        analysis = analyze(sample(rate=("rate: 50 Hz", "interval: 2.5 ms, task_period: 1 ms, priority: 0")))
        best, worst, claim = times(analysis, "Executor_Task")
        assert best <= 12
        assert worst >= 25
        assert claim is Claim.BOUND
        # From just after a read to the next one 3 ms later, and from there as without waiting: 1016 us.
        assert latency(analysis, "max_reaction_time") >= 3000 + 1016
        assert {value.claim for value in analysis.chains[0].values} == {Claim.BOUND}


def test_what_is_assumed_of_a_chain_is_reported_also_if_only_the_phases_on_its_way_are_evaluated():
    def taking(message, every):
        return Call(runnable="take", counter=Counter(prescaler=every, offset=1, source=message, is_phase_known=False))

    others = [Proc(f"other {n}", (taking(f"message {n}", 7),), period=1000, priority=10 + n) for n in range(4)]
    built = system(
        Proc("taker", (taking("message", 3),), period=1000, priority=3),
        Proc("reader", (access("data", READ), ticks(10)), period=1000, priority=1),
        *others,
        labels=(Label(name="data"),),
        runnables=(Runnable(name="take", activities=(ticks(1), access("data", WRITE))),),
        events=(
            RunnableEvent(name="taken", runnable="take", change=RunnableChange.START, process="taker"),
            ProcessEvent(name="done", process="reader", change=ProcessChange.TERMINATE),
        ),
        chains=(replace(chain("open", "taken", "done"), stimulus=None),),
    )
    assert phases.MAX_COMBINATIONS < 3 * 7**4
    analysis = analyze_system(built)
    assert all(value.method.endswith("over all 3 phases") for value in analysis.chains["open"].values)
    assert "CHN007" in {finding.rule for finding in analysis.findings}
