"""The player of models plays small ones as they can be computed by hand."""

import pytest
from opponent.models import writing
from opponent.models.constraints import (
    Age,
    AgeInCycles,
    Delay,
    Deviation,
    EventOf,
    Order,
    Repetition,
    Synchronization,
)
from opponent.models.facts import Facts, facts_of
from opponent.models.limits import limits_of, with_limits
from opponent.models.reading import UnplayableError, read
from opponent.models.writing import (
    Parts,
    item,
    label_access,
    parameter,
    scheduler,
    semaphore,
    semaphore_access,
    stimulus,
    ticks,
    time,
)
from opponent.to_text import to_text

PERIODIC = time("recurrence", 20) + time("offset", 0)


def task(
    parts: Parts, name: str, priority: int, body: str, stimuli: str = "", kind: str = "Periodic", where: str = "Sc0"
) -> None:
    parts.tasks.append(writing.task(name, f"s{name}", body, limit=9))
    parts.stimuli.append(stimulus(kind, f"s{name}", "", stimuli or PERIODIC))
    parts.allocations.append(writing.task_allocation(name, where, {"priority": priority}))


@pytest.fixture
def parts() -> Parts:
    found = Parts(cores={"c0": "1.0"}, schedulers=[scheduler("Sc0", "FixedPriorityPreemptive")])
    found.allocations.append(writing.scheduler_allocation("Sc0", "c0"))
    return found


def responses(facts: Facts, process: str) -> tuple[int, int]:
    key = ("process", process, "response_time")
    return facts.least[key] // 10**6, facts.greatest[key] // 10**6


def played(parts: Parts, delays=()) -> Facts:
    return facts_of(parts.text(), delays, until=200 * 10**6)


def test_the_most_urgent_one_goes_first(parts):
    task(parts, "low", 1, ticks(5, 5))
    task(parts, "high", 2, ticks(3, 3), time("recurrence", 10) + time("offset", 7))
    # low 0..5, or from 20: high comes at 7, 17, 27, so it never delays low
    facts = played(parts, [(("high", "terminate"), ("low", "start"))])
    assert (responses(facts, "low"), responses(facts, "high")) == ((5, 5), (3, 3))
    # high ends at 10 and 20, low starts at 20
    key = ("delay", "high terminate", "low start")
    assert (facts.least[key], facts.greatest[key]) == (0, 10 * 10**6)


def test_a_condition_stops_activations(parts):
    parts.data += ['<modes xsi:type="am:NumericMode" name="n"/>', '<modeLabels name="M" mode="n" initialValue="0"/>']
    guard = '<setModeValueList><entries label="M" value="1"/></setModeValueList><executionCondition>'
    guard += '<entries xsi:type="am:ModeValueCondition" label="M" value="1" relation="NOT_EQUAL"/></executionCondition>'
    task(parts, "once", 1, ticks(1, 1), guard + PERIODIC)
    facts = played(parts)
    assert ("process", "once", "start_to_start") not in facts.greatest
    assert responses(facts, "once") == (1, 1)


def test_a_trigger_before_the_end(parts):
    task(parts, "W", 1, item("InterProcessTrigger", 'stimulus="sR"') + ticks(10, 10))
    task(parts, "R", 2, ticks(2, 2), " ", "InterProcess")
    facts = played(parts, [(("W", "terminate"), ("R", "terminate"))])
    # W triggers at once, R 0..2, W 2..12; the next end of R is at 22
    assert (responses(facts, "W"), responses(facts, "R")) == ((12, 12), (2, 2))
    assert facts.least[("delay", "W terminate", "R terminate")] == 10 * 10**6


def test_a_budget(parts):
    server = "".join(parameter(name, value) for name, value in {"priority": 9, "capacity": 2, "period": 5}.items())
    parts.schedulers.append(
        scheduler("V0", "DeferrableServer", f'<parentAssociation parent="Sc0">{server}</parentAssociation>')
    )
    task(parts, "served", 1, ticks(5, 5), where="V0")
    # 2 units at 0, 2 at 5, 1 at 10
    assert responses(played(parts), "served") == (11, 11)


def test_decisions_take_time(parts):
    cost = '<computationItems xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="1"/></computationItems>'
    parts.schedulers[:] = [scheduler("Sc0", "FixedPriorityPreemptive", cost)]
    task(parts, "T", 1, ticks(5, 5))
    # one before, and one at the end, which may be no part of the job
    assert played(parts).spread[("process", "T", "response_time")] == (6 * 10**6, 7 * 10**6)


