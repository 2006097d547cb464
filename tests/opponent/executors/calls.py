"""Calls of random executors and applications, simulated and played step by step."""

from __future__ import annotations

import simulated_calls as loops
from opponent.executors.tally import Tally
from played_executors import Spans, play
from whole_player import Player, S

from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.uros.described import describe_content


def different_calls(seed: int, tally: Tally) -> list[str]:
    """The calls of an executor, and of an application on a wire, that a player executes at another time."""
    return [*_of_executors(seed, tally), *_of_application(seed, tally)]


def _of_executors(seed: int, tally: Tally) -> list[str]:
    app = loops.fixed(seed)
    system, until = app.system, 300 * MS
    simulated = loops.calls(system, until)
    spans = Spans(costs=app.costs, spins=app.spins, sending={}, draw=lambda least, most: least)
    found = []
    played = play(
        system.executors,
        spans,
        until,
        random=loops.Least(),
        preempting=app.preempting,
        priorities=app.priorities,
        start=0,
    )
    for one in played:
        for entity in one.entities:
            responses = simulated[one.model.name, entity.handle.name]
            difference = loops.first_difference(responses, entity.seen.responses)
            if difference is not None:
                found.append(f"calls of an executor: {one.model.name}/{entity.handle.name}: {difference}")
            tally.calls["executors"] += len(responses)
    tally.played["executors"] += 1
    return found


def _of_application(seed: int, tally: Tally) -> list[str]:
    drawn = loops.on_wires(seed)
    if drawn is None:
        return []
    (content, plan), found = drawn, []
    system, until = loops.without_heartbeats(describe_content(content).assembly.system), S // 4
    loops.test_whole_way.prepared(content, plan)
    plan["blocks"] = system.network.wires[0].keeps_sender
    seen = Player(plan, loops.Least()).play(until)
    for (_, handle), responses in loops.calls(loops.as_planned(system, plan), until).items():
        difference = loops.first_difference(responses, seen.responses[handle])
        if difference is not None:
            found.append(f"calls of an application: {handle}: {difference}")
        tally.calls["applications"] += len(responses)
    tally.played["applications"] += 1
    return found
