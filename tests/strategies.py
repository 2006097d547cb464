"""Random models of any version, made from the facts: every class, every kind of feature, values that are hard to write."""

from collections import Counter
from random import Random
from typing import Any

from hypothesis import strategies as st

from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.metamodel.versions import held_versions
from amalthea_uros.xmi.plan import FeaturePlan, Plans, plans

MOST_OBJECTS = 80
ALPHABET = "ab Z09/?=&%+:;<>\"'~*.-_#|\t\n\rµßé漢😀"
FLOATS = (0.0, -0.0, 1.0, 0.001, 0.00099, 1e7, 9999999.0, 123.456, -5.5e-10, 1.7e300, 2.5, float("inf"))


def models() -> st.SearchStrategy[Model]:
    """Models of one document."""
    return st.builds(random_model, st.randoms(use_true_random=False), st.sampled_from(held_versions()))


def random_model(random: Random, version: str) -> Model:
    """A model of some dozen objects whose references are unambiguous."""
    root = Amalthea()
    model = Model([Document(root, version)])
    maker = _Maker(random, plans(version))
    maker.fill(root, depth=0)
    maker.refer(model)
    return model


class _Maker:
    def __init__(self, random: Random, version_plans: Plans) -> None:
        self.random = random
        self.plans = version_plans
        self.number = 0

    def fill(self, element: Element, depth: int) -> None:
        plan = self.plans.of(type(element).__name__)
        assert plan
        features = list(plan.features)
        self.random.shuffle(features)
        for feature in features:
            if feature.literal:
                if self.random.random() < 0.5:
                    setattr(element, feature.name, self.value(feature, element))
            elif not feature.is_reference and (depth == 0 or self.random.random() < 0.5):
                self.add_parts(element, feature, depth)

    def add_parts(self, element: Element, feature: FeaturePlan, depth: int) -> None:
        classes = self.plans.facts.concrete_subtypes(feature.target.__name__)
        count = self.random.randint(0, 3) if feature.many and not feature.only_one else 1
        for _ in range(count if classes else 0):
            if self.number >= MOST_OBJECTS or depth > 8:
                return
            self.number += 1
            plan = self.plans.of(self.random.choice(classes))
            assert plan
            part = plan.cls()
            if feature.many:
                getattr(element, feature.name).append(part)
            else:
                setattr(element, feature.name, part)
            self.fill(part, depth + 1)

    def value(self, feature: FeaturePlan, element: Element) -> Any:
        assert feature.literal
        kind = feature.literal.python_type
        if feature.is_string:
            length = self.random.choice((0, 1, 3, 12))
            return "".join(self.random.choice(ALPHABET) for _ in range(length))
        if kind is bool:
            return self.random.random() < 0.5
        if kind is int:
            return self.random.choice((0, 1, 7, 255, 10**20, self.random.getrandbits(40)))
        if kind is float:
            value = self.random.choice((*FLOATS, self.random.random() * 10 ** self.random.randint(-12, 12)))
            # A number of 32 bits keeps no more digits than it writes.
            return feature.literal.parse(feature.literal.format(value))
        return self.random.choice([member for member in kind if feature.parse is None or _known(feature, member)])

    def refer(self, model: Model) -> None:
        objects = list(model.walk())
        names = Counter(element.unique_name for element in objects if element.is_referable)
        for element in objects:
            plan = self.plans.of(type(element).__name__)
            assert plan
            for feature in plan.features:
                if not feature.is_reference or self.random.random() < 0.4:
                    continue
                fitting = [e for e in objects if isinstance(e, feature.target) and names[e.unique_name] == 1]
                self.set_reference(element, feature, fitting)

    def set_reference(self, element: Element, feature: FeaturePlan, fitting: list[Element]) -> None:
        # The namespace and the parameter are parts of names: they must not make two names alike.
        if not fitting or feature.name in ("namespace", "parameter", "runnable"):
            return
        if feature.many:
            setattr(element, feature.name, self.random.choices(fitting, k=self.random.randint(1, 3)))
        else:
            setattr(element, feature.name, self.random.choice(fitting))


def _known(feature: FeaturePlan, member: Any) -> bool:
    """Whether the version has that literal: the enumerations are those of all versions."""
    assert feature.literal
    try:
        feature.literal.parse(member.value)
    except ValueError:
        return False
    return True
