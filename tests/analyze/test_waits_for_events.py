"""Waits for events: bounds computed by hand, waits that may never end, and random systems against a simulator of the tests."""

from random import Random

import pytest
from effort import examples
from fuzzing.contradictions import contradictions
from hand_made_systems import Proc, system, ticks
from hypothesis import given
from hypothesis import strategies as st
from opponent.simulation import record
from waiting_player import PlayedTask, Player

from amalthea_uros import analyze_system
from amalthea_uros.analyze.results.processes import Metric
from amalthea_uros.perf.activities import ClearEvent, SetEvent, Trigger, WaitEvent, Waiting
from amalthea_uros.perf.software import OsEvent
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration

PASSIVE, ACTIVE = Waiting.PASSIVE, Waiting.ACTIVE


def wait(event="e", waiting=PASSIVE):
    return WaitEvent(events=(event,), waiting=waiting)


def clear(event="e"):
    return ClearEvent(events=(event,))


def sets(process="P", event="e"):
    return SetEvent(events=(event,), process=process)


GO = Trigger(stimulus="go")
ROUND_TRIP = (ticks(2), GO, wait(), clear(), ticks(3))


def built(*processes):
    return system(*processes, triggers=("go",), os_events=(OsEvent(name="e"), OsEvent(name="f")))


def offload(body=ROUND_TRIP, *others, period=50, work=10, server=None, **setter):
    """`P` on c0 triggers `Q` on c1, which works for some time and sets the event; others beside them."""
    setting = (ticks(work), sets()) if server is None else server
    return built(
        Proc("P", body, period, priority=2),
        Proc("Q", setting, stimuli=("go",), **({"priority": 1, "scheduler": "s1"} | setter)),
        *others,
    )


def worst(found, name):
    response = found[name].response
    return found[name].reason if response is None or response.worst is None else response.worst // US


class TestByHand:
    @pytest.mark.parametrize("waiting", [PASSIVE, ACTIVE, None])
    def test_a_round_trip_takes_the_response_of_who_is_triggered(self, waiting):
        found = analyze_system(offload((ticks(2), GO, wait(waiting=waiting), clear(), ticks(3))))
        assert (worst(found, "Q"), worst(found, "P")) == (10, 2 + 10 + 3)

    def test_what_delays_who_is_triggered_makes_the_wait_longer(self):
        # Q: 10 + 2 * 4 in a window of 18, with releases at 0 and 12.
        found = analyze_system(offload(ROUND_TRIP, Proc("H", (ticks(4),), 12, priority=9, scheduler="s1")))
        assert (worst(found, "Q"), worst(found, "P")) == (18, 23)

    def test_a_job_below_is_delayed_by_the_wait_too(self):
        # If waiting were executing, P would need 15 in each 50, and L 15 + 7.
        found = analyze_system(offload(ROUND_TRIP, Proc("L", (ticks(7),), 100, priority=1)))
        assert worst(found, "L") == 22

    def test_what_is_above_delays_each_part_once_but_not_the_wait(self):
        # As execution: 105 + 7 * 10 = 175 in a window with nine releases of H needs 195. In parts: 2 + 10, 100, 3 + 10.
        found = analyze_system(offload(ROUND_TRIP, Proc("H", (ticks(10),), 25, priority=9), period=200, work=100))
        assert worst(found, "P") == 125

    def test_a_periodic_process_ends_a_wait_after_its_period_and_its_response(self):
        # It may have set the event just before that was cleared.
        model = built(
            Proc("P", (clear(), wait(), ticks(3)), 100, priority=1),
            Proc("Q", (ticks(4), sets()), 20, 5, priority=1, scheduler="s1"),
        )
        assert worst(analyze_system(model), "P") == 20 + 4 + 3

    def test_a_periodic_process_that_starts_late(self):
        model = built(
            Proc("P", (clear(), wait(), ticks(3)), 100, priority=1),
            Proc("Q", (ticks(4), sets()), 20, 60, priority=1, scheduler="s1"),
        )
        assert worst(analyze_system(model), "P") == 60 + 4 + 3

    def test_who_is_triggered_has_as_many_pending_jobs_as_who_waits_for_them(self):
        # Q: 20 + 2 * 4. P: 2 + 28 + 3, and 5 of A. By these alone, two triggers can be 50 - (38 - 5) = 17 apart, which is less than
        # Q takes; but before the second one, P has waited for what the first one started.
        late = Proc("A", (ticks(5),), 100, priority=9)
        found = analyze_system(offload(ROUND_TRIP, late, Proc("H", (ticks(4),), 15, priority=9, scheduler="s1"), work=20))
        assert (worst(found, "Q"), worst(found, "P")) == (28, 38)
        assert found["Q"].min_interarrival < 28 * US
        assert (found["Q"].verdict, found["Q"].reason) == (None, "")

    def test_a_wait_is_no_execution_time(self):
        found = analyze_system(offload())
        assert (found["P"].bcet, found["P"].wcet) == (5 * US, 5 * US)
        assert found["P"].verdict == "met"
        assert found["P"].response.terms["waits for events"] == 10 * US


