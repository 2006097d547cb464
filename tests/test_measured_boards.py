"""The models of measured boards contain what was measured: bounds all values, simulated means within 20 %."""

import re

import pytest
from support import ROOT

from amalthea_uros import analyze, simulate
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MILLISECOND

PAGE = (ROOT / "docs" / "measured-boards.md").read_text()
ROWS = re.findall(r"^\| (measured at .+?) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", PAGE, re.MULTILINE)


@pytest.fixture(scope="module")
def pico(tmp_path_factory):
    path = tmp_path_factory.mktemp("boards") / "pico.yaml"
    path.write_text(re.search(r'title="pico.yaml"\n(.*?)^```', PAGE, re.DOTALL | re.MULTILINE)[1])
    return path


def test_the_bound_of_the_round_trip_contains_30_000_measured_values(pico):
    chain = analyze(pico).chains["round-trip"]
    assert len(ROWS) == 3
    for _, least, _, most in ROWS:
        assert chain.best / MILLISECOND <= float(least)
        assert float(most) <= chain.worst / MILLISECOND


def test_the_simulated_mean_is_near_the_measured_ones(pico):
    reaction = simulate(pico, "10 s").chains["round-trip"].quantities[ChainQuantity.REDUCED_REACTION_TIME]
    for _, _, mean, _ in ROWS:
        assert float(reaction.mean) / MILLISECOND == pytest.approx(float(mean), rel=0.2)
