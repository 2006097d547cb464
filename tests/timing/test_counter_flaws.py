"""A prescaler below 1 has no meaning: what it lets take effect is unknown, with this cause, in analysis and simulation alike."""

from dataclasses import replace

import pytest
from hand_made_systems import WRITE, Proc, access, system, ticks

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, SetEvent, Trigger
from amalthea_uros.perf.software import OsEvent, Runnable
from amalthea_uros.perf.stimuli import Counter, InterProcess
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration
from amalthea_uros.validate.system_context import SystemContext

ZERO, NEGATIVE = Counter(prescaler=0), Counter(prescaler=-2, is_phase_known=False)
#: Above and below what is unknown, on its core, and on another one.
ABOVE, BELOW = Proc("above", (ticks(1),), 50, priority=9), Proc("below", (ticks(1),), 50, priority=1)
ELSEWHERE = Proc("elsewhere", (ticks(1),), 50, priority=1, scheduler="s1")


def verdicts(model):
    """Of all processes, in the analysis, and in the simulation."""
    simulation = simulate_system(model, Options(duration=Duration(500 * US)))
    proved = {each.name: (str(each.verdict), each.reason) for each in analyze_system(model).processes}
    seen = {each.name: (str(each.verdict), each.reason) for each in (*simulation.processes, *simulation.left_out)}
    return proved, seen


def triggering(counter=None, of_stimulus=None, caller=None):
    """A process that triggers another one, in its own activities or in a runnable."""
    trigger = Trigger(stimulus="go", counter=counter)
    body = (ticks(1), trigger) if caller is None else (ticks(1), Call(runnable=caller))
    runnables = () if caller is None else (Runnable(name=caller, activities=(trigger,)),)
    model = system(
        Proc("from", body, 50, priority=8, scheduler="s1"),
        Proc("to", (ticks(5),), stimuli=("go",), priority=5, deadline=50),
        ABOVE,
        BELOW,
        runnables=runnables,
        triggers=("go",),
    )
    if of_stimulus is None:
        return model
    stimuli = (*(each for each in model.stimuli.stimuli if each.name != "go"), InterProcess(name="go", counter=of_stimulus))
    return replace(model, stimuli=replace(model.stimuli, stimuli=stimuli))


@pytest.mark.parametrize(
    ("model", "cause"),
    [
        (triggering(ZERO), "the counter of the trigger of 'go' has the prescaler 0, which has no meaning"),
        (triggering(NEGATIVE), "the counter of the trigger of 'go' has the prescaler -2, which has no meaning"),
        (triggering(ZERO, caller="r"), "the counter of the trigger of 'go' has the prescaler 0, which has no meaning"),
        (triggering(of_stimulus=ZERO), "the counter of the stimulus 'go' has the prescaler 0, which has no meaning"),
        (triggering(of_stimulus=NEGATIVE), "the counter of the stimulus 'go' has the prescaler -2, which has no meaning"),
    ],
)
def test_what_is_triggered_is_unknown_for_this_cause(model, cause):
    proved, seen = verdicts(model)
    assert proved["to"] == ("unknown", cause)
    assert seen["to"] == ("not_observed", cause)
    assert (proved["from"][0], proved["above"][0]) == ("met", "met")
    assert seen["from"][0] == "observed_ok"
    # It may be delayed without end.
    assert proved["below"] == ("unknown", "depends on 'to', which could not be analysed")
    assert seen["below"] == ("not_observed", "depends on 'to', which is not simulated")


@pytest.mark.parametrize("counter", [ZERO, NEGATIVE])
def test_a_call(counter):
    body = (ticks(1), Call(runnable="r", counter=counter))
    runnable = Runnable(name="r", activities=(ticks(1), access("L", WRITE)))
    model = system(Proc("T", body, 50, priority=5), ABOVE, BELOW, ELSEWHERE, runnables=(runnable,))
    proved, seen = verdicts(model)
    cause = f"the counter of the call of 'r' has the prescaler {counter.prescaler}, which has no meaning"
    assert proved["T"] == ("unknown", cause)
    assert seen["T"] == ("not_observed", cause)
    assert {name: verdict for name, (verdict, _) in proved.items() if name != "T"} == {
        "above": "met",
        "below": "unknown",
        "elsewhere": "met",
    }
    assert {name: verdict for name, (verdict, _) in seen.items() if name != "T"} == {
        # The simulation asks for no priorities: all on the core are in doubt.
        "above": "not_observed",
        "below": "not_observed",
        "elsewhere": "observed_ok",
    }


def test_another_activity():
    setting = SetEvent(events=("e",), counter=ZERO)
    proved, seen = verdicts(system(Proc("T", (ticks(1), setting), 50, priority=5), os_events=(OsEvent(name="e"),)))
    assert proved["T"][1] == seen["T"][1] == "the counter of a SetEvent has the prescaler 0, which has no meaning"


def test_no_load_is_certain_because_of_it():
    # A call that triggers by a counter without meaning, and a trigger of that kind: 60 us of 50 us each time.
    for model in (
        system(
            Proc("from", (Call(runnable="r", counter=ZERO),), 50, priority=8, scheduler="s1"),
            Proc("to", (ticks(60),), stimuli=("go",), priority=5),
            runnables=(Runnable(name="r", activities=(Trigger(stimulus="go"),)),),
            triggers=("go",),
        ),
        system(
            Proc("from", (Trigger(stimulus="go", counter=ZERO),), 50, priority=8, scheduler="s1"),
            Proc("to", (ticks(60),), stimuli=("go",), priority=5),
            triggers=("go",),
        ),
    ):
        assert SystemContext(model).certain_loads.get("c0", 0) == 0
        assert analyze_system(model).processors["c0"].worst is None
