"""Limits on jitters in AMALTHEA, which has no place for them."""

from dataclasses import replace

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros import am
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.perf.constraints import JitterLimit, TimeLimit, TimeMetric
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

SYSTEM = amuros.describe(ROOT / "samples" / "bodas-test-measured.yaml").system
RESPONSE_TIME, JITTER = SYSTEM.constraints.requirements


def built(metric=TimeMetric.RESPONSE_TIME):
    """The model in which the jitter of a time is limited, and its requirement."""
    requirement = replace(JITTER, limit=JitterLimit(metric=metric, value=MS // 2))
    model = build_model(replace(SYSTEM, constraints=replace(SYSTEM.constraints, requirements=(requirement,))))
    (element,) = model.root.constraints_model.requirements
    return model, element


def test_a_description_limits_the_jitter_of_the_response_time():
    assert JITTER.limit == JitterLimit(metric=TimeMetric.RESPONSE_TIME, value=500 * US)


@pytest.mark.parametrize("metric", TimeMetric)
def test_it_comes_back(metric):
    model, _ = built(metric)
    (found,) = extract(model).system.constraints.requirements
    assert found.limit == JitterLimit(metric=metric, value=MS // 2)


def test_what_other_tools_see_is_always_kept():
    _, element = built()
    assert element.limit.limit_type is am.LimitType.LOWER_LIMIT
    assert picoseconds(element.limit.limit_value) == 1


def test_a_limit_that_somebody_else_states_stays():
    model, element = built()
    element.limit = am.TimeRequirementLimit(
        metric=am.TimeMetric.RESPONSE_TIME, limit_type=am.LimitType.UPPER_LIMIT, limit_value=am.Time(2, "ms")
    )
    (found,) = extract(model).system.constraints.requirements
    assert found.limit == TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=2 * MS)
