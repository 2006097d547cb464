"""Bounds that are stated count, also if the rest of the distribution is not."""

import pytest
from test_migrated_answers import observed, with_item

from amalthea_uros import analyze_files
from amalthea_uros.services.simulate import simulate_files
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.units import MILLISECOND, Duration

#: At 100 MHz, 100000 ticks take 1 ms.
BOUNDS = 'lowerBound="100000" upperBound="200000"'


@pytest.mark.parametrize(
    ("kind", "missing"),
    [
        ("GaussDistribution", "mean"),
        ("Statistics", "average"),
        ("WeibullEstimatorsDistribution", "average"),
        ("BetaDistribution", "alpha"),
    ],
)
def test_ticks_between_two_bounds(kind, missing, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(with_item("1.0.0", f'<items t="Ticks"><default t="DiscreteValue{kind}" {BOUNDS}/></items>'))
    result = analyze_files(path)
    response = result.analysis.processes["A"].response
    assert (response.best, response.worst) == (MILLISECOND, 2 * MILLISECOND)
    assert f"DiscreteValue{kind} is incomplete: it has no {missing}" in {finding.message for finding in result.findings}
    assert observed([path]) == []
    for mode, expected in ((Mode.WORST, 2), (Mode.BEST, 1)):
        options = Options(duration=Duration(20 * MILLISECOND), mode=mode)
        simulation = simulate_files([path], options).simulation
        assert simulation.processes["A"].response_time.max == expected * MILLISECOND


def test_distances_between_two_bounds(tmp_path):
    path = tmp_path / "model.amxmi"
    distances = """<stimuli t="RelativePeriodicStimulus" name="P"><nextOccurrence t="TimeWeibullEstimatorsDistribution">
        <lowerBound value="5" unit="ms"/><upperBound value="9" unit="ms"/></nextOccurrence></stimuli>"""
    item = '<items t="Ticks"><default t="DiscreteValueConstant" value="100000"/></items>'
    path.write_text(with_item("1.0.0", item, distances))
    process = analyze_files(path).analysis.processes["A"]
    assert process.response.worst == MILLISECOND
    assert process.deadline == 5 * MILLISECOND
    assert observed([path]) == []
