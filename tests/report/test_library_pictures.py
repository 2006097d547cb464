"""Pictures as objects of the library."""

import pytest

import amalthea_uros as amuros

SYSTEM = amuros.taskset([(5, 1), (10, 2)], unit="ms", priorities="rate monotonic")


@pytest.fixture(scope="module")
def simulation():
    return amuros.simulate(SYSTEM, "100 ms")


def test_pictures_of_a_simulation(simulation, tmp_path):
    for drawn in (
        amuros.gantt(simulation),
        amuros.gantt(simulation, process="T2"),
        amuros.gantt(simulation, window=("0 ms", amuros.Duration.of("10 ms"))),
        amuros.timeline(simulation, "T1"),
        amuros.histogram(simulation, "T2"),
    ):
        assert drawn._repr_svg_().startswith("<svg")
        drawn.save(tmp_path / "drawn.svg")
        assert (tmp_path / "drawn.svg").read_text(encoding="utf-8") == drawn.svg


def test_a_sweep_as_a_picture():
    swept = amuros.sweep(SYSTEM, ["T1.execution_time=1ms,2ms,3ms"])
    assert "T2.worst_case_response_time" in amuros.picture(swept, "T2.worst_case_response_time").svg
    with pytest.raises(amuros.InvalidArgumentError, match="name one"):
        amuros.picture(swept)


def test_what_cannot_be_drawn(simulation, tmp_path):
    with pytest.raises(amuros.InvalidArgumentError, match="'T3'"):
        amuros.gantt(simulation, process="T3")
    with pytest.raises(amuros.InvalidArgumentError, match="use only one"):
        amuros.gantt(simulation, process="T1", window=("0 ms", "1 ms"))
    with pytest.raises(amuros.InvalidArgumentError, match="the run ends at 100 ms"):
        amuros.timeline(simulation, "T1", window=("1 s", "2 s"))
    with pytest.raises(amuros.InvalidArgumentError, match=r"does not end with \.svg"):
        amuros.gantt(simulation).save(tmp_path / "drawn.png")
    with pytest.raises(TypeError, match="gantt, timeline and histogram draw simulations"):
        amuros.picture(simulation)
