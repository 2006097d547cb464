"""The load of cores as rules see it, also of systems of which only a part is known."""

import pytest
from effort import every
from hypothesis import assume, given
from hypothesis import strategies as st
from opponent.generator import nested_model
from opponent.models.generator import random_model
from opponent.to_perf import read_system
from support import ROOT, SHARED, analysis_of, corpus, hand_written

from amalthea_uros import analyze_system, build_model, check, extract, load
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.software import Software, Task
from amalthea_uros.perf.stimuli import ArrivalCurve, ArrivalCurvePoint, Burst, Periodic, Stimuli, Synthetic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.validate.system_context import SystemContext


def total(system):
    """The load of each processing unit that has any, by its name."""
    return {core: share for core, share in SystemContext(system).certain_loads.items() if share}


def assert_same_load(system, analysis):
    """The analysis adds the overheads of the operating system, which none of these models specify."""
    found = total(system)
    for processor in analysis.processors:
        if processor.worst is not None:
            difference = processor.at_least - found.get(processor.name, 0)
            # The analysis rounds up what is no whole number of small parts of a picosecond.
            assert 0 <= difference <= processor.worst / 10**6
            assert processor.at_least <= processor.worst


SAMPLES = [pytest.param(path, id=path.name) for path in sorted((ROOT / "samples").glob("*.amxmi"))]


@pytest.mark.parametrize("path", [*SAMPLES, *every(3, corpus()), *hand_written()])
def test_the_load_is_that_of_the_analysis(path):
    if path.stem == "40_sched_computation":
        pytest.skip("scheduler decisions take time")
    if path.stem == "mobstr-mapped+safety":
        pytest.skip("the rules do not count a process that waits for events, the analysis knows what it executes")
    try:
        model = load(path)
    except ReadError:
        pytest.skip("the file cannot be read")
    assert_same_load(extract(model).system, analysis_of(path))


def test_the_load_of_a_model_in_several_files():
    folder = SHARED / "corpus" / "ESRTS+MATERIAL_Framework" / "Examples"
    if not folder.exists():
        pytest.skip("the published models are not at hand")
    parts = (
        "model_test/RPI_BBW_HW",
        "model_test/RPI_BBW_OS",
        "model_BBW_local/RPI_BBW_SW",
        "model_BBW_local/RPI_BBW_mapping_local",
    )
    system = extract(load(*(folder / f"{part}.amxmi" for part in parts))).system
    assert len(total(system)) == 4
    assert_same_load(system, analyze_system(system))


@pytest.mark.parametrize(("make", "step"), [(nested_model, 5), (random_model, 20)])
def test_the_load_of_random_systems(make, step):
    for seed in every(step, range(200)):
        model = make(seed)
        if "scheduler overhead" not in model.features:
            system = read_system(model.text)
            assert_same_load(system, analyze_system(system))


SPANS = st.sampled_from([0, 1, MS, 5 * MS, 12 * MS])
DENSE = st.one_of(
    st.builds(
        Periodic,
        name=st.just("S0"),
        period=st.just(5 * MS),
        jitter=st.none() | st.builds(Boundaries, lower=st.just(-MS), upper=SPANS),
        min_distance=st.none() | SPANS,
    ),
    st.builds(Synthetic, name=st.just("S0"), period=st.just(5 * MS), times=st.lists(SPANS, min_size=1, max_size=4).map(tuple)),
    st.builds(Burst, name=st.just("S0"), period=st.just(90 * MS), length=SPANS, distance=SPANS, count=st.integers(1, 5)),
    st.builds(
        ArrivalCurve,
        name=st.just("S0"),
        points=st.lists(st.builds(ArrivalCurvePoint, occurrences=st.integers(1, 5), lower=st.none() | SPANS), max_size=3).map(
            tuple
        ),
    ),
)


@given(DENSE, st.integers(1, 5))
def test_activations_at_once_are_those_of_the_analysis(stimulus, limit):
    system = System(
        stimuli=Stimuli(stimuli=(stimulus,)),
        software=Software(tasks=(Task(name="T", stimuli=("S0",), activation_limit=limit),)),
    )
    activations = event_model_of(stimulus, system)
    assume(activations is not None)
    found = check(build_model(system), ["TIM-ACTIVATION-LIMIT"])
    assert bool(found) is (activations.eta_plus(1) > limit)
