"""What every command must say about the published small models, as their README has it, each computed by hand there."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import pytest
from command import amuros
from effort import every
from fuzzing.contradictions import contradictions
from support import SHARED, analysis_of

from amalthea_uros import analyze, simulate
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.simulate.results import Simulation

VERDICTS = SHARED / "vectors" / "verdicts"
MISSED, UNKNOWN, MET = "missed", "unknown", "met"


@dataclass(frozen=True, kw_only=True)
class Expected:
    """What is right about a model.

    Attributes
    ----------
    verdicts : of limits and of processes, by name: those that are allowed
    holds : what else holds for the analysis
    simulated : what holds for a simulation
    """

    verdicts: dict[str, set[str]] = field(default_factory=dict)
    holds: Callable[[Analysis], bool] = lambda _: True
    simulated: Callable[[Simulation], bool] = lambda _: True


def loads(analysis: Analysis, core: str) -> tuple[Fraction | None, ...]:
    return next((p.best, p.mean, p.worst) for p in analysis.processors if p.name == core)


def has_range(analysis: Analysis) -> bool:
    task = analysis["A"]
    return (task.bcet, task.acet, task.wcet) == (10**9, None, 2 * 10**9)


def none_missed(simulation: Simulation) -> bool:
    return all(item.verdict != "observed_missed" for item in simulation.requirements)


EXPECTED = {
    "stimulus-condition": Expected(verdicts={"age": {MISSED, UNKNOWN}}),
    "trigger-before-end": Expected(verdicts={"reaction": {MISSED}}),
    # 60 % are those of B alone, and A executes there, too.
    "migration": Expected(
        verdicts={"B": {UNKNOWN}}, holds=lambda a: loads(a, "c1")[2] is None or loads(a, "c1")[2] > Fraction(6, 10)
    ),
    "overhead-of-unknown": Expected(verdicts={"T": {MISSED, UNKNOWN}}),
    "mode-beside-data": Expected(verdicts={"reaction": {MISSED}}),
    "start-up": Expected(verdicts={"delay": {MISSED}}),
    # A executes 1 ms of 10, and 5 ms follow, whatever the branch is.
    "exclusive-triggers": Expected(
        holds=lambda a: loads(a, "C0") == (Fraction(6, 10),) * 3 and all(p.wcrt is not None for p in a.processes),
    ),
    "order-across-tasks": Expected(verdicts={"r1 before r2": {MET, UNKNOWN}}, simulated=none_missed),
    "old-open-bound": Expected(verdicts={"A": {UNKNOWN}}),
    "stated-bounds": Expected(holds=has_range),
    "zero-without-unit": Expected(simulated=lambda s: all(process.jobs for process in s.processes)),
    "zero-with-unit": Expected(simulated=lambda s: all(process.jobs for process in s.processes)),
    "report-without-jobs": Expected(verdicts={"B": {UNKNOWN, "None"}, "R": {UNKNOWN}}),
    "no-priority": Expected(holds=lambda a: all(process.wcrt is not None for process in a.processes)),
}

needs_models = pytest.mark.skipif(not VERDICTS.exists(), reason="the models are not at hand")
each = pytest.mark.parametrize("name", sorted(EXPECTED))


def path_of(name: str) -> Path:
    return VERDICTS / f"{name}.amxmi"


def said_falsely(verdicts: list[tuple[str, str]], expected: Expected) -> list[tuple[str, str]]:
    return [(name, said) for name, said in verdicts if name in expected.verdicts and said not in expected.verdicts[name]]


@needs_models
def test_all_models_are_expected():
    assert {path.stem for path in VERDICTS.glob("*.amxmi")} == set(EXPECTED)


@needs_models
@each
def test_analysis(name):
    analysis, expected = analysis_of(path_of(name)), EXPECTED[name]
    found = [*analysis.processes, *analysis.requirements]
    assert said_falsely([(item.name, str(item.verdict)) for item in found], expected) == []
    assert expected.holds(analysis)


@needs_models
@pytest.mark.parametrize("name", every(4, sorted(EXPECTED)))
def test_the_command_says_the_same(name, tmp_path):
    expected, report = EXPECTED[name], tmp_path / "analysis.json"
    ended = amuros("analyze", path_of(name), "--output", "text", "--output", f"json={report}")
    written = json.loads(report.read_text())
    found = [(item["name"], str(item["verdict"])) for part in ("processes", "requirements") for item in written[part]]
    assert said_falsely(found, expected) == []
    assert ended.returncode == (1 if written["summary"]["schedulable"] == "no" else 0)


@needs_models
@each
def test_simulation_agrees(name):
    expected, simulation = EXPECTED[name], simulate(path_of(name), "50 ms")
    assert list(contradictions(analysis_of(path_of(name)), simulation)) == []
    assert expected.simulated(simulation)
    must_not = {item for item, allowed in expected.verdicts.items() if MET not in allowed}
    missed_or_nothing = [r for r in simulation.requirements if r.name in must_not and UNKNOWN not in expected.verdicts[r.name]]
    assert all(item.verdict != "observed_ok" for item in missed_or_nothing)


@needs_models
@pytest.mark.parametrize("name", every(20, ["report-without-jobs", *sorted(EXPECTED)]))
def test_a_report_can_be_written(name, tmp_path):
    target = tmp_path / "report.html"
    ended = amuros("report", path_of(name), "-o", target)
    assert target.exists(), ended.stderr
    assert ended.returncode in (0, 1)


@needs_models
def test_a_migrated_file_means_the_same(tmp_path):
    path, target = path_of("old-open-bound"), tmp_path / "migrated.amxmi"
    amuros("migrate", path, "-o", target)
    before, after = (
        [(process.name, process.bcet, process.wcet, process.wcrt, process.verdict) for process in analyze(each).processes]
        for each in (path, target)
    )
    assert after == before


@needs_models
def test_zero_is_zero_without_a_unit():
    one, other = (analysis_of(path_of(name)) for name in ("zero-without-unit", "zero-with-unit"))
    assert [(p.bcet, p.wcet, p.wcrt) for p in one.processes] == [(p.bcet, p.wcet, p.wcrt) for p in other.processes]
