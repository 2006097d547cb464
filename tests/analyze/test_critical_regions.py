"""What keeps others off inside a job: locks, non-interruptible groups and cooperative code, at any depth.

All times in microseconds on a core of 1 MHz; a greater number is a higher priority. Systems are in the plain form of `opponent`; what
occurs was found by hand and is drawn beside each system.
"""

import pytest
from opponent.to_perf import to_perf

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.timing.blocking.regions import AFTER_CALL, NOTHING, POINT, NonPreemptiveRegions
from amalthea_uros.units import MICROSECOND as US


def execute(best, worst=None):
    return {"execute": [best, best if worst is None else worst]}


def locked(semaphore, *items):
    return [{"request": semaphore}, *items, {"release": semaphore}]


def group(*items, **how):
    return {"group": list(items), **how}


def process(name, priority, period, *body, offset=0, preemption="preemptive", jitter=None, latest=None, **more):
    """A task; it is sporadic if it has a latest next arrival."""
    if latest is None:
        arrival = {"periodic": {"period": period, "offset": offset} | ({"jitter": jitter} if jitter else {})}
    else:
        arrival = {"sporadic": {"least": period, "most": latest, "offset": offset}}
    return {
        "name": name,
        "kind": "task",
        "core": "core",
        "priority": priority,
        "preemption": preemption,
        "arrival": arrival,
        "body": list(body),
        **more,
    }


def analysis(*processes, policy="FPP", ceilings=None, runnables=None):
    plain = {
        "cores": {"core": policy},
        "semaphores": {name: {"ceiling": ceiling} for name, ceiling in (ceilings or {}).items()},
        "runnables": runnables or {},
        "processes": list(processes),
    }
    return analyze_system(to_perf(plain))


