"""An analysis takes work in proportion to the system: twice the system, about twice the steps.

The steps are counted as lines that are executed, so that nothing depends on the machine.
"""

import pytest
from growth import steps
from hand_made_systems import READ, US, WRITE, access, chain, of_parts, ticks

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.constraints.requirements import evaluate_requirements
from amalthea_uros.analyze.response_times import core_schedule, propagation, schedule
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Call, Demand, Execute, RaiseEvent, Trigger
from amalthea_uros.perf.constraints import Constraints, DataAgeConstraint, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import CustomEvent, Events, LabelChange, LabelEvent
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import Label, Runnable, Software, Task
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess, Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow import events as dataflow_events
from amalthea_uros.timing.dataflow.events import EventLocator

#: Tasks on a core.
HERE = 4


def system(bodies, period=1000, stimuli=None, **parts):
    """A task for each body, a runnable with the same name; each core has some of them."""
    tasks = [f"t{number}" for number in range(len(bodies))]
    cores = [f"c{number}" for number in range(-(-len(bodies) // HERE))]
    stimuli = stimuli or [Periodic(name=name, period=period * US) for name in tasks]
    runnables = [Runnable(name=name, activities=tuple(body)) for name, body in zip(tasks, bodies, strict=True)]
    return of_parts(
        [Task(name=name, stimuli=(name,), activities=(Call(runnable=name),)) for name in tasks],
        [
            TaskAllocation(task=name, scheduler=cores[number // HERE], priority=1 + number % HERE)
            for number, name in enumerate(tasks)
        ],
        stimuli,
        cores=cores,
        runnables=runnables,
        labels=[Label(name=name) for name in tasks],
        **parts,
    )


def data_ages(number):
    """Each task reads what the one before has written, not later than in time."""
    bodies = [[access(f"t{max(0, n - 1)}", READ), ticks(9), access(f"t{n}", WRITE)] for n in range(number)]
    ages = [DataAgeConstraint(name=f"t{n}", runnable=f"t{n}", label=f"t{n}", latest=9000 * US) for n in range(number)]
    return system(bodies, constraints=Constraints(data_ages=tuple(ages)))


def event_stimuli(number):
    """Every second task is activated by an event of the one before."""
    bodies = [[ticks(9), RaiseEvent(event=f"e{n}")] if n % 2 == 0 else [ticks(9)] for n in range(number)]
    stimuli = [
        EventTriggered(name=f"t{n}", events=(f"e{n - 1}",)) if n % 2 else Periodic(name=f"t{n}", period=1000 * US)
        for n in range(number)
    ]
    return system(bodies, stimuli=stimuli, events=Events(events=tuple(CustomEvent(name=f"e{n}") for n in range(0, number, 2))))


def losses(number):
    """The lower tasks of all cores lose activations."""
    return system([[ticks(45)] for _ in range(number)], period=100)


def guesses(number):
    """Chains whose events no activity raises."""
    events = [LabelEvent(name=f"e{n}", label="x", runnable=f"t{n}", change=LabelChange.WRITE) for n in range(number)]
    chains = [chain(f"e{n}", f"e{n - 1}", f"e{n}") for n in range(1, number)]
    return system([[ticks(9)] for _ in range(number)], events=Events(events=tuple(events), chains=tuple(chains)))


def limits(number):
    """Each runnable has a limit."""
    limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=500 * US)
    requirements = tuple(Requirement(name=f"t{n}", runnable=f"t{n}", limit=limit) for n in range(number))
    return system([[ticks(9)] for _ in range(number)], constraints=Constraints(requirements=requirements))


@pytest.mark.parametrize("build", [data_ages, event_stimuli, guesses])
def test_twice_the_system_takes_twice_the_steps(build):
    small, large = build(12), build(24)
    analyze_system(build(8))  # what is imported or compiled once does not count
    assert steps(lambda: analyze_system(large)) <= 2.2 * steps(lambda: analyze_system(small))


def test_losses_of_other_tasks_are_found_by_core():
    def take(number):
        solution = solve(TimingContext.of(losses(number)))
        assert len(solution.losing) >= number // 2
        return steps(lambda: [solution.follows_losses(name) for name in solution.context.scheduled])

    assert take(80) <= 2.2 * take(40)


def test_the_callbacks_of_a_requirement_are_found_by_name():
    def take(number):
        limited, notes = limits(number), AnalysisNotes()
        callbacks = list(analyze_system(limited).callbacks)
        assert len(callbacks) == number
        return steps(lambda: list(evaluate_requirements(limited, Results(), callbacks, notes)))

    assert take(80) <= 2.2 * take(40)


def test_the_certainty_of_a_schedule_is_found_in_one_look():
    def tasks(number):
        return [
            schedule.PeriodicTask(
                name=str(n), period=1000, offset=0, demand=schedule.MultiframeDemand.constant(1), priority=number - n
            )
            for n in range(number)
        ]

    def take(number):
        of_schedule = steps(lambda: schedule.schedule(tasks(number), 2000, schedule.MultiframeDemand.worst_of))
        return steps(lambda: core_schedule.CoreSchedule.of(tasks(number), with_slices=False).response_times()) - of_schedule

    take(8)
    assert take(400) <= 2.2 * take(200)


def test_activities_that_are_too_many_are_walked_once(monkeypatch):
    walks = []

    positions = dataflow_events.positions
    monkeypatch.setattr(
        dataflow_events, "positions", lambda process, *context: walks.append(process.name) or positions(process, *context)
    )
    nested = tuple(Runnable(name=f"r{n}", activities=(Call(runnable=f"r{n + 1}"),)) for n in range(200))
    deep = Task(name="deep", activities=(Call(runnable="r0"),))
    locator = EventLocator(System(software=Software(tasks=(deep,), runnables=nested)))
    for _ in range(3):
        with pytest.raises(UnknownError, match="too deeply nested"):
            locator.positions("deep")
    assert walks == ["deep"]


def test_a_core_is_analysed_again_only_if_its_activations_have_changed(monkeypatch):
    # From the second round on the response times on the first core delay the activations on the next two.
    bodies = [[ticks(9), Trigger(stimulus=f"t{n + HERE}")] if n in (0, HERE) else [ticks(9)] for n in range(4 * HERE)]
    triggered = (HERE, 2 * HERE)
    stimuli = [
        InterProcess(name=f"t{n}") if n in triggered else Periodic(name=f"t{n}", period=1000 * US) for n in range(4 * HERE)
    ]
    cores = []

    responses_on = propagation.responses_on
    monkeypatch.setattr(propagation, "responses_on", lambda core, solution: cores.append(core) or responses_on(core, solution))
    solve(TimingContext.of(system(bodies, stimuli=stimuli)))
    assert cores.count("c0") == cores.count("c3") == 1
    assert cores.count("c1") == cores.count("c2") == 2


def test_each_schedule_is_built_once(monkeypatch):
    built = []
    build = schedule.schedule
    monkeypatch.setattr(schedule, "schedule", lambda *arguments: built.append(arguments[2].__name__) or build(*arguments))
    varying = Execute(demand=Demand(Boundaries(lower=7, upper=9)))
    limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=500 * US)
    stated = Constraints(requirements=(Requirement(name="R", runnable="t1", limit=limit),))
    whole = system([[varying] for _ in range(HERE)], constraints=stated)
    # For response times, metrics, and the callbacks, which need the execution slices.
    assert len(analyze_system(whole).callbacks) == 1
    assert built == ["worst_of", "best_of"]


def test_the_slices_of_a_long_schedule_are_built_only_if_they_are_needed(monkeypatch):
    monkeypatch.setattr(core_schedule, "RECORDED_JOBS", 3)
    solution = solve(TimingContext.of(system([[ticks(9)] for _ in range(HERE)])))
    without, with_slices = solution.schedule("c0"), solution.schedule("c0", with_slices=True)
    assert without is not None
    assert with_slices is not None
    assert not any(len(jobs.execution_slices) for jobs in without.worst.values())
    assert all(len(jobs.execution_slices) for jobs in with_slices.worst.values())
