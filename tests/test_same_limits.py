"""All commands that judge limits judge the same ones, and none says that a limit is met where another one does not."""

import pytest
from support import SHARED

from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.simulate import simulate_files
from amalthea_uros.simulate.options import Options
from amalthea_uros.units import MILLISECOND as MS

FOLDER = SHARED / "vectors" / "verdicts"
#: Their only stimulus has no minimum distance: the analysis says that this is unknown, although no limit is stated.
WITHOUT_LIMIT = ("zero-with-unit", "zero-without-unit")
MODELS = sorted(FOLDER.glob("*.amxmi")) or [pytest.param(None, marks=pytest.mark.skip("the files are not at hand"))]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path and path.stem)
def test_analysis_and_simulation_judge_the_same_limits(path):
    if path.stem in WITHOUT_LIMIT:
        return
    analysis = analyze_files(path).analysis
    simulation = simulate_files(path, Options(duration=MS)).simulation
    judged = [*(each for each in analysis.processes if each.verdict is not None), *analysis.requirements]
    assert sorted((each.name, each.quantity) for each in simulation.judged) == sorted(
        (each.name, each.quantity) for each in judged
    )
