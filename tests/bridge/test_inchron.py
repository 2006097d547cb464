"""Built models are what INCHRON's importer can take: nothing that it crashes on, and nothing lost but what the author asked for."""

from itertools import product

import pytest
from effort import every
from inchron import problems
from support import ROOT, SHARED

from amalthea_uros import build, load
from amalthea_uros.cli.descriptions import VERSIONS
from amalthea_uros.diagnostics import Severity
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
    found = [problem for problem in problems(built.model) if problem[1] != "I"]
    assert [problem for problem in found if problem[1] == "E"] == []
    assert {rule for rule, _, _ in found} == WISHES[sample.stem]
    # The findings on the description agree.
    (groups,) = summaries(built.model, ["inchron"]).values()
    assert {group.shown.rule for group in groups if group.shown.severity is not Severity.INFO} == WISHES[sample.stem]


@pytest.mark.parametrize(
    ("model", "rule"),
    [
        ("50_pu_nofreq", "INC-HW-PU-CLOCK"),
        ("40_osoverhead", "INC-OS-OVERHEAD"),
        ("40_prio_string", "INC-OS-PRIO-TYPE"),
        ("40_sched_param_nokey", "INC-OS-PARAM-KEY"),
        ("40_alloc_notask", "INC-MAP-TASK"),
        ("40_task_twice", "INC-MAP-TASK-ONCE"),
        ("31_relper_bounds", "INC-ST-RELPER"),
        ("31_relper_mixunit", "INC-ST-RELPER-UNIT"),
        ("20_ticks_beta", "INC-SW-TICKS-BETA"),
        ("20_ticks_bounds_default", "INC-SW-TICKS-BOUNDS"),
        ("22_label_nosize", "INC-SW-LABELSIZE"),
        ("23_call_norunnable", "INC-SW-REF"),
        ("10_chain_gap", "INC-EC-SEQ"),
        ("10_chain_par_badresp", "INC-EC-PAR"),
        ("10_lat_nobounds", "INC-LC-MAX"),
    ],
)
def test_the_checks_themselves_find_known_defects(model, rule):
    path = SHARED / "vectors" / "am2inc" / f"{model}.amxmi"
    if not path.exists():
        pytest.skip("the defective models are not at hand")
    assert rule in {found for found, _, _ in problems(load(path))}
