"""Programs as people write them: those of `combined.py`, whose facts follow from their parts, and those of `programs/` by hand."""

import re

import pytest
import yaml
from combined import PROGRAMS
from importing import filled, rules
from support import ROOT

from amalthea_uros.errors import ReadError
from amalthea_uros.services.build import describe
from amalthea_uros.services.import_code import import_code
from amalthea_uros.spec.read import read_description

FOLDER = ROOT / "tests" / "source" / "programs"
EXPECTED = yaml.safe_load((FOLDER / "expected.yaml").read_text())
#: Findings that say nothing about what is described.
OTHERS = {"IMP008", "IMP012", "IMP013", "IMP018", "IMP020"}


def errors_of(path):
    try:
        findings = describe(path).findings
    except ReadError as error:
        findings = error.findings
    return {each.rule for each in findings if each.severity == "error"}


def in_any_turn(items):
    """The order of a loop is what counts, not where a round begins."""
    return min(items[turn:] + items[:turn] for turn in range(len(items))) if items else items


def items_of(loop):
    """The items of a loop as it is written, in one form for all ways to write it; none of a gap."""
    items = [{key: value} for key, value in loop.items()] if isinstance(loop, dict) else loop or ()
    return [" ".join(f"{key} {value}" for key, value in each.items()) for each in items]


def loops_of(data):
    middleware = data["middleware"]
    executors = middleware.get("executors") or [middleware["executor"]]
    return [items_of(each["loop"]) for each in executors if "loop" in each]


def entities_of(description):
    nodes = description.application.nodes
    found = {
        kind: {(each.topic, each.message_size // 8, each.reliability) for node in nodes for each in getattr(node, kind)}
        for kind in ("publishers", "subscriptions")
    }
    found["timers"] = {(each.name, each.period // 10**9) for node in nodes for each in node.timers}
    found["services"] = {each.name for node in nodes for each in node.services}
    return found | ({"parameters": True} if any(node.parameter_server is not None for node in nodes) else {})


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.name)
def test_what_is_true_of_the_parts_of_a_program_is_in_its_description(program, tmp_path):
    for name, text in program.files.items():
        (tmp_path / name).write_text(text)
    result = import_code([tmp_path])
    (tmp_path / "app.yaml").write_text(filled(result.text))
    description = read_description(tmp_path / "app.yaml")
    assert entities_of(description) == program.entities
    assert (description.middleware.port, description.os.rtos or "") == (program.port, program.rtos)
    (loop,) = loops_of(yaml.safe_load(result.text))
    assert in_any_turn(loop) == in_any_turn(items_of(yaml.safe_load("\n".join(f"- {each}" for each in program.loop))))
    assert rules(result) <= OTHERS
    # What amuros writes, amuros reads.
    assert errors_of(tmp_path / "app.yaml") == set()


@pytest.mark.parametrize("name", EXPECTED)
def test_a_program_that_was_read_by_hand(name, tmp_path):
    result, expected = import_code([FOLDER / name]), EXPECTED[name]
    data = yaml.safe_load(result.text.replace("TODO", "null"))
    (node,) = data["application"]["nodes"]
    for kind, key in (("publishers", "topic"), ("subscriptions", "topic"), ("clients", "service")):
        assert [each[key] for each in node.get(kind, ())] == expected.get(kind, [])
    assert {each["name"]: each["period"] for each in node.get("timers", ())} == {
        timer: period and (f"{period} ms" if period < 1000 else f"{period // 1000} s")
        for timer, period in expected.get("timers", {}).items()
    }
    stated = [each["reliability"] for kind in ("publishers", "subscriptions") for each in node.get(kind, ())]
    assert stated == expected.get("reliabilities", stated)
    assert ("parameter_server" in node) == expected.get("parameters", False)
    assert data["middleware"].get("multithread", False) == expected.get("multithread", False)
    assert data["middleware"]["transport"] == expected.get("transport", data["middleware"]["transport"])
    loops = [in_any_turn(items_of(each)) for each in expected["loops"]]
    assert [in_any_turn(each) for each in loops_of(data)] == loops
    executors = data["middleware"].get("executors") or [data["middleware"]["executor"]]
    threads = [[each["name"], each["priority"], int(each["stack"].split()[0])] for each in executors if "stack" in each]
    assert threads == expected.get("threads", [])
    assert rules(result) - {"IMP008", "IMP018"} == set(expected.get("findings", ()))
    (tmp_path / "app.yaml").write_text(filled(result.text))
    assert errors_of(tmp_path / "app.yaml") == set(expected.get("errors", ()))


@pytest.mark.parametrize("name", ["parameters-on-humble.ino", "action-in-thread.c", "queues-to-topics.c", "endless-spin.c"])
def test_the_description_lacks_what_the_code_lacks(name, tmp_path):
    """Entities of actions and of parameter servers count in the pools, too."""
    result = import_code([FOLDER / name])
    (tmp_path / "app.yaml").write_text(filled(result.text))
    try:
        findings = describe(tmp_path / "app.yaml").findings
    except ReadError as error:
        findings = error.findings
    needed = r"RMW_UXRCE_MAX_(?:PUBLISHERS|SUBSCRIPTIONS|SERVICES|CLIENTS)"
    lacking = {re.search(needed, each.message) for each in result.findings if each.rule == "IMP007"}
    stated = {re.search(needed, each.message) for each in findings if each.rule == "UR120"}
    assert {each[0] for each in lacking} == {each[0] for each in stated if each is not None}


def test_there_are_programs_of_all_kinds():
    assert len(PROGRAMS) + len(EXPECTED) >= 90
    assert {path.name for path in FOLDER.iterdir()} == {*EXPECTED, "expected.yaml"}
