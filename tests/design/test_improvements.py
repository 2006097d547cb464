"""Changes that shorten a latency, against the values of the changed systems that were played through, and against separate analyses."""

from dataclasses import replace
from functools import cache
from itertools import product

import pytest
from effort import every
from support import ROOT

from amalthea_uros.analyze import system as analyze_module
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design import improvements as improvements_module
from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.constraints import Bound, Requirement, TimeLimit, TimeMetric
from amalthea_uros.report.documents.explanation import tried
from amalthea_uros.services.analyze import analyze, analyze_files
from amalthea_uros.services.explain import explain, improvements
from amalthea_uros.services.subject import open_system
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

SAMPLES = ROOT / "samples"
CHAIN = "factor-to-output"


@pytest.fixture(scope="module")
def advanced():
    return analyze_files(SAMPLES / "bodas-test-advanced.yaml")


#: The worst phase of the message, of which there is much less to analyse than of all.
PHASE = Settings(phases={"Message_Factor": "1 ms"})


@pytest.fixture(scope="module")
def of_one_phase():
    return analyze_files(SAMPLES / "bodas-test-advanced.yaml", PHASE)


@pytest.fixture(scope="module")
def drive():
    return analyze_files(SAMPLES / "drive-and-lift.yaml")


@pytest.fixture(scope="module")
def shorter_drive(drive):
    return cache(lambda *of: improvements(drive, *of))


@pytest.fixture(scope="module")
def shorter(advanced):
    return improvements(advanced, CHAIN)