def test_a_task_goes_on_on_another_core(parts):
    parts.cores["c1"] = "2.0"
    parts.schedulers.append(scheduler("Sc1", "FixedPriorityPreemptive"))
    parts.allocations.insert(0, writing.scheduler_allocation("Sc1", "c1"))
    task(parts, "here", 1, ticks(4, 4))
    task(parts, "there", 1, ticks(4, 4) + item("EnforcedMigration", 'resourceOwner="Sc0"') + ticks(1, 1), where="Sc1")
    # there: 2 on its own core; here 0..4, then 1 on the slower core, or before it, if what is declared last goes first
    facts = played(parts)
    assert facts.spread[("process", "there", "response_time")] in ((3 * 10**6, 5 * 10**6), (5 * 10**6, 5 * 10**6))


def test_bursts_and_times(parts):
    burst = stimulus(
        "PeriodicBurst", "sB", 'occurrenceCount="3"', PERIODIC + time("burstLength", 5) + time("occurrenceMinDistance", 2)
    )
    task(parts, "B", 2, ticks(1, 1), " ", "PeriodicBurst")
    parts.stimuli[-1] = burst
    task(parts, "S", 1, ticks(1, 1), PERIODIC + time("occurrenceTimes", 0) + time("occurrenceTimes", 13), "PeriodicSynthetic")
    facts = played(parts)
    assert facts.greatest[("process", "B", "activate_to_activate")] == 16 * 10**6
    assert facts.least[("process", "B", "activate_to_activate")] == 2 * 10**6
    assert facts.greatest[("process", "S", "activate_to_activate")] == 13 * 10**6
    assert responses(facts, "S") == (1, 2)


