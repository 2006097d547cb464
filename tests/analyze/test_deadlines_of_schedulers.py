"""A scheduler serves by the deadlines that allocations state; limits only judge."""

from dataclasses import replace

import pytest
from hand_made_systems import Proc, system, ticks

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.constraints import Bound, Constraints, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.units import MICROSECOND as US


@pytest.mark.parametrize("policy", [Policy.DEADLINE_MONOTONIC, Policy.EARLIEST_DEADLINE_FIRST])
@pytest.mark.parametrize(("deadline", "verdicts"), [(None, ["unknown", "unknown"]), (10, ["met", "met"])])
def test_a_response_time_limit_is_no_deadline_of_the_scheduler(policy, deadline, verdicts):
    """A stricter limit of A changes nothing in the order of A and B, each of which executes 3: both respond within 6."""
    tasks = [Proc(name, (ticks(3),), period, deadline=deadline) for name, period in (("A", 20), ("B", 30))]
    found = system(*tasks, schedulers=(Scheduler(name="s0", policy=policy, cores=("c0",)),))
    limits = [TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=value * US, bound=Bound.UPPER) for value in (6, 7)]
    requirements = tuple(Requirement(name=name, process=name, limit=limit) for name, limit in zip("AB", limits, strict=True))
    analysis = analyze_system(replace(found, constraints=Constraints(requirements=requirements)))
    assert [str(each.verdict) for each in analysis.requirements] == verdicts
