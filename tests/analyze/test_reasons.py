"""Why something is unknown: each reason names its cause, and what is known nevertheless is shown."""

import pytest
from hand_made_systems import Proc, locked, ticks
from hand_made_systems import system as two_cores
from test_policies import root, system

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.os import Parent, Policy, Scheduler, Semaphore, SemaphoreKind
from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.units import MICROSECOND as US

PARTITION = Scheduler(name="partition", policy=Policy.OSEK, parent=Parent(scheduler="root"))
OTHER = Scheduler(name="other", policy=Policy.OSEK, parent=Parent(scheduler="root", priority=1))


def analysed(schedulers, **allocation):
    tasks = [("T", 100, [ticks(10)], {"scheduler": "root", "priority": 248} | allocation)]
    return analyze_system(system(schedulers, tasks))["T"]


@pytest.mark.parametrize(
    ("schedulers", "allocation", "reason"),
    [
        ([root(), PARTITION, OTHER], {"scheduler": "partition"}, "its scheduler 'partition', below 'root', has no priority"),
        ([root("PfairPD2")], {}, "there is no analysis for the policy PfairPD2 of its scheduler 'root'"),
        ([root()], {"cores": ("elsewhere",)}, "its affinity is to elsewhere, but its scheduler 'root' is responsible for core"),
        ([Scheduler(name="root", policy=Policy.OSEK)], {}, "its scheduler 'root' is not responsible for a core"),
        ([root()], {"scheduler": "none"}, "the scheduler 'none' is not defined, or was left out when reading"),
    ],
)
def test_a_cause(schedulers, allocation, reason):
    found = analysed(schedulers, **allocation)
    assert (found.reason, found.verdict) == (reason, "unknown")


def test_what_is_known_of_a_task_that_cannot_be_scheduled():
    found = analysed([root("PfairPD2")])
    assert (found.processor, found.priority, found.bcet, found.wcet) == ("core", 248, 10 * US, 10 * US)
    assert (found.deadline, found.min_interarrival) == (100 * US, 100 * US)


def test_activations_that_depend_on_an_unknown_task_are_not_shown():
    triggers = [("source", 100, [ticks(1), Trigger(stimulus="every T")], {"scheduler": "root"})]
    tasks = [*triggers, ("T", None, [ticks(10)], {"scheduler": "root"})]
    built = system([root("PfairPD2")], tasks, stimuli=[InterProcess(name="every T")])
    found = analyze_system(built)["T"]
    assert (found.wcet, found.deadline, found.min_interarrival) == (10 * US, None, None)


class TestAlone:
    def test_a_task_alone_on_its_core_needs_no_priority(self):
        assert analysed([root()], priority=None).response.worst == 10 * US

    def test_nor_does_one_alone_in_a_group(self):
        group = Scheduler(name="group", policy=Policy.GROUPING, parent=Parent(scheduler="root"))
        assert analysed([root(), group], scheduler="group", priority=None).response.worst == 10 * US

    def test_nor_does_a_partition_alone_on_its_core(self):
        assert analysed([root(), PARTITION], scheduler="partition").response.worst == 10 * US

    def test_one_of_two_tasks_needs_it(self):
        # Either may be the lower one, which ends within 10 us + 10 us; that one of 60 us + 60 us may be late.
        tasks = [(name, 100, [ticks(10)], {"scheduler": "root"}) for name in ("T", "U")]
        assert {process.response.worst for process in analyze_system(system([root()], tasks)).processes} == {20 * US}
        tasks = [(name, 110, [ticks(60)], {"scheduler": "root"}) for name in ("T", "U")]
        reasons = {process.reason for process in analyze_system(system([root()], tasks)).processes}
        assert all(reason.startswith("it has no priority; as the lowest") for reason in reasons)


def test_who_waits_for_a_spinlock_of_another_core_is_not_kept_waiting_by_priorities():
    users = [Proc(name, locked("lock", 5), 100, priority=1, scheduler=core) for name, core in (("T", "s0"), ("U", "s1"))]
    lock = Semaphore(name="lock", kind=SemaphoreKind.SPINLOCK)
    found = analyze_system(two_cores(*users, semaphores=(lock,)))
    assert {each.reason for each in found.processes} == {"it shares the spinlock 'lock' with other cores or servers"}
    assert not any("never runs" in finding.message for finding in found.findings)


def test_a_stimulus_without_a_process_is_named_where_a_process_has_none():
    reason = "it has no stimulus, and the stimulus {}"
    for fired, ending in (
        ((), "'other' activates no process"),
        (("second",), "'second', which is triggered, activates no process"),
    ):
        body = (ticks(1), *(Trigger(stimulus=name) for name in fired))
        built = two_cores(Proc("T", body, 100, priority=1), Proc("Idle", (ticks(2),), priority=2), triggers=("other", "second"))
        assert analyze_system(built).processes["Idle"].reason == reason.format(ending)


def test_an_overload_is_the_cause_where_response_times_and_activations_depend_on_each_other():
    # T triggers H, which is above it: 10 + 30 + 80 of 100 us. H itself is never late: T does not go on before H ends.
    processes = (
        Proc("Above", (ticks(10),), 100, priority=3),
        Proc("H", (ticks(80),), stimuli=("go",), priority=2),
        Proc("T", (Trigger(stimulus="go"), ticks(30)), 100, priority=1),
        Proc("Below", (ticks(1),), 100, priority=0),
    )
    found = analyze_system(two_cores(*processes, triggers=("go",)))
    assert {each.name: (str(each.verdict), each.reason) for each in found.processes} == {
        "Above": ("met", ""),
        "H": ("unknown", "it is triggered by 'T', which has no bounded response time"),
        "T": ("unbounded", "overload: tasks at this priority or higher need at least 120.0 % of the core"),
        "Below": ("unbounded", "overload: tasks at this priority or higher need at least 121.0 % of the core"),
    }
