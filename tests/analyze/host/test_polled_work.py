"""The busy window of an executor is followed once, however many jobs are in it."""

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.analyze.host import polled

ROBOT = (ROOT / "samples" / "robot-with-host.yaml").read_text()
IMAGES = "{topic: image, rate: 20 Hz, jitter: 5 ms}"


@pytest.mark.parametrize("seconds", [5, 10])
def test_the_steps_grow_with_the_jobs(seconds, monkeypatch):
    """With a fixed-point iteration from its release on, each job takes as many steps as all before it together."""
    steps, of_others = [], polled._BusyWindow._of_others

    def counted(window, task, length):
        steps.append(task.name)
        return of_others(window, task, length)

    monkeypatch.setattr(polled._BusyWindow, "_of_others", counted)
    assert IMAGES in ROBOT
    amuros.analyze(ROBOT.replace(IMAGES, f"{{topic: image, rate: 20 Hz, jitter: {seconds} s}}"))
    assert 0 < len(steps) < 40_000 * seconds
