"""The busy window of an executor is followed once, however many jobs are in it."""

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.analyze.host import polled
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import SporadicEvents

ROBOT = (ROOT / "samples" / "robot-with-host.yaml").read_text()
IMAGES = "{topic: image, rate: 20 Hz, jitter: 5 ms}"


def steps_of(monkeypatch):
    """The steps in which busy windows are looked at, as they are taken."""
    steps, served = [], polled._BusyWindow._served
    monkeypatch.setattr(polled._BusyWindow, "_served", lambda *given: steps.append(given) or served(*given))
    return steps


@pytest.mark.parametrize("seconds", [5, 10])
def test_the_steps_grow_with_the_jobs(seconds, monkeypatch):
    """With a fixed-point iteration from its release on, each job takes as many steps as all before it together."""
    steps = steps_of(monkeypatch)
    assert IMAGES in ROBOT
    amuros.analyze(ROBOT.replace(IMAGES, f"{{topic: image, rate: 20 Hz, jitter: {seconds} s}}"))
    assert 0 < len(steps) < 8_000 * seconds


def test_the_examined_jobs_are_work(monkeypatch):
    steps = steps_of(monkeypatch)
    analysis = amuros.analyze(ROBOT.replace(IMAGES, "{topic: image, rate: 20 Hz, jitter: 1 s}"))
    assert 1_000 < len(steps) < 1.5 * analysis.work < 3 * len(steps)


def test_jobs_that_cannot_take_longer_are_not_examined(monkeypatch):
    """A burst of 101 jobs, then one every 10: those of the burst count once, those near the end of the busy window not at all."""
    burst = AnalysedTask(name="burst", events=SporadicEvents(10, 1000), demand=MultiframeDemand.constant(5, 5))
    steps = steps_of(monkeypatch)
    response = polled.response_times([burst])["burst"]
    jobs = range(1, burst.events.eta_plus(1000) + 1)
    assert response.worst == max(5 * job - burst.events.delta_min(job) for job in jobs) == 505
    # The busy window is 1000 long, so that what is released from 495 on takes no longer than 505. One step finds the end of the burst,
    # one confirms it, and one excludes that each later job takes longer.
    assert response.jobs == 50
    assert len(steps) == 2 + 49
