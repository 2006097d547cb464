"""What EMF checks by itself: required features, numbers of values and limits, from the facts of each version."""

import json

import pytest
from excerpts import found, runnable
from support import SHARED, model_text

from amalthea_uros import check, load
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.versions import facts

TABLE = SHARED / "reference" / "app4mc-rules.json"


def rows(name, version):
    """The rows of the reference table that hold for a version."""
    found = json.loads(TABLE.read_text())["emf_intrinsic_table"][name]
    return [row for row in found if row["since"].removeprefix("<=") <= version <= (row["until"] or "9")]


@pytest.mark.parametrize("version", ["1.2.0", "2.0.0", "2.2.0", "3.3.0"])
@pytest.mark.skipif(not TABLE.exists(), reason="the reference table is not at hand")
def test_the_reference_table(version):
    declared = facts(version)

    def features(name):
        holder, _, feature = name.partition(".")
        return declared.feature(holder, feature)

    required = {row["feature"] for row in rows("required", version)}
    several = {row["feature"]: (row["lower"], row["upper"]) for row in rows("multiplicity", version)}
    numbers = {row["feature"]: row["datatype"] for row in rows("datatypes", version)}
    own = {
        f"{fact.name}.{feature.name}": feature
        for fact in declared.classes.values()
        for feature in fact.features
        if feature.stored
    }
    assert {
        name
        for name, feature in own.items()
        if feature.required
        and not feature.many
        and (feature.kind is not FeatureKind.ATTRIBUTE or declared.default(feature) is None)
    } == required
    assert {
        name: (feature.lower, -1 if feature.upper is None else feature.upper)
        for name, feature in own.items()
        if feature.many and (feature.required or feature.upper is not None)
    } == several
    assert {name: feature.type for name, feature in own.items() if feature.type in declared.numbers} == numbers


BOUNDS = [
    ("DiscreteValueStatistics", 'lowerBound="1" upperBound="3" average="2.0"', []),
    ("DiscreteValueStatistics", 'lowerBound="2" upperBound="2" average="2.0"', []),
    ("DiscreteValueStatistics", 'lowerBound="2" upperBound="3" average="1.0"', ["the lower bound 2 is above the average 1.0"]),
    ("DiscreteValueStatistics", 'lowerBound="1" upperBound="2" average="3.0"', ["the average 3.0 is above the upper bound 2"]),
    (
        "DiscreteValueStatistics",
        'lowerBound="3" upperBound="1" average="2.0"',
        [
            "the lower bound 3 is above the average 2.0",
            "the average 2.0 is above the upper bound 1",
            "the lower bound 3 is above the upper bound 1",
        ],
    ),
    # The mean of a truncated distribution may lie outside.
    ("DiscreteValueGaussDistribution", 'lowerBound="1" upperBound="2" mean="9.0" sd="1.0"', []),
    ("DiscreteValueGaussDistribution", 'upperBound="2" mean="9.0" sd="1.0"', []),
]


@pytest.mark.parametrize(("kind", "attributes", "expected"), BOUNDS)
def test_the_order_of_bounds(kind, attributes, expected, tmp_path):
    path = tmp_path / "model.amxmi"
    ticks = f'<items t="Ticks"><default t="{kind}" {attributes}/></items>'
    path.write_text(model_text(f'<swModel><runnables name="R"><activityGraph>{ticks}</activityGraph></runnables></swModel>'))
    rules = ["AM-EMF-INTRINSIC/DiscreteValueInterval", "AM-EMF-INTRINSIC/TruncatedDiscreteValueDistribution"]
    assert sorted(finding.message for finding in check(load(path), rules)) == sorted(expected)


def test_times_of_different_units_are_compared_as_times(tmp_path):
    path = tmp_path / "model.amxmi"
    jitter = '<jitter t="TimeUniformDistribution"><lowerBound value="{}" unit="us"/><upperBound value="1" unit="ms"/></jitter>'
    stimulus = f'<stimuliModel><stimuli t="PeriodicStimulus" name="S">{jitter}</stimuli></stimuliModel>'
    path.write_text(model_text(stimulus.format(1000)))
    assert not check(load(path), ["AM-EMF-INTRINSIC/TimeInterval"])
    path.write_text(model_text(stimulus.format(1001)))
    (finding,) = check(load(path), ["AM-EMF-INTRINSIC/TimeInterval"])
    assert finding.message == "the lower bound 1001 us is above the upper bound 1 ms"


MODES = """
<swModel>
  <modes t="EnumMode" name="E"><literals name="on"/></modes>
  <modes t="NumericMode" name="N"/>
  <modeLabels name="L" {}/>
</swModel>
"""


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ('mode="E?type=EnumMode"', []),
        ('mode="E?type=EnumMode" initialValue=" on "', []),
        ('mode="E?type=EnumMode" initialValue="1"', ["the initial value '1' of 'L' is not one of 'on'"]),
        ('mode="N?type=NumericMode" initialValue="-12"', []),
        ('mode="N?type=NumericMode" initialValue="1.5"', ["the initial value '1.5' of 'L' is not an integer"]),
        ('initialValue="1"', ["mode label 'L' has no mode"]),
    ],
)
def test_initial_values_of_mode_labels(attributes, expected, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(model_text(MODES.format(attributes)))
    assert [finding.message for finding in check(load(path), ["AM-EMF-INTRINSIC/ModeLabel"])] == expected


@pytest.mark.parametrize(
    ("data", "message"), [("", "the access has no mode label"), ("L?type=ModeLabel", "mode label 'L' has no mode")]
)
def test_accesses_to_mode_labels(data, message, tmp_path):
    access = runnable("R", f'<items t="ModeLabelAccess" data="{data}" access="set" value="1"/>')
    assert found("AM-EMF-INTRINSIC/ModeLabelAccess", f'<swModel>{access}<modeLabels name="L"/></swModel>', tmp_path) == [
        message
    ]
