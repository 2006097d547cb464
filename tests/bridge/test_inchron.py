"""Built models are what INCHRON's importer can take: nothing that it crashes on, and nothing lost but what the author asked for."""

from itertools import product

import pytest
from effort import every
from support import ROOT

from amalthea_uros import build
from amalthea_uros.cli.descriptions import VERSIONS
from amalthea_uros.diagnostics import Severity
from amalthea_uros.inchron_bridge.importable import importable
from amalthea_uros.metamodel.classes import RelativePeriodicStimulus
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.constraints import Bound, Constraints, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Os, Scheduler
from amalthea_uros.perf.system import System
from amalthea_uros.services.build_targets import BuildTarget
from amalthea_uros.services.check import summaries

SAMPLES = sorted((ROOT / "samples").glob("*.yaml"))


#: What the importer does not take over of what the descriptions ask for: requirements, costs of accesses, a policy, statistics of
#: execution times, a semaphore with a ceiling; least distances of messages, points at which foreign frames are sent, curves of
#: arrivals, and where a label is written.
WISHES = {
    "bodas-test-advanced": {"INC-CO-KIND"},
    "bodas-test-hardware": {"INC-CO-KIND", "INC-HW-ACCESS", "INC-OS-ALGORITHM", "INC-SW-TICKS-STAT"},
    "bodas-test-measured": {"INC-CO-KIND"},
    "bodas-test-simple": {"INC-CO-KIND"},
    "drive-and-lift": {"INC-CO-KIND", "INC-OS-SEMA-TYPE"},
    "esp32-serial": {"INC-EV-LABEL-RUN", "INC-ST-TYPE"},
    "rclc-in-executor": {"INC-CO-KIND"},
    "robot-two-controllers": {"INC-EV-KIND", "INC-LC-SCOPE", "INC-ST-TYPE"},
    "robot-with-host": {"INC-EV-KIND", "INC-LC-SCOPE", "INC-ST-TYPE"},
    "robot-xrce": {"INC-ST-TYPE"},
    "robot-zenoh": {"INC-ST-TYPE"},
    "two-controllers-drive": {"INC-CO-KIND", "INC-ST-TYPE", "INC-SW-PREEMPTION"},
    "two-controllers-lift": {"INC-CO-KIND", "INC-ST-TYPE", "INC-SW-PREEMPTION"},
    "stm32-usb-cdc": {"INC-EV-LABEL-RUN", "INC-ST-TYPE"},
}


@pytest.mark.parametrize(
    ("sample", "version"), every(5, list(product(SAMPLES, VERSIONS))), ids=lambda value: getattr(value, "stem", value)
)
def test_a_sample(sample, version):
    if sample.stem == "drive-and-lift" and version == "1.2.0":
        pytest.skip("1.2.0 has no deadlines")
    built = build(sample, version)
    (groups,) = summaries(built.model, ["inchron"]).values()
    found = {group.shown.rule: group.shown.severity for group in groups if group.shown.severity is not Severity.INFO}
    assert Severity.ERROR not in found.values()
    assert found.keys() == WISHES[sample.stem]


#: What the importer changes without a message is the same in both forms; a stimulus that it does not convert is in none of them.
REMAINING = {name: rules - {"INC-ST-TYPE"} for name, rules in WISHES.items()}


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_a_sample_for_the_importer(sample):
    found_groups = summaries(build(sample, tool=BuildTarget.INCHRON).model, ["inchron"]).values()
    found = {group.shown.rule for groups in found_groups for group in groups if group.shown.severity is not Severity.INFO}
    assert found == REMAINING[sample.stem]


def test_iterations_rates_and_limits_are_in_a_form_that_is_converted():
    curve = perf.ArrivalCurve(name="curve", points=(perf.ArrivalCurvePoint(occurrences=2, lower=15),))
    custom = perf.Custom(name="custom")
    rounds = perf.ArrivalCurve(name="rounds", points=(perf.ArrivalCurvePoint(occurrences=2, lower=3),))
    schedulers = [Scheduler(name=policy, policy=policy) for policy in ("FixedPriorityPreemptive", "EarliestDeadlineFirst")]
    limits = [(task, value) for task in "AB" for value in (9, 4)]
    system = System(
        stimuli=perf.Stimuli(stimuli=(curve, custom, rounds)),
        os=Os(systems=(OperatingSystem(name="OS", schedulers=tuple(schedulers)),)),
        mapping=Mapping(
            tasks=tuple(TaskAllocation(task=task, scheduler=each.name) for task, each in zip("AB", schedulers, strict=True))
        ),
        constraints=Constraints(
            requirements=tuple(
                Requirement(
                    name="R", process=task, limit=TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=value, bound=Bound.UPPER)
                )
                for task, value in limits
            )
        ),
    )
    result, findings = importable(system, {"rounds": (3, 20)}, with_deadlines=True)
    assert result.stimuli.stimuli == (
        perf.Periodic(name="curve", period=15, min_distance=15),
        custom,
        perf.RelativePeriodic(name="rounds", distance=Uniform(lower=3, upper=20)),
    )
    # A deadline would change what the other scheduler does.
    assert [each.deadline for each in result.mapping.tasks] == [4, None]
    assert [each.rule for each in findings] == ["BLD002", "BLD003", "BLD002", "BLD002"]


def test_the_bounds_of_a_distance_have_one_unit():
    sample = build(ROOT / "samples" / "robot-xrce.yaml", tool=BuildTarget.INCHRON)
    (rounds,) = (each for each in sample.model.all(RelativePeriodicStimulus) if each.name == "rounds_of_Executor")
    assert rounds.next_occurrence.lower_bound.unit is rounds.next_occurrence.upper_bound.unit