def effects(found):
    return {each.change.text: (each.before // US, each.after // US) for each in found.found}


def test_the_changes_of_the_thesis(shorter):
    """The values of each change over all phases of the message, found by playing the schedules through."""
    found = effects(shorter)
    assert found["period of Message_Factor 20 ms -> 10 ms"] == (20_029, 10_016)
    # In each millisecond, with the priority of that rate: the executor takes the message, and both functions follow at once.
    assert found["period of Message_Factor 20 ms -> 1 ms"] == (20_029, 31)
    assert found["exchange the priorities of Message_Factor and Control_Function"] == (20_029, 19_018)
    assert found["exchange the priorities of Control_Function and Executor_Task"] == (20_029, 20_000)
    # Message_Factor above all others is no better than now.
    assert "priority of Message_Factor 1 -> 4" not in found


def test_periods_that_are_not_on_offer_in_a_description():
    """A model does not say which periods the platform offers, so parts of the period are tried."""
    found = effects(improvements(analyze_files(SAMPLES / "bodas-test-advanced.amxmi", PHASE), CHAIN))
    assert found["period of Message_Factor 20 ms -> 2 ms"] == (20_029, 2_016)


def test_the_shortest_is_the_first(shorter):
    alone = [each.after for each in shorter.found if not each.change.is_combined]
    assert alone == sorted(alone)
    assert all(each.after < each.before == 20_029 * US for each in shorter.found)


def test_a_longer_period_is_no_proposal(shorter):
    """A slower executor takes messages later, which a latency that begins at the executor does not include."""
    changes = [change for each in shorter.found for change in each.change.changes]
    assert "Executor_Task.period" not in {change.target for change in changes}


@pytest.mark.parametrize(
    ("chain", "quantity"),
    every(
        4,
        list(
            product(
                ("speed-to-torque", "height-to-log"), (LatencyQuantity.MAX_REDUCED_REACTION_TIME, LatencyQuantity.MAX_DATA_AGE)
            )
        ),
    ),
)
def test_each_value_is_that_of_a_separate_analysis(drive, shorter_drive, chain, quantity):
    for each in every(9, shorter_drive(chain, quantity).found):
        settings = Settings(communication=each.change.communication)
        value = analyze(SAMPLES / "drive-and-lift.yaml", settings, changes=each.change.changes).chains[chain].value(quantity)
        assert (each.after, each.claim) == (value.value, value.claim)


def test_what_a_change_breaks_is_said(advanced):
    """Above the control function, the callback delays it: 25 for the executor, 2 for the callback and its own 4."""
    limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=29 * US)
    requirement = Requirement(name="tight", process="Control_Function", limit=limit)
    system = replace(advanced.system, constraints=replace(advanced.system.constraints, requirements=(requirement,)))
    result = replace(advanced, system=system, analysis=analyze_system(system), changed=None)
    (exchanged,) = [
        each for each in improvements(result, CHAIN).found if each.change.text.endswith("Message_Factor and Control_Function")
    ]
    assert not exchanged.is_safe
    assert ("tight", "met", "missed") in [(each.name, each.before, each.after) for each in exchanged.drawbacks]


def test_changes_of_communication_have_an_option():
    result = analyze_files(SAMPLES / "drive-and-lift.yaml", Settings(communication=Communication.LET))
    found = improvements(result, "speed-to-torque").found
    (implicit,) = [each for each in found if each.change.communication is Communication.IMPLICIT]
    assert implicit.change.options == ("--communication", "implicit")
    assert implicit.before == 110 * MS


def test_no_more_analyses_than_the_limit(of_one_phase, monkeypatch):
    monkeypatch.setattr(improvements_module, "MAX_ANALYSES", 3)
    found = improvements(of_one_phase, CHAIN)
    alone = [each for each in found.found if not each.change.is_combined]
    assert (len(alone) <= 3, found.untried > 0) == (True, True)


def test_those_of_a_chain_are_part_of_its_explanation(of_one_phase):
    assert explain(of_one_phase, CHAIN).improvements == improvements(of_one_phase, CHAIN)
    assert explain(of_one_phase, "Executor_Task").improvements is None


def test_what_bounds_a_chain_without_a_bound():
    """Sixty times as long, everything together needs more than the core; twice as fast a clock makes it fit again."""
    result = analyze_files(SAMPLES / "bodas-test-advanced.amxmi", replace(PHASE, scale=60))
    found = improvements(result, CHAIN).found
    assert [each.change.text for each in found if each.before is None] == ["frequency of Core_0 1 MHz -> 2 MHz"]


def test_other_chains_that_take_longer_are_drawbacks(shorter_drive):
    """After the exchange Control_Speed runs after Set_Speed, whose 30 us its own chain then waits for, too."""
    found = shorter_drive("speed-to-torque", LatencyQuantity.MAX_REDUCED_REACTION_TIME).found
    (exchanged,) = [each for each in found if each.change.text == "exchange the priorities of Set_Speed and Control_Speed"]
    assert [(each.name, each.before, each.after) for each in exchanged.drawbacks] == [
        ("max reduced reaction time of wheel-to-torque", "15.2821 ms", "15.3121 ms"),
        ("max reduced data age of wheel-to-torque", "25.2821 ms", "25.3121 ms"),
    ]
    assert exchanged.is_safe


def test_the_phases_of_a_change_that_shortens_nothing_are_not_all_analysed(monkeypatch):
    """A changed system with 20 phases, of which the first one refutes the change, takes one analysis instead of 20."""
    analyses = []
    of_phase = analyze_module._analysis
    monkeypatch.setattr(analyze_module, "_analysis", lambda *given: analyses.append(given) or of_phase(*given))
    system = open_system([SAMPLES / "bodas-test-advanced.yaml"]).system
    assert analyze_module.analyze_while(system, None, lambda _analysis: False) is None
    assert len(analyses) == 1
    whole = analyze_module.analyze_while(system, None, lambda _analysis: True)
    assert len(analyses) == 1 + 20
    assert whole.chains == analyze_module.analyze_system(system).chains


@pytest.mark.parametrize("limit", [1, 5_000, 20_000])
def test_the_work_of_all_phases_of_all_changes_is_bounded(limit, monkeypatch, advanced):
    """The work of each combination of phases that is analysed counts; the analysis that reaches the limit is completed."""
    monkeypatch.setattr(improvements_module, "MAX_WORK", limit)
    work = []

    def started(system, settings, is_wanted):
        assert sum(work) < limit
        work.append(0)

        def is_wanted_for(analysis):
            work[-1] += analysis.work
            return is_wanted(analysis)

        return analyze_module.analyze_while(system, settings, is_wanted_for)

    monkeypatch.setattr(improvements_module, "analyze_while", started)
    found = improvements(advanced, CHAIN)
    assert limit <= sum(work) < limit + max(work)
    assert found.untried > 0
    assert "more were not tried, because the analyses of the changed systems" in tried(found)


def test_the_work_of_an_analysis_without_unknown_phases_counts_too(monkeypatch, of_one_phase):
    analyses, one = [], improvements_module.analyze_while
    monkeypatch.setattr(improvements_module, "analyze_while", lambda *given: analyses.append(given) or one(*given))
    monkeypatch.setattr(improvements_module, "MAX_WORK", 1)
    assert improvements(of_one_phase, CHAIN).is_work_exceeded
    assert len(analyses) == 1


def test_only_changes_that_are_found_are_analysed_for_all_phases(monkeypatch, advanced):
    """Combined changes that are not better than each of them alone are given up like those that shorten nothing."""
    whole = []

    def counted(*given):
        after = analyze_module.analyze_while(*given)
        whole.extend([after] if after else [])
        return after

    monkeypatch.setattr(improvements_module, "analyze_while", counted)
    found = improvements(advanced, CHAIN)
    assert len(whole) == len(found.found) < found.tried


def test_changes_with_the_same_effect_are_analysed_once(monkeypatch, advanced):
    """Such as the bit rate of the bus, on which nothing in this system depends."""
    systems = []

    def counted(system, settings, is_wanted):
        systems.append((system, settings))
        return analyze_module.analyze_while(system, settings, is_wanted)

    monkeypatch.setattr(improvements_module, "analyze_while", counted)
    found = improvements(advanced, CHAIN)
    present = advanced.analysis.solution.context
    different = [each for number, each in enumerate(systems) if each not in systems[:number]]
    assert systems == different
    assert (present.system, present.settings) not in systems
    assert len(systems) < found.tried
