"""A simulation takes no more memory the denser its activations are, and says beforehand what would take days."""

import gc

import pytest
from by_hand import built
from hand_made_systems import Proc, ticks

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.stimuli import Periodic, Single, Synthetic
from amalthea_uros.perf.system import System
from amalthea_uros.services.report import compile_report
from amalthea_uros.services.simulate import simulate_campaign
from amalthea_uros.simulate.arrivals import least_count, occurrences
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs import driver
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import SECOND, Duration


@pytest.mark.parametrize(
    ("stimulus", "count"),
    [
        (Periodic(name="s", period=1), 100),
        (Periodic(name="s", period=10, offset=5), 9),
        (Periodic(name="s", period=10, offset=500), 0),
        # 0, 12, 10, 22, ... of which the last ones may be after the end.
        (Synthetic(name="s", period=10, times=(0, 12)), 16),
        (Single(name="s", time=7), 0),
        (Periodic(name="s", period=0), 0),
    ],
)
def test_how_often_a_stimulus_occurs_at_least(stimulus, count):
    assert least_count(stimulus, 100) == count


def test_dense_occurrences_are_prepared_in_short_windows():
    source = RandomSource(1, "s")
    found = occurrences(Periodic(name="s", period=1), System(), Mode.SAMPLED, source, 1)
    time = total = 0
    for _ in range(5):
        until = found.reach(time, 10**12, 100)
        assert until > time
        times = found.until(until)
        assert 0 < len(times) < 10_000
        time, total = until, total + len(times)
    assert total == time  # one in each picosecond
    # Sparse ones are prepared up to the end that is asked for.
    rare = occurrences(Periodic(name="s", period=10**12), System(), Mode.SAMPLED, source, 1)
    assert rare.reach(0, 10**12, 100) == 10**12


def test_more_occurrences_than_can_be_simulated_are_refused_with_their_number():
    found = simulate_system(built(Proc("T", (ticks(1),), 1)), Options(duration=Duration(2000 * SECOND)))
    (finding,) = found.findings
    assert (finding.rule, finding.object) == ("SIM001", "T")
    assert "occurs 2,000,000,000 times in 2000 s; at most 1,000,000,000 occurrences" in finding.message


def test_a_run_ends_where_no_more_activations_can_be_kept(monkeypatch):
    monkeypatch.setattr(driver, "WAITING_NUMBERS", 300)
    often = Proc("often", (ticks(2),), 1, task={"activation_limit": 10**9})
    found = simulate_system(built(often), Options(duration=Duration(10**4 * US)))
    (finding,) = [each for each in found.findings if each.rule == "SIM007"]
    assert finding.object == "often"
    assert finding.message.endswith("activations of 'often' wait; the run ends there")
    # One job in 2 us; what was seen before counts.
    assert 0 < found.processes["often"].jobs < 5000


def test_the_memory_of_a_run_is_free_once_it_is_evaluated():
    """Garbage is collected rarely, so that a campaign of short runs would take a gigabyte."""

    def long_lists():
        return sum(type(each) is list and len(each) > 50_000 for each in gc.get_objects())

    system, options = built(Proc("T", (ticks(1),), 1)), Options(duration=Duration(10 * US))
    simulate_system(system, options)
    gc.collect()
    before = long_lists()
    gc.disable()
    try:
        simulate_system(system, options)
        assert long_lists() == before
    finally:
        gc.enable()


DENSE = """
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
tasks:
  - {name: A, period: 1 ps, execution_time: 1 ps, priority: 1}
"""


def test_a_campaign_that_would_take_days_is_refused_before_its_first_run(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(DENSE)
    message = "in 1,000,000 runs of 1 us there are 1,000,000,000,000 activations, most by 'every_1_ps'; at most 100,000,000,000"
    with pytest.raises(InvalidArgumentError, match=message):
        simulate_campaign(path, Options(duration=Duration(US)), repetitions=1_000_000, on_outcome=pytest.fail)


def test_a_report_simulates_few_jobs_however_short_a_period_is():
    """In each picosecond, there are a job and a call of a runnable."""
    assert 2 * compile_report(DENSE).simulation.options.duration == 20_000
