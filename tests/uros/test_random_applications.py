"""Any description results in a valid model or in findings, never in anything else."""

import random

import pytest
import yaml
from effort import every, examples
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros import build, check
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile
from amalthea_uros.xmi.emf.writer import document_text
from amalthea_uros.xmi.schema import validate

SAMPLES = sorted((ROOT / "samples").glob("*.yaml"))

PERIODS = st.sampled_from(["1 ms", "5 ms", "10 ms", "20 ms", "100 ms"])
CORES = st.sampled_from(["Core_0", "Core_1"])
TIMES = st.one_of(
    st.integers(1, 900).map(lambda us: f"{us} us"),
    st.integers(1, 400).map(lambda us: {"min": f"{us} us", "max": f"{2 * us} us"}),
    st.integers(1, 400).map(lambda us: {"min": f"{us} us", "avg": f"{1.5 * us} us", "max": f"{2 * us} us"}),
    st.integers(1, 400).map(lambda us: {"on": {"generic": f"{us} us", "default": "1 us"}}),
)
LABELS = st.lists(st.sampled_from(["speed", "torque", "state"]), max_size=2, unique=True)
SIZES = st.integers(1, 64).map(lambda size: f"{size} B")


def section(**keys):
    return st.fixed_dictionaries(keys)


def optional(base, **keys):
    return st.fixed_dictionaries({}, optional=keys).flatmap(lambda more: base.map(lambda found: found | more))


CALLBACK = {"execution_time": TIMES, "reads": LABELS, "writes": LABELS}
PLACE = {
    "core": CORES,
    "runs_in": st.sampled_from(["own-task", "executor"]),
    "priority": st.integers(0, 20),
    "deadline": PERIODS,
    "overhead": st.sampled_from([0, "3 us", {"activation": {"min": "2 us", "max": "5 us"}, "termination": "1 us"}]),
}
SUBSCRIPTIONS = optional(section(topic=st.just("t"), interval=PERIODS, message_size=SIZES, **CALLBACK), **PLACE)
TIMERS = optional(section(period=PERIODS, **CALLBACK), publishes=st.just(["out"]), **PLACE)
SERVICES = optional(section(interval=PERIODS, request_size=SIZES, response_size=SIZES, **CALLBACK), **PLACE)
ACTIVATIONS = st.one_of(
    section(period=PERIODS),
    section(period=PERIODS, jitter=st.just("100 us"), offset=st.just("1 ms")),
    section(sporadic=PERIODS),
    section(burst=st.just({"period": "10 ms", "count": 3, "distance": "1 ms"})),
    section(times=st.just({"period": "10 ms", "at": ["0 ms", "3 ms"]})),
    section(once=PERIODS),
)
PROCESSES = ACTIVATIONS.flatmap(
    lambda activation: optional(
        section(execution_time=TIMES), reads=LABELS, writes=LABELS, core=CORES, locks=st.just(["bus"])
    ).map(lambda found: activation | found)
)


@st.composite
def applications(draw):
    """A description with unique names; everything else is random."""
    counter = iter(range(1000))

    def named(prefix, strategy, most=3):
        return [{"name": f"{prefix}_{next(counter)}"} | draw(strategy) for _ in range(draw(st.integers(0, most)))]

    node = {
        "name": "node",
        "publishers": [{"topic": "out", "message_size": "8 B"}],
        "subscriptions": named("Sub", SUBSCRIPTIONS),
        "timers": named("Timer", TIMERS),
        "services": named("Service", SERVICES, 1),
    }
    members = [item["name"] for kind in ("subscriptions", "timers") for item in node[kind]]
    description = {
        "amuros": 1,
        "name": "random",
        "hardware": {"platform": "generic", "cores": 2},
        "middleware": {
            "executor": draw(optional(section(execution_time=TIMES), callbacks=st.sampled_from(["own-task", "in-executor"]))),
            "transport": {"can": {"bitrate": "500 kbit/s", "interrupt": "2 us"}},
        },
        "application": {"nodes": [node]},
        "tasks": named("Task", PROCESSES),
        "isrs": named("Isr", PROCESSES, 1),
    }
    if len(members) >= 2:
        description["chains"] = [{"name": "chain", "path": draw(st.permutations(members))[:2], "reaction": "1 s"}]
        description["requirements"] = [{"process": members[0], "response_time": "10 ms"}]
    return description


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("random") / "app.yaml"


def built_or_refused(file):
    """The model, or the findings that prevent it."""
    try:
        return build(file), ()
    except ReadError as error:
        return None, error.findings


IMPORTER = list(registry.ids([RuleProfile.INCHRON]))

#: What a description can ask for, and the importer does not take over.
WISHES = {"INC-CO-KIND", "INC-LC-MAX", "INC-OS-ALGORITHM", "INC-OS-SEMA-TYPE", "INC-SW-PREEMPTION"}
WISHES |= {"INC-HW-ACCESS", "INC-SW-TICKS-BETA", "INC-SW-TICKS-DEFAULT", "INC-SW-TICKS-STAT"}


@given(description=applications())
@examples(16)
def test_a_random_application(file, description):
    file.write_text(yaml.safe_dump(description))
    built, findings = built_or_refused(file)
    assert all(finding.location and finding.location.line for finding in findings)
    if built is None:
        return
    found = [finding for finding in check(built.model, IMPORTER) if finding.severity is not Severity.INFO]
    assert [finding for finding in found if finding.severity is Severity.ERROR] == []
    assert {finding.rule for finding in found} <= WISHES
    assert validate(document_text(built.model.documents[0]).encode(), "3.3.0") == []


@pytest.mark.parametrize("seed", every(9, range(40)))
def test_damaged_descriptions(seed, file):
    chance = random.Random(seed)
    for sample in SAMPLES:
        text = sample.read_text()
        for _ in range(chance.randint(1, 4)):
            at = chance.randrange(len(text))
            text = (
                text[:at]
                + chance.choice(["", "{", "]", ": ", "\n", "  ", "-", "0", "ms", "&a", "*a", "'", "ö", "x"])
                + text[at + chance.randint(0, 6) :]
            )
        file.write_text(text)
        built, findings = built_or_refused(file)
        assert built or findings
