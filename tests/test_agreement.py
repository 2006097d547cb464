"""Analysis and simulation agree about every file at hand: nothing observed is beyond a bound, nothing is missed that is met."""

from pathlib import Path

import pytest
from effort import every
from fuzzing.contradictions import contradictions
from support import ROOT, SHARED

from amalthea_uros.errors import AmurosError
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.simulate import simulate_files
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.units import Duration

#: Long enough for some jobs of usual periods.
DURATION = 100 * 10**9
#: Larger models take seconds.
LARGEST = 200_000
#: The others have tests of their own, which compare the same.
VECTORS = ("am2inc", "iprx", "migration")


def files(folder: Path, *suffixes: str) -> list[Path]:
    found = (path for path in sorted(folder.rglob("*")) if path.suffix in suffixes and path.is_file())
    return [path for path in found if 0 < path.stat().st_size <= LARGEST]


def named(step: int, paths: list[Path], root: Path) -> list[object]:
    if not paths:
        return [pytest.param(None, marks=pytest.mark.skip("the files are not at hand"))]
    return [pytest.param(path, id=str(path.relative_to(root))) for path in every(step, paths)]


def disagreements(path: Path) -> list[str]:
    """What simulations of a file show against its analysis; files that cannot be read or simulated have none."""
    found = []
    try:
        analysis = analyze_files(path).analysis
        for mode in (Mode.WORST, Mode.BEST, Mode.SAMPLED):
            simulation = simulate_files(path, Options(duration=Duration(DURATION), mode=mode)).simulation
            found += [f"{mode}: {text}" for text in contradictions(analysis, simulation)]
    except AmurosError:
        return found
    return found


@pytest.mark.parametrize("path", named(9, files(ROOT / "samples", ".amxmi", ".yaml"), ROOT))
def test_samples(path):
    assert disagreements(path) == []


@pytest.mark.parametrize("vectors", VECTORS)
def test_vectors(vectors):
    folder = SHARED / "vectors" / vectors
    if not folder.exists():
        pytest.skip("the files are not at hand")
    examined = every(60, files(folder, ".amxmi", ".iprx"))
    wrong = {path.name: texts[:3] for path in examined if (texts := disagreements(path))}
    assert wrong == {}


def test_published_models():
    if not SHARED.exists():
        pytest.skip("the models are not at hand")
    wrong = {path.name: texts[:3] for path in every(80, files(SHARED / "corpus", ".amxmi")) if (texts := disagreements(path))}
    assert wrong == {}
