"""What a response time consists of: execution times by runnable, and the loads of what is served first."""

from fractions import Fraction

import pytest
from hand_made_systems import Proc, changed, reallocated, system, ticks
from support import ROOT, analysis_of

from amalthea_uros import describe
from amalthea_uros.analyze.explanations.processes import ACCESSES, OTHER, OVERHEADS, OWN, explain_callback, explain_process
from amalthea_uros.analyze.results.explanations import OriginKind
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, Case, Group, Loop, Switch, WaitEvent
from amalthea_uros.perf.os import Duration, Parameter, Parent, Policy, Scheduler
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US


def tasks_on_a_core(*rows, **parts):
    """Tasks of (name, period, activities, priority, deadline) at 1 MHz."""
    tasks = [
        Proc(name, tuple(body), period, priority=priority, deadline=deadline) for name, period, body, priority, deadline in rows
    ]
    return system(*tasks, **parts)


def execution(explanation):
    return [(share.name, share.time and share.time // US, share.calls) for share in explanation.execution]


class TestExecution:
    def test_the_executor_of_the_thesis(self):
        analysis = analysis_of(ROOT / "samples" / "bodas-test-advanced.yaml")
        spin, take = explain_process(analysis, "Executor_Task").execution
        # 12 us in each job, 13 us more in every 20th.
        assert (spin.name, spin.time, spin.counter, spin.is_runnable) == ("Executor_Task_Spin", 12 * US, None, True)
        assert (take.name, take.time, take.counter.prescaler) == ("Take_Message_Factor", 13 * US, 20)

    def test_calls_groups_and_branches(self):
        runnables = (Runnable(name="step", activities=(ticks(3),)), Runnable(name="rare", activities=(ticks(10),)))
        every_fourth = Counter(prescaler=4, offset=2)
        body = [
            Call(runnable="step"),
            ticks(5),
            Group(activities=(Call(runnable="step"), Call(runnable="rare", counter=every_fourth))),
            Switch(cases=(Case(activities=(ticks(7),)), Case(activities=(ticks(2),)))),
            Call(runnable="rare"),
            ticks(1),
        ]
        analysis = analyze_system(tasks_on_a_core(("T", 100, body, 1, 100), runnables=runnables))
        found = explain_process(analysis, "T")
        assert execution(found) == [("step", 6, 2), (OWN, 6, 2), ("rare", 10, 1), (OTHER, 7, 1), ("rare", 10, 1)]
        assert [share.counter for share in found.execution] == [None, None, every_fourth, None, None]
        assert sum(share.time for share in found.execution) == found.process.wcet == 39 * US

    def test_an_unknown_execution_time_is_where_the_loop_is(self):
        runnables = (Runnable(name="step", activities=(ticks(3),)), Runnable(name="poll", activities=(Loop(activities=()),)))
        body = [Call(runnable="step"), Call(runnable="poll")]
        found = explain_process(analyze_system(tasks_on_a_core(("T", 100, body, 1, 100), runnables=runnables)), "T")
        assert execution(found) == [("step", 3, 1), ("poll", None, 1)]
        assert "loop" in found.execution[1].reason

    @pytest.mark.parametrize("scale", [Fraction(1), Fraction(1, 3), Fraction(997, 1000)])
    def test_shares_of_picoseconds_add_up(self, scale):
        system = describe(ROOT / "samples" / "drive-and-lift.yaml").system
        analysis = analyze_system(system, Settings(scale=scale))
        for process in analysis.processes:
            shares = explain_process(analysis, process.name).execution
            assert sum(share.time for share in shares) == process.wcet
            assert {share.name for share in shares if not share.is_runnable} <= {OWN, ACCESSES, OTHER, OVERHEADS}


class TestLoads:
    def test_an_overload_is_the_sum_of_the_loads(self):
        rows = [("high", 10, [ticks(6)], 3, 10), ("middle", 20, [ticks(10)], 2, 20), ("low", 40, [ticks(2)], 1, 40)]
        found = explain_process(analyze_system(tasks_on_a_core(*rows)), "middle")
        assert [(load.name, load.priority, load.utilisation) for load in found.loads] == [
            ("high", 3, Fraction(6, 10)),
            ("middle", 2, Fraction(10, 20)),
        ]
        assert (found.load, found.supply) == (Fraction(11, 10), 1)
        assert found.process.response.worst is None

    def test_one_that_meets_its_deadline_has_none(self):
        rows = [("high", 10, [ticks(6)], 3, 10), ("middle", 20, [ticks(10)], 2, 20)]
        assert explain_process(analyze_system(tasks_on_a_core(*rows)), "high").loads == ()

    def test_one_that_misses_its_deadline_has_both_interference_and_loads(self):
        rows = [("high", 10, [ticks(6)], 3, 10), ("low", 20, [ticks(4)], 2, 9)]
        found = explain_process(analyze_system(tasks_on_a_core(*rows)), "low")
        assert [(share.name, share.jobs, share.time) for share in found.shares] == [("high", 1, 6 * US)]
        assert found.load == Fraction(6, 10) + Fraction(4, 20)

    def test_the_supply_of_a_server(self):
        parameters = tuple(
            Parameter(name=name, values=(Duration(time=us * US),)) for name, us in (("capacity", 3), ("period", 10))
        )
        parent = Parent(scheduler="s0", priority=2)
        schedulers = [
            Scheduler(name="s0", policy=Policy.OSEK, cores=("c0",)),
            Scheduler(name="server", policy=Policy.DEFERRABLE_SERVER, parent=parent, parameters=parameters),
        ]
        rows = ("T", 10, [ticks(4)], 1, 10), ("beside", 10, [ticks(1)], 1, 10)
        built = reallocated(tasks_on_a_core(*rows, schedulers=schedulers), "T", scheduler="server")
        found = explain_process(analyze_system(built), "T")
        # 4 of 10 in a budget of 3 of 10; what runs outside does not count.
        assert [(load.name, load.utilisation) for load in found.loads] == [("T", Fraction(4, 10))]
        assert found.supply == Fraction(3, 10)


class TestOrigins:
    def test_an_overload(self):
        rows = [("high", 10, [ticks(6)], 3, 10), ("low", 20, [ticks(10)], 2, 20)]
        (origin,) = explain_process(analyze_system(tasks_on_a_core(*rows)), "low").origins
        assert (origin.process, origin.kind) == ("low", OriginKind.OVERLOAD)

    def test_an_unknown_demand_of_a_process_that_precedes_it(self):
        runnables = (Runnable(name="poll", activities=(Loop(activities=()),)),)
        rows = [("high", 10, [Call(runnable="poll")], 3, 10), ("low", 20, [ticks(10)], 2, 20)]
        analysis = analyze_system(tasks_on_a_core(*rows, runnables=runnables))
        (origin,) = explain_process(analysis, "low").origins
        assert (origin.process, origin.kind) == ("high", OriginKind.DEMAND)
        assert origin.remedy == "State the execution time of 'poll'."
        # Its own load is known, that of the other is not.
        assert [(load.name, load.utilisation) for load in explain_process(analysis, "low").loads] == [
            ("low", Fraction(1, 2)),
            ("high", None),
        ]

    def test_waiting_without_a_timeout(self):
        rows = [("waits", 10, [ticks(1), WaitEvent(events=("go",))], 3, 10)]
        (origin,) = explain_process(analyze_system(tasks_on_a_core(*rows)), "waits").origins
        assert origin.remedy == "Trigger a separate task instead of waiting for the event."

    def test_an_unknown_activation(self):
        built = changed(tasks_on_a_core(("T", 10, [ticks(4)], 1, 10)), stimuli=())
        (origin,) = explain_process(analyze_system(built), "T").origins
        assert (origin.kind, origin.reason) == (
            OriginKind.ACTIVATION,
            "it has no stimulus, and the stimulus 'T_tick' activates no process",
        )

    def test_none_if_there_is_a_bound(self):
        assert explain_process(analyze_system(tasks_on_a_core(("T", 10, [ticks(4)], 1, 10))), "T").origins == ()


class TestCallbacks:
    def test_a_job_need_not_execute_everything(self):
        """3 and 5 in even jobs, 3 and 4 in odd ones."""
        runnables = tuple(Runnable(name=name, activities=(ticks(time),)) for name, time in (("a", 3), ("b", 5), ("c", 4)))
        even, odd = Counter(prescaler=2, offset=2), Counter(prescaler=2, offset=1)
        body = [Call(runnable="a"), Call(runnable="b", counter=even), Call(runnable="c", counter=odd)]
        found = explain_process(analyze_system(tasks_on_a_core(("T", 20, body, 1, 20), runnables=runnables)), "T")
        assert found.process.response.worst == 8 * US
        assert (found.worst_job, found.in_worst_job) == (2, (True, True, False))

    def test_what_executes_before_a_callback(self):
        """20 us for the executor, notices, the messages with 15 us and 100 ns for each byte, then the callbacks in order."""
        analysis = analysis_of(ROOT / "samples" / "rclc-in-executor.yaml")
        (found,) = explain_callback(analysis, "On_Command_Callback")
        assert (found.process.name, found.execution[-1].name) == ("rclc_executor", "On_Command_Callback")
        # All of it in one job: 20 + 4 + 51 + 23.8 + 4 + 90 + 40.
        assert found.callback.response.worst == sum(share.time for share in found.execution) == 232_800_000
        assert [each.name for each in explain_process(analysis, "rclc_executor").callbacks] == [
            "On_Imu_Callback",
            "On_Command_Callback",
            "Control_Callback",
        ]
