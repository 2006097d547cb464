"""The load of cores as rules see it, also of systems of which only a part is known."""

from fractions import Fraction

import pytest
from effort import every, examples
from hand_made_systems import of_parts
from hypothesis import assume, given
from hypothesis import strategies as st
from support import ROOT, SHARED, analysis_of, corpus, hand_written

from amalthea_uros import analyze_system, build_model, check, extract, load
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.activities import (
    Call,
    Case,
    Chance,
    Count,
    Demand,
    Execute,
    ExecutionNeed,
    Group,
    ProbabilitySwitch,
    Switch,
    Trigger,
)
from amalthea_uros.perf.distributions import Boundaries, Bucket, Constant, Gauss, Histogram
from amalthea_uros.perf.hardware import Clock, Core, CoreType, Feature, Hardware, Structure
from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation
from amalthea_uros.perf.os import InterruptController, Policy
from amalthea_uros.perf.software import Isr, Runnable, Software, Task
from amalthea_uros.perf.stimuli import (
    ArrivalCurve,
    ArrivalCurvePoint,
    Burst,
    Counter,
    InterProcess,
    Periodic,
    RelativePeriodic,
    Single,
    Stimuli,
    Synthetic,
)
from amalthea_uros.perf.system import System
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.validate.system_context import SystemContext

CORES = {"core 0": ("small", 1_000_000), "core 1": ("big", 3_000_000)}
#: Ticks for each unit of a need; the second one is the inverse of instructions per cycle.
FEATURES = {"small": (2.0, 0.5), "big": (1.0, 2.0)}
HARDWARE = Hardware(
    clocks=tuple(Clock(name=f"clock of {core}", frequency=Fraction(hertz)) for core, (_, hertz) in CORES.items()),
    core_types=tuple(
        CoreType(
            name=name,
            features=(
                Feature(category="Matrix", name="cost", value=cost),
                Feature(category="Vector", name="IPC_1", value=rate),
            ),
        )
        for name, (cost, rate) in FEATURES.items()
    ),
    structures=(
        Structure(
            name="ECU", cores=tuple(Core(name=core, type=kind, clock=f"clock of {core}") for core, (kind, _) in CORES.items())
        ),
    ),
)


def total(model):
    """The load of each processing unit that has any, by its name."""
    return {core: share for core, share in SystemContext(extract(model).system).certain_loads.items() if share}


def assert_same_load(model, analysis):
    """The analysis adds the overheads of the operating system, which none of these models specify."""
    found = total(model)
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
    try:
        model = load(path)
    except ReadError:
        pytest.skip("the file cannot be read")
    assert_same_load(model, analysis_of(path))


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
    model = load(*(folder / f"{part}.amxmi" for part in parts))
    assert len(total(model)) == 4
    assert_same_load(model, analyze_system(extract(model).system))


# Random systems


TICKS = st.integers(0, 30).flatmap(
    lambda minimum: st.sampled_from(
        [
            Constant(minimum),
            Boundaries(lower=minimum, upper=minimum + 7),
            Gauss(mean=minimum + 1.0, deviation=1.0, lower=minimum, upper=minimum + 3),
            Histogram(
                (
                    Bucket(lower=minimum, upper=minimum + 9, occurrences=1),
                    Bucket(lower=minimum + 2, upper=minimum + 4, occurrences=2),
                )
            ),
        ]
    )
)
DEMANDS = st.builds(
    Demand,
    ticks=TICKS,
    by_core_type=st.lists(
        st.tuples(st.sampled_from(["small", "big"]), TICKS), max_size=2, unique_by=lambda entry: entry[0]
    ).map(tuple),
)
COUNTERS = st.none() | st.builds(Counter, prescaler=st.integers(1, 5), offset=st.integers(0, 3))
COUNTS = (
    st.none() | st.builds(Count, least=st.just(0), mean=st.just(1.0), most=st.integers(1, 3)) | st.sampled_from([1.0, 2.0, 3.0])
)