class TestWhatMayWaitForEver:
    @pytest.mark.parametrize(
        ("body", "why"),
        [
            ((GO, clear(), wait(), clear(), ticks(3)), "it clears 'e' after it has triggered 'Q', and before it waits"),
            ((GO, wait(), ticks(3)), "not each of its jobs clears 'e' after it has waited for it"),
            ((wait(), GO, clear(), ticks(3)), "it triggers 'Q', which sets 'e', only after it has waited for that"),
            ((wait(), clear(), ticks(3)), "'Q', which sets 'e', is not triggered exactly once by each job that waits for it"),
            ((GO, wait("f"), clear("f"), ticks(3)), "no process sets the event 'f'"),
            (
                (GO, WaitEvent(events=("e", "f"), all_of_them=False), clear(), ticks(3)),
                "it waits for any of several events, 'e', 'f'",
            ),
        ],
    )
    def test_a_round_trip_that_is_incomplete(self, body, why):
        assert worst(analyze_system(offload(body)), "P").endswith(why)

    @pytest.mark.parametrize(
        "others",
        [
            [Proc("X", (GO, ticks(1)), 100, priority=1)],
            [Proc("X", (sets(), ticks(1)), 100, priority=1)],
        ],
    )
    def test_others_that_trigger_or_set_it_too(self, others):
        assert worst(analyze_system(offload(ROUND_TRIP, *others)), "P").startswith("it waits for events without a timeout")

    def test_who_polls_on_the_core_of_who_sets_the_event_and_is_not_below_that(self):
        polling = (ticks(2), GO, wait(waiting=ACTIVE), clear(), ticks(3))
        why = "it polls for that on the same core, where 'Q' cannot preempt it, and so never sets it"
        assert worst(analyze_system(offload(polling, scheduler="s0", priority=2)), "P").endswith(why)
        # Q counts twice: as the wait, and as a job above.
        assert worst(analyze_system(offload(polling, scheduler="s0", priority=3)), "P") == 2 + 10 + 10 + 3

    def test_a_trip_longer_than_the_period_can_meet_the_job_before_it(self):
        # Q has set the event, but not ended, when H preempts it: the next trigger may be lost.
        assert "activations may be lost" in worst(analyze_system(offload(period=14)), "P")

    def test_what_cannot_be_preempted_on_its_core(self):
        model = offload(ROUND_TRIP, Proc("N", (ticks(1),), 100, priority=1, task={"preemption": "non_preemptive"}))
        assert "cannot be preempted everywhere" in worst(analyze_system(model), "P")


