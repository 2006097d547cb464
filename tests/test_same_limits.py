"""All commands that judge limits judge the same ones, and none says that a limit is met where another one does not."""

import json

import pytest
from command import amuros
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


def last_line(*arguments):
    run = amuros(*arguments)
    return (run.stdout or run.stderr).rstrip().splitlines()[-1], run.returncode


@pytest.mark.parametrize(
    ("model", "found", "code"),
    [
        # Nothing is executed; nothing was missed, but neither was anything kept.
        ("no-priority", "not everything was simulated in 2: nothing was executed; 'A' is not simulated: it has no priority", 1),
        ("zero-with-unit", "no deadline, requirement or constraint to judge", 0),
        ("order-across-tasks", "nothing missed", 0),
        ("trigger-before-end", "limits missed or activations lost in 2 (reaction.reaction)", 1),
    ],
)
def test_many_runs_praise_nothing_that_was_not_observed(model, found, code):
    path = FOLDER / f"{model}.amxmi"
    if not path.exists():
        pytest.skip("the file is not at hand")
    command = ("simulate", path, "--duration", "2ms", "--runs", "2", "--jobs", "1")
    line, returned = last_line(*command)
    assert line.startswith(f"Observed in 2 runs of 2 ms each: {found}")
    assert returned == code
    assert json.loads(amuros(*command, "--output", "json").stdout)["summary"]["text"] == line