def analyse(*processes, **parts):
    """The response times of processes: (best, worst, claim), or why they are unknown."""
    found = {}
    for result in analysis(*processes, **parts).processes:
        response = result.response
        if response is None or response.worst is None:
            found[result.name] = result.reason
        else:
            found[result.name] = (response.best // US, response.worst // US, str(response.claim))
    return found


def wraps():
    """A critical section of 5 in everything that can contain it, with the runnables that this needs."""
    section = locked("M", execute(5))
    return [
        pytest.param(section, {}, id="at top level"),
        pytest.param([group(*section)], {}, id="in a group"),
        pytest.param([group(group(*section))], {}, id="in a group in a group"),
        pytest.param([{"call": "r"}], {"r": section}, id="in a runnable"),
        pytest.param([{"call": "r"}], {"r": [{"call": "s"}], "s": section}, id="in a runnable called by a runnable"),
        pytest.param([{"switch": [[1, section], [1, [execute(1)]]]}], {}, id="in a branch"),
        pytest.param(
            [{"call": "lock"}, execute(5), {"call": "unlock"}], {"lock": section[:1], "unlock": section[2:]}, id="by calls"
        ),
        pytest.param([{"call": "r", "prescaler": 3, "offset": 0}], {"r": section}, id="in a counted call"),
        pytest.param([group(group(*section), execute(1), ordered=False)], {}, id="in an unordered group"),
    ]


class TestCriticalSections:
    @pytest.mark.parametrize(("body", "runnables"), wraps())
    def test_count_wherever_they_are(self, body, runnables):
        # lo takes M at 0 and holds it until 5; hi comes at 1 with a ceiling that keeps it off: 5 - 1 + 1 = 5.
        found = analyse(
            process("hi", 2, 20, group(*locked("M", execute(1))), offset=1),
            process("lo", 1, 50, *body),
            ceilings={"M": True},
            runnables=runnables,
        )
        assert found["hi"][1:] in {(5, "bound"), (6, "bound")}

    def test_a_ceiling_keeps_off_processes_that_do_not_use_the_semaphore(self):
        # lo holds M, whose ceiling is that of hi, from 0 to 5; middle comes at 1: 5 - 1 + 2 = 6.
        found = analyse(
            process("hi", 3, 50, *locked("M", execute(1)), offset=40),
            process("middle", 2, 50, execute(2), offset=1),
            process("lo", 1, 50, *locked("M", execute(5))),
            ceilings={"M": True},
        )
        assert found["middle"][1] >= 6

    def test_are_told_in_the_same_order_in_each_run(self):
        names = [f"S{number}" for number in range(8)]
        sections = [item for name in names for item in locked(name, execute(1))]
        processes = process("hi", 2, 50, *sections), process("lo", 1, 100, *sections)
        found = analysis(*processes, ceilings=dict.fromkeys(names, False))
        told = [text.split("'")[1] for text in found.assumptions if "no priority ceiling" in text]
        assert told == names

    def test_nested_sections_are_one_stretch(self):
        # lo holds A and, within it, B: from 0 to 6 it keeps off hi, which uses only B: but only while it holds B, from 2 to 4.
        body = [{"request": "A"}, execute(2), *locked("B", execute(2)), execute(2), {"release": "A"}]
        found = analyse(
            process("hi", 2, 50, *locked("B", execute(1)), offset=3),
            process("lo", 1, 50, *body),
            ceilings={"A": True, "B": True},
        )
        assert 2 <= found["hi"][1] <= 3

    @pytest.mark.parametrize(
        ("body", "cause"),
        [
            ([{"request": "M"}, execute(1)], "does not release the semaphore 'M'"),
            ([execute(1), {"release": "M"}], "releases the semaphore 'M', which it does not hold"),
            (
                [{"request": "M"}, execute(1), {"request": "M"}, {"release": "M"}],
                "requests the semaphore 'M', which it holds already",
            ),
            ([{"switch": [[1, [{"request": "M"}]], [1, []]]}, execute(1)], "only some branches of a switch"),
            ([{"call": "lock", "prescaler": 2, "offset": 0}, execute(1)], "only some jobs call 'lock'"),
            ([group({"request": "M"}, execute(1), {"release": "M"}, ordered=False)], "a part of an unordered group"),
        ],
    )
    def test_that_are_unbalanced_make_who_uses_them_unknown(self, body, cause):
        found = analyse(
            process("other", 2, 20, execute(1)),
            process("odd", 1, 50, *body),
            ceilings={"M": True},
            runnables={"lock": [{"request": "M"}]},
        )
        assert cause in found["odd"]

    def test_of_unknown_length_make_those_unknown_that_they_can_delay(self):
        found = analyse(
            process("hi", 3, 50, execute(1)),
            process("user", 2, 50, *locked("M", execute(1))),
            process("odd", 1, 50, {"request": "M"}, execute(1)),
            ceilings={"M": True},
        )
        assert found["hi"] == (1, 1, "bound")
        assert "'odd', which could not be analysed, can block it" in found["user"]

    def test_without_a_ceiling_everything_above_the_holder_delays(self):
        # low takes A at 0, high waits for it at 2; middle comes at 3, runs until 21; low until 23; high until 26: 24.
        found = analyse(
            process("high", 3, 100, *locked("A", execute(3)), offset=2),
            process("middle", 2, 100, execute(18), offset=3),
            process("low", 1, 100, *locked("A", execute(5))),
            ceilings={"A": False},
        )
        assert found["high"][1] >= 24

    def test_without_a_ceiling_in_different_orders_can_wait_forever(self):
        def nested(first, then):
            return [{"request": first}, execute(1), *locked(then, execute(1)), {"release": first}]

        found = analyse(
            process("one", 2, 20, *nested("A", "B"), offset=1),
            process("two", 1, 20, *nested("B", "A")),
            ceilings={"A": False, "B": False},
        )
        assert all("requested in different orders" in found[name] for name in ("one", "two"))


class TestNonInterruptibleGroups:
    def test_block_everything_on_the_core(self):
        found = analyse(
            process("hi", 2, 20, execute(1), offset=1), process("lo", 1, 50, group(execute(5), interruptible=False))
        )
        # lo runs from 0 to 5; hi comes at 1: 5.
        assert found["hi"][1] >= 5
        assert found["hi"][2] == "bound"

    def test_two_in_a_row_can_be_separated(self):
        stretch = group(execute(5), interruptible=False)
        found = analyse(process("hi", 2, 50, execute(1)), process("lo", 1, 50, stretch, stretch, offset=3))
        assert found["hi"][1] <= 6


class TestCooperativeTasks:
    def test_yield_after_calls_inside_groups(self):
        # hi runs until 1, lo calls until 6 and 11, hi runs (came at 7) until 12, lo until 17.
        found = analyse(
            process("hi", 2, 7, execute(1), preemption="cooperative"),
            process("lo", 1, 100, group({"call": "r"}, {"call": "r"}, {"call": "r"}), preemption="cooperative"),
            runnables={"r": [execute(5)]},
        )
        assert found["lo"][1] == 17
        # At most one call of lo is ahead of it.
        assert found["hi"][1] == 6

    def test_do_not_yield_between_executions(self):
        # lo executes 3 + 4 before its schedule point; hi comes just after it has begun.
        found = analyse(
            process("hi", 2, 40, execute(1), offset=1, preemption="cooperative"),
            process("lo", 1, 40, execute(3), execute(4), {"point": True}, execute(1), preemption="cooperative"),
        )
        assert found["hi"][1] >= 7

    def test_a_schedule_point_in_a_non_interruptible_group_has_no_effect(self):
        stretch = group(execute(3), {"point": True}, execute(4), interruptible=False)
        found = analyse(
            process("hi", 2, 40, execute(1), offset=1, preemption="cooperative"),
            process("lo", 1, 40, stretch, preemption="cooperative"),
        )
        assert found["hi"][1] >= 7

    def test_below_a_preemptive_task_below_a_cooperative_one(self):
        # Clo calls from 0; P preempts it from 1 to 4; Chi comes at 2 and waits for the rest of the call, until 8: 9 - 2 = 7.
        found = analyse(
            process("Chi", 3, 20, execute(1), offset=2, preemption="cooperative"),
            process("P", 2, 20, execute(3), offset=1),
            process("Clo", 1, 40, {"call": "r"}, preemption="cooperative"),
            runnables={"r": [execute(5)]},
        )
        assert found["Chi"][1] >= 7


def test_ceilings_under_deadlines_hold_for_all_processes_of_the_busy_window():
    # At 22 T4 is in B; T3 (released at 16) waits for it, and T2 (released at 24, deadline 29) for T3 (deadline 28): 5.
    found = analyse(
        process("T2", 0, 8, execute(1), deadline=5),
        process("T3", 0, 16, execute(1), *locked("B", execute(4)), execute(5), deadline=12),
        process("T1", 0, 48, execute(3), deadline=40),
        process("T4", 0, 48, *locked("B", execute(2)), deadline=72),
        policy="EDF",
        ceilings={"B": True},
    )
    assert found["T2"][1] >= 5


def test_a_process_that_keeps_others_off_can_end_before_they_delay_it():
    # T2 ends at 6 after a release at 0: its section is entered at 3, and T1 (released at 5) waits; it executes 5 in all.
    found = analyse(
        process("T1", 2, 10, execute(3), *locked("A", execute(1)), execute(2), offset=5),
        process("T2", 1, 40, execute(3), *locked("A", execute(2))),
        ceilings={"A": True},
    )
    assert found["T2"][0] <= 6


class TestOffsets:
    def test_count_among_non_preemptive_tasks(self):
        # The released jobs never meet: 0..3 and 5..8 in each period of 10.
        found = analyse(
            process("A", 2, 10, execute(3), preemption="non-preemptive"),
            process("B", 1, 10, execute(3), offset=5, preemption="non-preemptive"),
        )
        assert found == {"A": (3, 3, "exact"), "B": (3, 3, "exact")}

    def test_count_beside_a_sporadic_process(self):
        sporadic = process("S", 3, 10, execute(1), latest=20)
        found = analyse(sporadic, process("A", 2, 10, execute(3)), process("B", 1, 10, execute(3), offset=5))
        # S delays each of them once; they never meet.
        assert found["A"][1] == found["B"][1] == 4


class TestStretches:
    """The longest demand between points: computed on lists of demands with points by the definition."""

    @staticmethod
    def of(parts):
        found = NOTHING
        for part in parts:
            found = found.then(POINT if part is None else NonPreemptiveRegions(through=part, uncounted=part, total=part))
        return found

    @pytest.mark.parametrize(
        "parts", [[3], [None], [3, None], [None, 4], [1, 2, None, 4, 1, None, 2], [None, None], [5, None, 1, None, None, 7, 7]]
    )
    def test_a_sequence(self, parts):
        runs, run = [], 0
        for part in [*parts, None]:
            if part is None:
                runs.append(run)
                run = 0
            else:
                run += part
        found = self.of(parts)
        assert found.longest == max(runs)
        assert (found.last if None in parts else found.through) == runs[-1]
        if None in parts:
            assert found.before_last == sum(runs) - runs[-1]

    def test_a_point_after_a_call_counts_only_if_something_follows(self):
        call = self.of([5]).then(AFTER_CALL)
        assert (call.before_last, call.then(call).before_last, call.then(call).longest) == (None, 5, 5)
        assert call.then(self.of([2])).before_last == 5
        assert call.then(POINT).before_last == 5
        assert call.then(NOTHING.either(call)).before_last == 5

    def test_alternatives(self):
        # 2 | 5 .  followed by 1: 2 + 1 without a point, or 5 before it and 1 after it.
        found = self.of([2]).either(self.of([5, None])).then(self.of([1]))
        assert (found.through, found.first, found.last, found.longest) == (3, 5, 1, 5)


def test_others_of_the_same_priority_can_be_avoided_in_the_best_case():
    # T1 needs 7, and T0 can take a turn of 3 in between: released just after the group of T0, it ends before the second one.
    found = analyse(
        process("T0", 1, 10, group(execute(3), interruptible=False), execute(1), slice=3),
        process("T1", 1, 20, execute(4), execute(3), slice=1, latest=31),
        policy="RR",
    )
    assert found["T1"][0] <= 10


def test_an_earlier_job_can_be_the_longer_one_of_a_non_preemptive_task():
    # T1 takes 10 and then 3: what comes during the 10 goes first. Three jobs of T0 before the second job end, with the jitter: 17.
    call = {"call": "r", "prescaler": 3, "offset": 0}
    found = analyse(
        process("T0", 8, 11, execute(4)),
        process("T1", 3, 11, call, execute(3), preemption="non-preemptive", jitter=8),
        runnables={"r": [execute(7)]},
    )
    assert found["T1"][1] >= 17


def test_a_sporadic_process_can_pile_up_behind_a_blocking_one_before_a_known_release():
    # low runs from 0 to 10 without interruption; S comes at 1, 3, 5, ...: at 11, when middle comes, five jobs of S are pending, and
    # others come until 21. middle cannot run before 20.
    found = analyse(
        process("S", 3, 2, execute(1), offset=1, latest=4),
        process("middle", 2, 100, execute(1), offset=11),
        process("low", 1, 100, execute(10), preemption="non-preemptive"),
    )
    assert found["middle"][1] >= 10


def test_the_load_of_what_is_below_proves_no_overload():
    # high has a tenth of the core and waits for low, which gets too little of it: nobody knows for how long, but high is no overload.
    whole = analysis(
        process("high", 3, 10, *locked("A", execute(1))),
        process("middle", 2, 10, execute(6)),
        process("low", 1, 10, *locked("A", execute(6))),
        ceilings={"A": False},
    )
    found = {each.name: (str(each.verdict), each.response.worst) for each in whole.processes}
    assert found["high"] == ("unknown", None)
    assert found["low"] == ("unbounded", None)
