"""Models with every construct of the language are simulated, and nothing occurs that is known not to occur."""

from importlib.util import find_spec

import numpy as np
import pytest
from effort import every
from opponent.observation import Horizon
from opponent.simulation import beyond, latencies, record
from opponent.to_perf import MICROSECOND, to_perf
from opponent.vectors import facts, needs_vectors, plain_systems

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.simulate.options import Mode, Options

FACTS = facts() if not needs_vectors.args[0] else {}
SYSTEMS = plain_systems() if FACTS else {}
RUNS = ((Mode.SAMPLED, 1), (Mode.SAMPLED, 2), (Mode.WORST, 1), (Mode.BEST, 1), (Mode.AVERAGE, 1))


def runs_of(name):
    system, duration = to_perf(SYSTEMS[name]), Horizon.of(SYSTEMS[name]).end * MICROSECOND
    return [record(system, Options(duration=duration, mode=mode, seed=seed)) for mode, seed in RUNS]


@needs_vectors
@pytest.mark.parametrize("block", range(8))
def test_nothing_occurs_beyond_what_is_known_or_claimed(block):
    wrong = []
    for name in every(4, sorted(FACTS)[block::8]):
        runs, steady = runs_of(name), Horizon.of(SYSTEMS[name]).begin * MICROSECOND
        assert not any(run.program.left_out or run.program.chains_left_out for run in runs), name
        wrong += [f"{name} {text}" for text in different(FACTS[name], runs, steady)]
        wrong += [f"{name} {text}" for text in beyond(analyze_system(to_perf(SYSTEMS[name])), runs, steady)]
    assert wrong == []


def different(fact, runs, steady):
    """What is determined, but was simulated differently."""
    for name, known in fact["processes"].items():
        responses = {end - activation for run in runs for activation, _, end in run.jobs_of(name)}
        expected = known["occurs_min_us"] * MICROSECOND, known["occurs_max_us"] * MICROSECOND
        if known["determined"] and (min(responses), max(responses)) != expected:
            yield f"{name}: {min(responses)}..{max(responses)}, not {expected}"
    for chain, known in fact["chains"].items():
        for run in runs if known["determined"] else ():
            observed = latencies(run, chain, steady)
            for quantity, value in known.items():
                side, _, what = quantity.partition("_")
                if what in observed and value is not None:
                    found = getattr(observed[what], side)
                    if found != value * MICROSECOND:
                        yield f"{chain}: {quantity} {found}, not {value}"


@needs_vectors
@pytest.mark.skipif(find_spec("numba") is None, reason="numba is not installed")
def test_machine_code_plays_as_the_interpreted_kernel_does():
    for name in sorted(FACTS)[::12]:
        options = Options(duration=500 * MICROSECOND, seed=3, traced=(0, 300 * MICROSECOND))
        slow, fast = (record(to_perf(SYSTEMS[name]), options, is_compiled=compiled) for compiled in (False, True))
        for kind in ("jobs", "observations", "events"):
            np.testing.assert_array_equal(getattr(fast, kind), getattr(slow, kind), err_msg=f"{name} {kind}")
