"""The player agrees with published facts, which somebody else's player found, and with systems played by hand."""

import pytest
from effort import every
from opponent.observation import Observation, observe
from opponent.systems import PlainSystem, has_open_choices
from opponent.vectors import facts, needs_vectors, plain_systems


def task(name, body, period, priority=1, preemption="preemptive", **more):
    process = {"name": name, "kind": "task", "core": "core0", "priority": priority, "preemption": preemption}
    return {**process, "arrival": {"periodic": {"period": period}}, "body": body, **more}


def observed(*processes, policy="FPP", semaphores=(), chain=None):
    system: PlainSystem = {"cores": {"core0": policy}, "runnables": {}, "processes": list(processes)}
    system["semaphores"] = {name: {"ceiling": True} for name in semaphores}
    return observe(system | ({"chain": chain} if chain else {}), range(1))


def test_a_more_urgent_task_interrupts():
    low = task("low", [{"execute": [5, 5]}], 20)
    high = task("high", [{"execute": [2, 2]}], 5, priority=2)
    found = observed(low, high)
    # high runs at 0..2, 5..7, 10..12: low gets 2..5 and 7..9.
    assert (found.worst, found.best) == ({"low": 9, "high": 2}, {"low": 9, "high": 2})
    assert found.determined == {"low", "high"}


def test_a_cooperative_task_goes_on_to_its_schedule_point():
    low = task(
        "low", [{"execute": [3, 3]}, {"execute": [4, 4]}, {"point": True}, {"execute": [1, 1]}], 20, preemption="cooperative"
    )
    high = task("high", [{"execute": [2, 2]}], 20, priority=2)
    high["arrival"]["periodic"]["offset"] = 1
    found = observed(low, high | {"preemption": "cooperative"})
    # low executes 0..7 in one stretch; then high has waited for 6.
    assert (found.worst, found.determined) == ({"low": 10, "high": 8}, {"low", "high"})


def test_the_ceiling_keeps_other_users_off():
    low = task("low", [{"request": "s"}, {"execute": [4, 4]}, {"release": "s"}], 20)
    high = task("high", [{"execute": [1, 1]}, {"request": "s"}, {"execute": [1, 1]}, {"release": "s"}], 20, priority=2)
    high["arrival"]["periodic"]["offset"] = 1
    assert observed(low, high, semaphores="s").worst == {"low": 4, "high": 5}


def test_the_earlier_deadline_goes_first():
    soon = task("soon", [{"execute": [2, 2]}], 20, deadline=5)
    late = task("late", [{"execute": [3, 3]}], 20, deadline=9)
    assert observed(late, soon, policy="EDF").worst == {"soon": 2, "late": 5}


def test_slices_alternate():
    a = task("a", [{"execute": [3, 3]}], 20, slice=2)
    b = task("b", [{"execute": [2, 2]}], 20, slice=1)
    # a a b a b, or with b first: b a a b a
    found = observed(a, b, policy="RR")
    assert (found.worst, found.best) == ({"a": 4, "b": 4}, {"a": 5, "b": 5})


def test_a_counter_takes_effect_every_other_time():
    caller = task("caller", [{"execute": [1, 1]}, {"call": "r", "prescaler": 2, "offset": 0}], 10)
    system: PlainSystem = {"cores": {"core0": "FPP"}, "semaphores": {}, "runnables": {"r": [{"execute": [4, 4]}]}}
    found = observe(system | {"processes": [caller]}, range(1))
    assert (found.worst, found.best) == ({"caller": 5}, {"caller": 1})


def test_latencies_of_a_chain_of_two():
    writer = task("writer", [{"execute": [1, 1]}, {"write": "L0"}], 20, priority=2)
    reader = task("reader", [{"read": "L0"}, {"execute": [1, 1]}], 10)
    found = observed(writer, reader, chain={"processes": ["writer", "reader"], "communication": "implicit"})
    # writer 0..1, reader 1..2 and 10..11: the first value arrives after 2, the last is used until 11 and stays until 22.
    assert found.chain == {
        "max_reaction_time": 22,
        "max_reduced_reaction_time": 2,
        "min_first_to_first": 2,
        "max_data_age": 22,
        "max_reduced_data_age": 11,
        "min_last_to_last": 2,
    }


FACTS = facts() if not needs_vectors.args[0] else {}
SYSTEMS = plain_systems() if FACTS else {}


@needs_vectors
@pytest.mark.parametrize("block", range(8))
def test_the_published_facts_occur(block):
    names = every(7, sorted(FACTS)[block::8])
    wrong = [text for name in names for text in contradictions(name)]
    assert wrong == []


def contradictions(name):
    """Where what is certain for one of the players is impossible for the other."""
    system, found = SYSTEMS[name], observe(SYSTEMS[name], range(2))
    for process, fact in FACTS[name]["processes"].items():
        worst, best = found.worst[process], found.best[process]
        most, least = fact["occurs_max_us"], fact["occurs_min_us"]
        if fact["determined"] and (worst, best) != (most, least):
            yield f"{name} {process}: {best}..{worst} occurs, not {least}..{most}"
        if process in found.determined and not (worst >= most and best <= least):
            yield f"{name} {process}: always {best}..{worst}, but {least}..{most} is known to occur"
    for chain in FACTS[name].get("chains", {}).values():
        yield from (f"{name} {text}" for text in contradicting_latencies(chain, found, system))


def contradicting_latencies(fact, found: Observation, system):
    for quantity, value in fact.items():
        if quantity == "determined" or value is None or quantity not in found.chain:
            continue
        mine = found.chain[quantity]
        if fact["determined"] and mine != value:
            yield f"{quantity}: {mine}, not {value}"
        is_less = mine < value if quantity.startswith("max") else mine > value
        if not has_open_choices(system) and quantity in found.determined and is_less:
            yield f"{quantity}: always {mine}, but {value} is known to occur"