def activities(runnables, stimuli):
    """What processes and runnables may do: call some runnables, trigger some stimuli."""
    single = [
        st.builds(Execute, demand=DEMANDS),
        st.builds(ExecutionNeed, needs=st.tuples(st.tuples(st.sampled_from(["Matrix", "Vector", "Instructions"]), TICKS))),
    ]
    if runnables:
        single.append(st.builds(Call, runnable=st.sampled_from(runnables), counter=COUNTERS, times=COUNTS))
    if stimuli:
        single.append(st.builds(Trigger, stimulus=st.sampled_from(stimuli), counter=COUNTERS))

    def several(inner):
        body = st.lists(inner, max_size=3).map(tuple)
        return (
            st.builds(Group, activities=body)
            | st.builds(
                Switch, cases=st.lists(st.builds(Case, activities=body), max_size=2).map(tuple), default=st.none() | body
            )
            | st.builds(
                ProbabilitySwitch,
                branches=st.lists(st.builds(Chance, weight=st.just(0.5), activities=body), max_size=3).map(tuple),
            )
        )

    return st.lists(st.recursive(st.one_of(single), several, max_leaves=4), max_size=4).map(tuple)


def stimulus(name):
    periods = st.integers(5, 50).map(lambda count: count * MS)
    return st.one_of(
        st.builds(Periodic, name=st.just(name), period=periods, jitter=st.none() | st.just(Boundaries(lower=0, upper=MS))),
        st.builds(
            RelativePeriodic,
            name=st.just(name),
            distance=periods.map(lambda minimum: Boundaries(lower=minimum, upper=2 * minimum)),
        ),
        st.builds(Synthetic, name=st.just(name), period=periods, times=st.sampled_from([(0,), (0, MS), (MS, MS, 60 * MS)])),
        st.builds(
            Burst,
            name=st.just(name),
            period=periods,
            length=st.integers(0, 4 * MS),
            distance=st.sampled_from([0, MS]),
            count=st.integers(1, 4),
        ),
        st.just(
            ArrivalCurve(
                name=name, points=(ArrivalCurvePoint(occurrences=2, lower=MS), ArrivalCurvePoint(occurrences=5, lower=9 * MS))
            )
        ),
        st.just(Single(name=name, time=MS)),
    )


@st.composite
def systems(draw):
    runnables: list[Runnable] = []
    for number in range(draw(st.integers(0, 4))):
        # Each calls only those before it.
        body = draw(activities([runnable.name for runnable in runnables], []))
        runnables.append(Runnable(name=f"R{number}", activities=body))
    names = [runnable.name for runnable in runnables]
    count = draw(st.integers(1, 4))
    # A process is activated from outside, or by those before it.
    triggered = [number > 0 and draw(st.booleans()) for number in range(count)]
    stimuli, processes = [], []
    for number in range(count):
        later = [f"S{other}" for other in range(number + 1, count) if triggered[other]]
        cls = draw(st.sampled_from([Task, Isr]))
        processes.append(cls(name=f"P{number}", stimuli=(f"S{number}",), activities=draw(activities(names, later))))
        inner = st.builds(InterProcess, name=st.just(f"S{number}"), counter=COUNTERS)
        stimuli.append(draw(inner if triggered[number] else stimulus(f"S{number}")))
    places = {process.name: draw(st.sampled_from(sorted(CORES))) for process in processes}
    tasks = [process for process in processes if isinstance(process, Task)]
    isrs = [process for process in processes if isinstance(process, Isr)]
    return of_parts(
        tasks,
        [TaskAllocation(task=task.name, scheduler=places[task.name], priority=number) for number, task in enumerate(tasks)],
        stimuli,
        cores=CORES,
        policy=Policy.FIXED_PRIORITY_PREEMPTIVE,
        hardware=HARDWARE,
        isrs=isrs,
        isr_allocations=[IsrAllocation(isr=isr.name, controller=f"interrupts of {places[isr.name]}") for isr in isrs],
        os_parts={
            "interrupt_controllers": [InterruptController(name=f"interrupts of {core}", cores=(core,)) for core in CORES]
        },
        runnables=runnables,
    )


@examples(10)
@given(systems())
def test_the_load_of_random_systems(system):
    model = build_model(system)
    assume(total(model))
    assert_same_load(model, analyze_system(system))


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
