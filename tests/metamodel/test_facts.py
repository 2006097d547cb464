"""The facts in the project are those of the Ecore files, and the classes are their union."""

import json
import subprocess
import sys

import pytest
from support import ROOT, SHARED

from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import facts, known_versions, nearest_version, supported_versions


def test_versions():
    assert len(known_versions()) == 16
    assert (supported_versions()[0], supported_versions()[-1]) == ("0.9.7", "3.3.0")


@pytest.mark.parametrize(("asked", "served"), [("3.3.0", "3.3.0"), ("3.4.0", "3.3.0"), ("2.1.5", "2.1.0"), ("0.1.0", "0.9.3")])
def test_the_nearest_version(asked, served):
    assert nearest_version(asked) == served


@pytest.mark.parametrize(
    ("version", "name", "feature", "default", "required"),
    [
        ("2.0.0", "Semaphore", "maxValue", "0", False),
        ("2.1.0", "Semaphore", "maxValue", "1", False),
        ("1.2.0", "Group", "interruptible", "true", False),
        ("3.3.0", "MemoryMapping", "memory", None, True),
        ("2.0.0", "MemoryMapping", "memory", None, False),
    ],
)
def test_what_changed_between_versions(version, name, feature, default, required):
    fact = facts(version).feature(name, feature)
    assert (fact.default, fact.required) == (default, required)


def test_the_order_of_a_feature_is_a_fact_of_the_version():
    orders = [
        [f.name for f in facts(v).features("FixedPeriodic") if f.name in ("recurrence", "offset")] for v in ("0.9.5", "0.9.7")
    ]
    assert orders == [["offset", "recurrence"], ["recurrence", "offset"]]


@pytest.mark.parametrize("version", supported_versions())
def test_every_opposite_is_a_containment_and_its_mirror(version):
    declared = facts(version)
    for name in declared.classes:
        for fact in declared.features(name):
            if fact.opposite is not None:
                other = declared.feature(fact.type, fact.opposite)
                assert {fact.kind, other.kind} == {FeatureKind.CONTAINMENT, FeatureKind.REFERENCE}
                assert fact.stored is (fact.kind is FeatureKind.CONTAINMENT)


@pytest.mark.parametrize("version", supported_versions())
def test_every_class_and_feature_has_its_python_side(version):
    declared = facts(version)
    for name in declared.classes:
        held = {feature.xml_name: feature for feature in features_of(getattr(classes, name)).values()}
        for fact in declared.features(name):
            if fact.stored:
                kinds = {
                    FeatureKind.ATTRIBUTE: ("attribute",),
                    FeatureKind.CONTAINMENT: ("containment", "either"),
                    FeatureKind.REFERENCE: ("reference", "either"),
                }
                assert held[fact.name].kind in kinds[fact.kind]
                assert held[fact.name].many or not fact.many


@pytest.mark.skipif(not (SHARED / "metamodel").exists(), reason="the dumps of the Ecore files are not at hand")
class TestAgainstTheEcoreFiles:
    def test_the_facts_are_current(self, tmp_path):
        subprocess.run([sys.executable, ROOT / "tools" / "import_facts.py", SHARED / "metamodel", tmp_path], check=True)
        committed = ROOT / "amalthea_uros" / "metamodel" / "facts"
        assert {p.name: p.read_text() for p in tmp_path.iterdir()} == {p.name: p.read_text() for p in committed.iterdir()}

    @pytest.mark.parametrize("version", known_versions())
    def test_the_order_of_all_features(self, version):
        dump = json.loads((SHARED / "metamodel" / f"amalthea-{version}.json").read_text())
        declared = facts(version)
        assert set(declared.classes) == {cls["name"] for cls in dump["classes"]}
        for cls in dump["classes"]:
            expected = [feature.split(".")[1] for feature in cls.get("allFeatures", [])]
            assert [feature.name for feature in declared.features(cls["name"])] == expected

    @pytest.mark.parametrize("version", known_versions())
    def test_the_bounds_of_all_features(self, version):
        dump = json.loads((SHARED / "metamodel" / f"amalthea-{version}.json").read_text())
        declared = facts(version)
        for cls in dump["classes"]:
            for feature in (*cls.get("attributes", []), *cls.get("references", [])):
                held = declared.feature(cls["name"], feature["name"])
                assert held.many == (feature["upper"] != 1), (cls["name"], feature["name"])
                assert held.required == (feature["lower"] > 0), (cls["name"], feature["name"])
