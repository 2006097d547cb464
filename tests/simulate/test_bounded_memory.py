"""A simulation takes no more memory the denser its activations are, and says beforehand what would take days."""

import pytest
from by_hand import built
from hand_made_systems import Proc, ticks

from amalthea_uros.perf.stimuli import Periodic, Single, Synthetic
from amalthea_uros.perf.system import System
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
