"""The challenge model of 2017, and that of 2016, which is the same system: from the published file to response times.

The figures come from the programs of the published solutions and from pyCPA.
"""

import json
from fractions import Fraction

import older_forms
import pytest
from support import SHARED

from amalthea_uros import Claim, Communication, LatencyQuantity, Settings, am, analyze_system, extract, load
from amalthea_uros.units import MICROSECOND as US

MODEL = SHARED / "corpus" / "WATERS_2017_v072.amxmi"
FIGURES = SHARED / "vectors" / "waters2017.json"

pytestmark = pytest.mark.skipif(not (MODEL.exists() and FIGURES.exists()), reason="the challenge is not at hand")

LATENCIES = {
    "max_reaction": LatencyQuantity.MAX_REACTION_TIME,
    "max_reaction_without_sampling": LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    "max_data_age_L2L": LatencyQuantity.MAX_REDUCED_DATA_AGE,
    "max_data_age_until_replaced": LatencyQuantity.MAX_DATA_AGE,
    "min_forward": LatencyQuantity.MIN_FIRST_TO_FIRST,
}

CORES = ["CORE0", "CORE1", "CORE2", "CORE3"]


@pytest.fixture(scope="module")
def figures():
    return json.loads(FIGURES.read_text())


@pytest.fixture(scope="module")
def model():
    return load(MODEL)


@pytest.fixture(scope="module")
def older(tmp_path_factory):
    """The model of 2016."""
    path = tmp_path_factory.mktemp("challenge") / "2016.amxmi"
    path.write_text(older_forms.itea(MODEL.read_text()))
    return load(path)


@pytest.mark.parametrize("name", ["model", "older"])
def test_everything_is_there(name, figures, request):
    model, counts = request.getfixturevalue(name), figures["counts"]
    assert len(list(model.all(am.Task))) == counts["tasks"]
    assert len(list(model.all(am.Runnable))) == counts["runnables"]
    assert len(list(model.all(am.Label))) == counts["labels"]
    assert len(list(model.all(am.LabelAccess))) == counts["label_access_items"]
    assert len(list(model.all(am.EventChain))) == counts["event_chains"]
    assert [unit.name for unit in model.all(am.ProcessingUnit)] == CORES
    assert not list(model.unresolved())
    # What the migration could not keep.
    assert [finding for finding in model.findings if finding.severity != "info" and finding.rule != "XMI009"] == []


def test_the_older_model_is_the_same_system(model, older):
    assert extract(older).system == extract(model).system


@pytest.mark.parametrize(
    ("variant", "megahertz"), [("nominal_200MHz_nomem", 200), ("unimore_300MHz_nomem", 300), ("preemptive_300MHz_nomem", 300)]
)
def test_response_times(model, figures, variant, megahertz):
    how = {task: task.preemption for task in model.all(am.Task)}
    if variant.startswith("preemptive"):
        for task in how:
            task.preemption = am.Preemption.PREEMPTIVE
    analysis = analyze_system(extract(model).system, Settings(dict.fromkeys(CORES, Fraction(megahertz * 10**6))))
    for task, preemption in how.items():
        task.preemption = preemption
    for row in figures["tasks"]:
        worst, expected = analysis[row["name"]].response.worst, row["wcrt_us"][variant]
        if expected is None:
            assert worst is None, row["name"]
        else:
            # A third of a picosecond is printed rounded to the nearest one; a bound is rounded up.
            assert worst == pytest.approx(expected * US, abs=1), row["name"]


def test_chains_with_logical_execution_times(model, figures):
    """Exact figures; the labels are those that the runnables share, not those in the names of the segments."""
    settings = Settings(dict.fromkeys(CORES, Fraction(300 * 10**6)), communication=Communication.LET)
    chains = {chain.name: chain for chain in analyze_system(extract(model).system, settings).chains}
    expected = {chain["name"]: chain["LET_exact_us"] for chain in figures["chains"]}
    for name in ("EffectChain_1", "EffectChain_2"):
        known = expected[name]["as_modelled"]
        found = {key: chains[name].value(quantity) for key, quantity in LATENCIES.items()}
        assert {key: value.value / US for key, value in found.items()} == {key: known[key] for key in LATENCIES}
        assert {value.claim for value in found.values()} == {Claim.EXACT}
    # Its first task is sporadic, and has no period.
    assert "EffectChain_3" in chains
    assert not chains["EffectChain_3"].values