def test_latencies_of_a_chain(parts):
    parts.data.append('<labels name="L"/>')
    task(parts, "W", 2, ticks(1, 1) + label_access("L", "write", "explicit"))
    task(parts, "R", 1, label_access("L", "read", "explicit") + ticks(1, 1), time("recurrence", 10) + time("offset", 0))
    for name, change, process in (("begin", "start", "W"), ("end", "terminate", "R")):
        parts.events.append(writing.process_event(name, process, "Task", change))
    parts.chains.append('<eventChains name="chain" stimulus="begin" response="end"/>')
    facts = played(parts)
    found = {key[2]: value // 10**6 for key, value in (*facts.greatest.items(), *facts.least.items()) if key[0] == "chain"}
    # W 0..1, R 1..2 and 10..11: answered after 2, used until 11, replaced at 22
    assert (facts.greatest[("chain", "chain", "max_reaction_time")], found["min_first_to_first"]) == (22 * 10**6, 2)
    assert facts.greatest[("chain", "chain", "max_data_age")] == 22 * 10**6
    assert facts.greatest[("chain", "chain", "max_reduced_data_age")] == 11 * 10**6


def test_limits_lie_one_unit_inside(parts):
    task(parts, "T", 1, ticks(2, 5))
    facts = played(parts)
    limits = {limit.name: limit.limit // 10**6 for limit in limits_of(facts)}
    assert (limits["T response_time up"], limits["T response_time low"]) == (4, 3)
    assert 'metric="ResponseTime"' in with_limits(parts.text(), facts, list(limits_of(facts)))


def test_what_is_not_understood_is_refused(parts):
    task(parts, "T", 1, item("WaitEvent"))
    with pytest.raises(UnplayableError):
        read(parts.text())


def constrained(parts: Parts, constraint) -> tuple[int | None, int]:
    """The greatest of the minima and the least of the maxima of a constraint, in microseconds."""
    facts = facts_of(parts.text(), (), (constraint,), until=200 * 10**6)
    key = ("constraint", constraint.name, "")
    return facts.least.get(key, 0) // constraint.unit, facts.greatest[key] // constraint.unit


def runnable(parts: Parts, name: str, body: str) -> str:
    parts.runnables.append(writing.runnable(name, body))
    return item("RunnableCall", f'runnable="{name}"')


@pytest.fixture
def writer_and_reader(parts) -> Parts:
    """W at 0, 20, ... executes 1, w that takes 2 and then writes, and 1; R at 5, 25, ... executes r, which reads and takes 1."""
    parts.data.append('<labels name="L"/>')
    write, read_label = (label_access("L", access, "explicit") for access in ("write", "read"))
    task(parts, "W", 2, ticks(1, 1) + runnable(parts, "w", ticks(2, 2) + write) + ticks(1, 1))
    later = time("recurrence", 20) + time("offset", 5)
    task(parts, "R", 1, runnable(parts, "r", read_label + ticks(1, 1)) + runnable(parts, "s", ticks(1, 1)), later)
    return parts


def of_process(name: str, change: str) -> EventOf:
    return EventOf("process", name, change)


@pytest.mark.parametrize(
    ("constraint", "expected"),
    [
        # w starts at 1, L is written at 3 and read at 5.
        (Delay("D", EventOf("runnable", "w", "start"), EventOf("label", "L", "read"), "OneToOne"), (4, 4)),
        (Age("A", "w", "L", "W"), (2, 2)),
        # W is activated at 0, and again at 20.
        (AgeInCycles("C", "w", "L", "W"), (0, 0)),
        (Repetition("R", EventOf("runnable", "r", "terminate"), 2), (40, 40)),
        # Ten times every 20, instead of every 30.
        (Deviation("J", of_process("W", "start"), 30 * 10**6), (90, 90)),
        (Synchronization("S", (of_process("W", "start"), of_process("R", "terminate")), is_multiple=True), (7, 7)),
        (Order("O", "w", "r", "successor", ()), (0, 0)),
        (Order("O", "r", "w", "successor", ()), (1, 1)),
        (Order("O", "s", "r", "successor", (("R", "Task"),)), (1, 1)),
        (Order("O", "r", "s", "immediateSuccessorEndSequence", (("R", "Task"),)), (0, 0)),
    ],
    ids=str,
)
def test_what_constraints_limit(writer_and_reader, constraint, expected):
    assert constrained(writer_and_reader, constraint) == expected


def test_a_semaphore_with_and_without_ceiling(parts):
    request, release = (semaphore_access("S", access) for access in ("request", "release"))
    task(parts, "low", 1, request + ticks(5, 5) + release)
    task(parts, "mid", 2, ticks(3, 3), time("recurrence", 20) + time("offset", 2))
    task(parts, "high", 3, request + ticks(1, 1) + release, time("recurrence", 20) + time("offset", 1))
    parts.semaphores.append(semaphore("S", has_ceiling=True))
    # low has the semaphore from 0 to 5, then high ends at 6 and mid at 9; low at 5, or at 9, if its end waits for the core, too
    assert [responses(played(parts), name) for name in ("low", "mid", "high")] == [(9, 5), (7, 7), (5, 5)]
    parts.semaphores[:] = [semaphore("S", has_ceiling=False)]
    # high waits from 1, mid goes from 2 to 5, low ends at 8, or behind high, which ends at 9
    facts = played(parts)
    assert [responses(facts, name) for name in ("low", "mid", "high")] == [(9, 8), (3, 3), (8, 8)]
    assert facts.greatest[("process", "high", "net_execution_time")] == 8 * 10**6


# Systems in the plain form.


def process(name, body, period=20, priority=1, offset=0, **more):
    given = {"name": name, "kind": "task", "core": "core0", "priority": priority, "preemption": "preemptive"}
    return {**given, "arrival": {"periodic": {"period": period, "offset": offset}}, "body": body, **more}


def execute(time: int):
    return {"execute": [time, time]}


COOPERATIVE = {"preemption": "cooperative"}
POINT = {"point": True}
#: The policy of the core, processes, and the least of the greatest response times and the greatest of the least ones in all readings.
PLAIN = {
    # high runs at 0..2, 5..7, 10..12: low gets 2..5 and 7..9.
    "a more urgent task interrupts": (
        "FPP",
        [process("low", [execute(5)]), process("high", [execute(2)], 5, priority=2)],
        {"low": (9, 9), "high": (2, 2)},
    ),
    # high waits from 1 to 4.
    "a cooperative task goes on to its schedule point": (
        "FPP",
        [
            process("low", [execute(4), POINT, execute(2)], **COOPERATIVE),
            process("high", [execute(1)], priority=2, offset=1, **COOPERATIVE),
        ],
        {"low": (7, 7), "high": (4, 4)},
    ),
    # low executes 0..7 in one stretch; then high has waited for 6.
    "executions of a cooperative task are one stretch": (
        "FPP",
        [
            process("low", [execute(3), execute(4), POINT, execute(1)], **COOPERATIVE),
            process("high", [execute(2)], priority=2, offset=1, **COOPERATIVE),
        ],
        {"low": (10, 10), "high": (8, 8)},
    ),
    "the earlier deadline goes first": (
        "EDF",
        [process("late", [execute(3)], deadline=9), process("soon", [execute(2)], deadline=5)],
        {"soon": (2, 2), "late": (5, 5)},
    ),
    # a a b a b, or with b first: b a a b a
    "slices alternate": (
        "RR",
        [process("a", [execute(3)], slice=2), process("b", [execute(2)], slice=1)],
        {"a": (5, 4), "b": (5, 4)},
    ),
    "a counter takes effect every other time": (
        "FPP",
        [process("caller", [execute(1), {"call": "r", "prescaler": 2, "offset": 0}], 10)],
        {"caller": (1, 5)},
    ),
}


@pytest.mark.parametrize(("policy", "processes", "expected"), PLAIN.values(), ids=PLAIN)
def test_systems_in_the_plain_form(policy, processes, expected):
    plain = {"cores": {"core0": policy}, "semaphores": {}, "processes": processes, "runnables": {"r": [execute(4)]}}
    facts = facts_of(to_text(plain), until=200 * 10**6)
    assert {name: responses(facts, name) for name in expected} == expected
