"""Chains over a trigger that a counter lets have an effect only every second time."""

import pytest
from test_chain_systems import END, START, at, evaluate, system, ticks

from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.stimuli import Counter, InterProcess
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS


# W, every 100, executes 3 and triggers every second R, which executes 2: 5 after one W, 105 after the other. A counter of the stimulus
# ignores triggers that occur; one of the activity decides which jobs trigger, and others begin no chain.
@pytest.mark.parametrize(("place", "longest"), [("trigger", 5), ("stimulus", 105)])
@pytest.mark.parametrize("offset", [1, 2])
def test_a_trigger_without_effect_waits_for_the_next_one_with_an_effect(place, longest, offset):
    counter = Counter(prescaler=2, offset=offset)
    trigger = Trigger(stimulus="R", counter=counter if place == "trigger" else None)
    stimulus = InterProcess(name="R", counter=counter if place == "stimulus" else None)
    tasks = [("W", 100, [ticks(3), trigger]), ("R", None, [ticks(2)])]
    built = system(tasks, (at("W", START), at("R", END)), stimuli=(stimulus,))
    (chain,) = simulate_system(built, Options(duration=10 * MS)).chains
    assert chain.quantities[ChainQuantity.REDUCED_REACTION_TIME].max == longest * US
    _, values, _, _ = evaluate(built)
    assert values["min_first_to_first"] <= 5
    assert values["max_reduced_reaction_time"] >= longest
