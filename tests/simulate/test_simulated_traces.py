"""Traces of simulations obey the state charts of BTF 2.3.0, in whatever systems, and also if they show only a part of a run."""

from functools import partial

import pytest
from effort import every
from hand_made_systems import READ, SYSTEMS, Proc, access, system, ticks
from state_charts import StateCharts, check_trace
from support import ROOT, SHARED
from traces import said

from amalthea_uros.perf.activities import Call, Demand, Execute
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.software import Label, Runnable
from amalthea_uros.services.simulate import simulate
from amalthea_uros.services.subject import open_system
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.trace.readers import open_trace
from amalthea_uros.trace.sinks import EventRecorder, open_sink
from amalthea_uros.trace.table import Entity, EntityKind, EventKind
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration

DURATION = 600 * US
#: Begins and ends amid jobs and critical sections.
WINDOWS = [(0, DURATION), *((start * US, 400 * US) for start in every(3, (27, 33, 48, 61, 102, 203, 1)))]


def play(system, duration=DURATION, traced=None, sinks=()):
    recorder = EventRecorder()
    simulation = simulate_system(
        system, Options(duration=Duration(duration), traced=tuple(map(Duration, traced or (0, duration)))), [recorder, *sinks]
    )
    return simulation, [recorder.table]


def problems(tables):
    charts = StateCharts()
    for table in tables:
        charts.check(table)
    return [finding.message for finding in charts.findings]


def constructs():
    return sorted((SHARED / "vectors" / "constructs").glob("*.amxmi"))


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("window", WINDOWS, ids=lambda window: f"from {window[0] // US} us")
def test_hand_made_systems(name, window):
    simulation, tables = play(SYSTEMS[name], traced=window)
    assert [finding.message for finding in simulation.findings] == []
    assert sum(map(len, tables)) > 30
    assert problems(tables) == []


@pytest.mark.parametrize("name", SYSTEMS)
def test_files_say_what_was_simulated(name, tmp_path):
    paths = [tmp_path / f"run{suffix}" for suffix in (".btf", ".csv")]
    _, tables = play(SYSTEMS[name], sinks=[partial(open_sink, path) for path in paths])
    assert [check_trace(path) for path in paths] == [(), ()]
    written = said(tables)
    assert said(open_trace(paths[1])) == written
    # BTF does not know chains.
    assert said(open_trace(paths[0])) == [row for row in written if row[1] != EventKind.CHAIN_STEP]


@pytest.mark.parametrize("part", range(6))
def test_models_with_every_construct(part):
    for path in every(20, constructs()[part::6]):
        built = open_system([path]).system
        for window in ((0, 2500 * US), (777 * US, 1500 * US)):
            _, tables = play(built, 2500 * US, window)
            assert (path.name, window, problems(tables)) == (path.name, window, [])


@pytest.mark.parametrize("path", sorted((ROOT / "samples").glob("*.yaml")), ids=lambda path: path.name)
def test_samples(path):
    _, tables = play(open_system([path]).system, 100 * MS)
    assert problems(tables) == []


def of(tables, kind, *columns):
    """Some columns of the events of a kind."""
    rows = [row for table in tables for row in zip(*(c.tolist() for c in table.to_dict().values()), strict=True)]
    names = list(tables[0].to_dict())
    return [tuple(row[names.index(column)] for column in columns) for row in rows if row[1] == kind]


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("a lock without ceiling", "WAIT RELEASE OVERFULL FULL WAITING"),
        ("a spinlock", "POLL PARK POLL_PARKING RUN LOCK UNLOCK"),
        ("a lock for which processes poll", "POLL PARK RELEASE_PARKING OVERFULL"),
        ("a semaphore for two", "USED LOCK_USED UNLOCK_FULL FREE"),
        ("readers and writers", "LOCK UNLOCK_FULL OVERFULL USED"),
        ("a wait for an event", "WAIT RELEASE SET_EVENT CLEAR_EVENT WAIT_EVENT"),
        ("a poll for an event that is parked", "POLL PARK POLL_PARKING"),
        ("interrupts in nested runnables", "PREEMPT RESUME RUNNABLE_SUSPEND RUNNABLE_RESUME"),
        ("lost and waiting activations", "ACTIVATION_LOST"),
        ("triggers to another core", "CHAIN_STEP READ WRITE TRIGGER"),
    ],
)
def test_the_systems_show_what_they_are_for(name, kinds):
    _, tables = play(SYSTEMS[name])
    assert {EventKind[kind] for kind in kinds.split()} <= {kind for table in tables for kind in table.kind.tolist()}


def test_a_task_migrates():
    _, tables = play(SYSTEMS["tasks that migrate"])
    cores = {}
    for core, task in of(tables, EventKind.START, "source", "target") + of(tables, EventKind.RESUME, "source", "target"):
        cores.setdefault(task, set()).add(core)
    assert max(map(len, cores.values())) == 2


def test_decisions_of_a_scheduler_are_its_events():
    _, tables = play(SYSTEMS["scheduling that costs time"], duration=30 * US)
    # Each activation costs a decision of 1 us, both at time 0 together 2 us.
    scheduler, entities = tables[0].entities.index(Entity(EntityKind.SCHEDULER, "s0")), tables[0].entities
    decisions = of(tables, EventKind.SCHEDULE, "time", "source", "target")
    assert decisions == [(time * US, scheduler, scheduler) for time in (1, 4, 14, 24)]
    assert {entities[target].name for (target,) in of(tables, EventKind.START, "target")} == {"high", "low"}


def test_many_events_while_a_job_executes():
    often = Proc("often", (ticks(1),), 1, priority=1, task={"activation_limit": 2})
    # More events than are kept at a time, while one job executes.
    _, tables = play(system(Proc("long", (ticks(60_000),), 100_000, priority=2), often), 100_000 * US)
    assert len(of(tables, EventKind.TRIGGER, "time")) == 100_001
    assert len(of(tables, EventKind.ACTIVATION_LOST, "time")) >= 59_998
    assert problems(tables) == []


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_part_of_a_run_has_the_same_events_as_the_whole(name):
    start, end = 61 * US, 200 * US
    whole = [row for row in said(play(SYSTEMS[name])[1]) if start <= row[0] < end]
    part = said(play(SYSTEMS[name], traced=(start, end))[1])
    unseen = (EventKind.RUNNABLE_SUSPEND, EventKind.RUNNABLE_RESUME)  # of runnables that began before
    begun = {row[2:6] for row in part if row[1] == EventKind.RUNNABLE_START}
    assert part == [row for row in whole if row[1] not in unseen or row[2:6] in begun]


def test_the_library_gives_the_events():
    simulation = simulate(SYSTEMS["a spinlock"], "600 us", trace=True)
    assert said(simulation.trace) == said(play(SYSTEMS["a spinlock"])[1])
    assert simulate(SYSTEMS["a spinlock"], "600 us").trace is None


def test_a_trace_changes_nothing():
    varying = Execute(demand=Demand(Uniform(lower=1, upper=9)))
    runnables = (Runnable(name="inner", activities=(access("data", READ), varying, varying)),)
    calls = (Call(runnable="inner"), Call(runnable="inner"), varying)
    built = system(Proc("task", calls, 60, priority=1), runnables=runnables, labels=(Label(name="data"),))
    untraced, traced = (simulate(built, "60 ms", trace=trace)["task"].metrics for trace in (False, True))
    assert untraced == traced
    assert untraced[JobMetric.RESPONSE_TIME].min < untraced[JobMetric.RESPONSE_TIME].max
