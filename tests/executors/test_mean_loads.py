"""Nobody states how often an iteration of an executor takes a message: what depends on that has no mean."""

import pytest
from support import ROOT

import amalthea_uros as amuros


def means(sample):
    return {each.name: each.mean for each in amuros.analyze(ROOT / "samples" / f"{sample}.yaml").processors}


def test_neither_the_core_of_an_executor_nor_what_its_callbacks_send_has_a_mean_load():
    found = means("robot-xrce")
    assert found["Core_0"] is None
    assert found["TCP_to_agent"] is None
    assert found["TCP_to_controller"] is not None


@pytest.mark.parametrize(("sample", "core"), [("rclc-in-executor", "Core_0"), ("drive-and-lift", "Core_1")])
def test_a_mean_load_that_remains_is_what_a_simulation_observes(sample, core):
    simulation = amuros.simulate(ROOT / "samples" / f"{sample}.yaml", "10 s")
    assert float(means(sample)[core]) == pytest.approx(float(simulation.cores[core].load), rel=1e-3)