@st.composite
def systems(draw):
    """One or two tasks that wait, each for a task that it triggers or for a periodic one, among others on two cores."""
    small, priorities = st.integers(1, 6), draw(st.permutations(range(1, 9)))
    tasks = []

    def run(least=0):
        low = draw(st.integers(least, 3))
        return ("run", low, low + draw(st.integers(0, 3)))

    for number in range(draw(st.integers(1, 2))):
        own, other, event = f"P{number}", f"Q{number}", f"e{number}"
        core, active, periodic = draw(st.integers(0, 1)), draw(st.booleans()), draw(st.booleans())
        period = draw(st.sampled_from((30, 40, 60)))
        tail = (run(1),) if draw(st.booleans()) else ()
        trip = () if periodic else (("trigger", other),)
        body = (run(), *trip, run(), ("wait", event, active), ("clear", event), run())
        tasks.append(PlayedTask(own, core, priorities.pop(), body, period, draw(st.integers(0, 20))))
        setter_core = draw(st.integers(0, 1))
        rate = (draw(st.sampled_from((12, 15, 20))), draw(st.integers(0, 40))) if periodic else ()
        tasks.append(PlayedTask(other, setter_core, priorities.pop(), (run(1), ("set", event, own), *tail), *rate))
    for number in range(draw(st.integers(0, 3))):
        period = draw(st.sampled_from((10, 12, 20, 30)))
        tasks.append(
            PlayedTask(f"H{number}", draw(st.integers(0, 1)), priorities.pop(), (run(1),), period, draw(st.integers(0, 9)))
        )
    return tasks, draw(small)


def to_perf(task):
    """The task of the product for one of the tests' simulator."""
    made = []
    for step in task.body:
        match step:
            case "run", low, high:
                made.append(ticks(high, low))
            case "trigger", other:
                made.append(Trigger(stimulus=f"go {other}"))
            case "wait", event, active:
                made.append(wait(event, ACTIVE if active else PASSIVE))
            case "clear", event:
                made.append(clear(event))
            case "set", event, process:
                made.append(sets(process, event))
    stimuli = () if task.period else (f"go {task.name}",)
    return Proc(task.name, tuple(made), task.period, task.offset, stimuli, task.priority, f"s{task.core}")


@given(systems())
@examples(150)
def test_no_job_of_any_run_is_beyond_its_bounds(drawn):
    tasks, seed = drawn
    triggers = tuple(f"go {task.name}" for task in tasks if not task.period)
    model = system(*map(to_perf, tasks), triggers=triggers, os_events=(OsEvent(name="e0"), OsEvent(name="e1")))
    found = analyze_system(model)
    bounds = {
        task.name: (found[task.name].response.best // US, found[task.name].response.worst // US)
        for task in tasks
        if found[task.name].response is not None and found[task.name].response.worst is not None
    }
    players = [Player(tasks, Random(number)).play(600) for number in range(seed, seed + 4)]
    options = Options(duration=Duration(600 * US), seed=seed)
    recording = record(model, options)
    assert list(contradictions(found, simulate_system(model, options))) == []
    runs = [player.found for player in players]
    runs.append({task.name: [(end - begin) // US for begin, _, end in recording.jobs_of(task.name)] for task in tasks})
    for run in runs:
        for name, (best, longest) in bounds.items():
            steady = run.get(name, [])
            assert max(steady, default=0) <= longest, (name, steady, bounds)
            assert min(steady, default=longest) >= best
    lost = set().union(*(player.lost for player in players))
    assert not any(name in bounds and found[name].verdict == "met" for name in lost)


def test_activations_of_an_overload_that_waits_surround_can_be_lost():
    # Nothing sets the event for which `Waiting` waits, and `High` leaves 3 us in 12 us, of which `Low` needs 5 us.
    waiting = Proc("Waiting", (ticks(9), wait(), clear(), ticks(6)), 40, priority=3)
    found = analyze_system(built(waiting, Proc("High", (ticks(9),), 12, priority=2), Proc("Low", (ticks(5),), 12, priority=1)))
    assert found["Low"].response.is_overload
    assert found["Low"].metrics[JobMetric.ACTIVATE_TO_ACTIVATE] == Metric(min=12 * US, max=None)
