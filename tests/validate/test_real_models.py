"""All rules on all models that are at hand."""

from collections import Counter

import pytest
from effort import examples
from hypothesis import given
from strategies import models
from support import ROOT, SHARED, corpus, hand_written
from system_strategies import systems

from amalthea_uros import build_model, check, load
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.validate import registry
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.engine import run
from amalthea_uros.validate.rule import ModelCheck

SAMPLES = [pytest.param(path, id=path.name) for path in sorted((ROOT / "samples").glob("*.amxmi"))]

#: Rules that fire on more than half of the published models, and why that is no mistake of theirs.
FREQUENT: dict[str, str] = {}


@pytest.mark.parametrize("path", [*SAMPLES, *corpus(), *hand_written()])
def test_no_rule_fails(path):
    try:
        model = load(path)
    except ReadError:
        pytest.skip("the file cannot be read")
    findings = check(model)
    assert [str(finding) for finding in findings if finding.rule == "CHK001"] == []
    # Every finding has a place, and knows its object.
    assert all(finding.location.line and finding.object for finding in findings if not finding.rule.startswith("XSD"))


@pytest.mark.parametrize("path", SAMPLES)
def test_samples_are_sound(path):
    assert [str(finding) for finding in check(load(path)) if finding.severity == "error"] == []


def models_by_rule():
    """On how many published models each rule fires, and how many models there are."""
    firing, number = Counter(), 0
    for parameter in corpus():
        (path,) = parameter.values
        firing.update({finding.rule for finding in check(load(path))})
        number += 1
    return firing, number


@pytest.mark.skipif(not (SHARED / "corpus" / "inventory.json").exists(), reason="the published models are not at hand")
def test_a_rule_that_fires_on_most_models_is_explained():
    firing, number = models_by_rule()
    assert {rule for rule, times in firing.items() if times > number / 2} == FREQUENT.keys()


CLASSES = [cls for cls in vars(classes).values() if isinstance(cls, type) and issubclass(cls, Element) and not cls.is_abstract]


@pytest.mark.parametrize("identifier", list(registry.ids()))
def test_no_rule_fails_where_nothing_is_set(identifier):
    rule = registry.check(identifier)
    if isinstance(rule, ModelCheck):
        context = Context(Model([Document(Amalthea())]))
        for element in (cls() for cls in CLASSES if issubclass(cls, rule.target)):
            list(rule.check(element, context))


RULES = [rule for rule in map(registry.check, registry.ids()) if isinstance(rule, ModelCheck)]


@examples(18)
@given(models(size=60))
def test_no_rule_fails_at_a_random_model(model):
    assert [finding for finding in run(model, RULES) if finding.rule == "CHK001"] == []


@examples(10)
@given(systems(2))
def test_no_rule_fails_at_a_model_of_a_random_system(system):
    assert [finding for finding in run(build_model(system), RULES) if finding.rule == "CHK001"] == []
