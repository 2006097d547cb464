"""The impact of pairs of random systems, against the results of both analyses read without the code of the impact."""

from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT
from system_strategies import systems

from amalthea_uros.analyze.impact import Effect, ResultPart, impact
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import parse_change
from amalthea_uros.services.subject import open_system
from amalthea_uros.timing.basics.settings import Settings

#: What is certain about a process, requirement or system that is fine.
GOOD = {"met", "yes"}
LATENCIES = ("max_reduced_reaction_time", "max_reduced_data_age")


def worst_times(analysis):
    """The guaranteed worst values by what they are about, None where there is none; a name that is there twice is left out."""
    found = {}
    for process in analysis.processes:
        found[ResultPart.PROCESS, process.name, "worst_case_response_time"] = (
            process.response.worst if process.response else None
        )
    for chain in analysis.chains:
        values = {value.quantity: value.value for value in reversed(chain.values)}
        found |= {(ResultPart.CHAIN, chain.name, quantity): values.get(quantity) for quantity in LATENCIES}
    return found


def verdicts(analysis):
    found = {(ResultPart.SYSTEM, "", "schedulable", ""): str(analysis.summary.schedulable)}
    for process in analysis.processes:
        found[ResultPart.PROCESS, process.name, "verdict", ""] = str(process.verdict)
    requirements = {}
    for each in analysis.requirements:
        about = f"{'maximum' if each.is_upper else 'minimum'} {each.quantity} of {each.object}"
        requirements.setdefault((ResultPart.REQUIREMENT, each.name, "verdict", about), []).append(str(each.verdict))
    return found | {key: values[0] for key, values in requirements.items() if len(values) == 1}


SAMPLE = open_system([ROOT / "samples" / "drive-and-lift.amxmi"]).system
#: From lost activations and overload to everything twice as fast.
CHANGES = {
    "Control_Speed.priority": ("0", "3", "9"),
    "Task_5ms.period": ("100us", "5ms", "20ms"),
    "Drive_Valve.execution_time": ("1us", "9ms", "30ms"),
    "Core_0.frequency": ("1MHz", "150MHz", "600MHz"),
    "Task_Log.deadline": ("10us", "1s"),
    "Set_Speed.jitter": ("0s", "40ms"),
    "Report_Odometry.core": ("Core_0", "Core_1"),
}


@st.composite
def changed_systems(draw):
    """The sample with some changes."""
    keys = draw(st.sets(st.sampled_from(sorted(CHANGES)), max_size=3))
    changes = [parse_change(f"{key}={draw(st.sampled_from(CHANGES[key]))}") for key in sorted(keys)]
    return apply(SAMPLE, Settings(), changes)


@examples(8)
@given(changed_systems(), changed_systems())
def test_pairs_of_changed_samples(one, other):
    judge(analyze_system(*one), analyze_system(*other))


@examples(8)
@given(systems(), systems())
def test_pairs_of_random_systems(one, other):
    judge(analyze_system(one), analyze_system(other))


def judge(before, after):
    """Nothing that is called better is no better, and nothing that is worse is called anything else."""
    effects = {row.figure.key: row.effect for row in impact(before, after).rows}
    old, new = worst_times(before), worst_times(after)
    for key in old.keys() & new.keys():
        effect = effects.get((*key, ""))
        if old[key] is not None and (new[key] is None or new[key] > old[key]):
            assert effect is Effect.WORSE, key
        if effect is Effect.BETTER and old[key] is not None:
            assert new[key] < old[key], key
        assert not (effect is Effect.BETTER and new[key] is None), key
    old, new = verdicts(before), verdicts(after)
    for key in old.keys() & new.keys():
        assert (effects.get(key) is Effect.BETTER) == (new[key] in GOOD and old[key] not in GOOD), key
        if old[key] in GOOD and new[key] not in GOOD:
            assert effects[key] is Effect.WORSE, key
    for key in new.keys() - old.keys():
        assert effects[key] is Effect.ADDED
    for key in old.keys() - new.keys():
        assert effects[key] is Effect.REMOVED
