"""Every rule, by its own examples and, for INCHRON's importer, against the reference table of constraints."""

import subprocess
import sys

import inchron
import pytest
from support import ROOT, SHARED

from amalthea_uros import load
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import check
from amalthea_uros.validate.rule import Profile

IDS = list(registry.ids())
MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">{}</am:Amalthea>
"""


def model(excerpt, folder, version="3.3.0"):
    path = folder / "model.amxmi"
    path.write_text(MODEL.format(excerpt).replace("3.3.0", version))
    return load(path)


@pytest.mark.parametrize("identifier", IDS)
def test_a_rule(identifier, tmp_path):
    rule = registry.rule(identifier)
    assert rule.id == identifier
    assert rule.title[0].islower()
    assert rule.title[-1] != "."
    assert rule.rationale.endswith(".")
    assert rule.remedy.endswith(".")
    assert isinstance(rule.profile, Profile)
    failing = model(rule.fails, tmp_path, rule.example_version)
    passing = model(rule.passes, tmp_path)
    # The examples are models of which everything is understood.
    assert not failing.findings
    assert not passing.findings
    findings = check(failing, [rule])
    assert findings
    for finding in findings:
        assert (finding.rule, finding.severity, finding.help) == (rule.id, rule.severity, rule.remedy)
        assert finding.location.line
    assert not check(passing, [rule])


def test_ids_are_unique():
    assert len(IDS) == len(set(IDS))


def found_by_rules(model):
    rules = [registry.rule(identifier) for identifier in registry.ids([Profile.INCHRON])]
    # What reading already tells is not told again.
    return {(finding.rule, "E" if finding.severity is Severity.ERROR else "W") for finding in check(model, rules)}


PATHS = [*sorted((ROOT / "samples").glob("*.amxmi")), *sorted((SHARED / "vectors" / "am2inc").glob("*.amxmi"))]


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
def test_the_reference_table_of_the_importer(path):
    try:
        read = load(path)
    except ReadError:
        pytest.skip("the file cannot be read")
    known = set(registry.ids([Profile.INCHRON]))
    expected = {(rule, severity) for rule, severity, _ in inchron.problems(read) if rule in known}
    assert found_by_rules(read) == expected


def test_a_circle_of_calls_is_told_from_each_of_its_runnables(tmp_path):
    def calls(name, *called):
        items = "".join(f'<items xsi:type="am:RunnableCall" runnable="{other}?type=Runnable"/>' for other in called)
        return f'<runnables name="{name}"><activityGraph>{items}</activityGraph></runnables>'

    excerpt = f"<swModel>{calls('A', 'D', 'B')}{calls('B', 'C')}{calls('C', 'A')}{calls('D')}</swModel>"
    found = check(model(excerpt, tmp_path), [registry.rule("TIM-RECURSION")])
    assert [finding.message for finding in found] == [
        "'A' calls itself: A -> B -> C -> A",
        "'B' calls itself: B -> C -> A -> B",
        "'C' calls itself: C -> A -> B -> C",
    ]


def test_a_rule_that_fails_is_a_finding(tmp_path):
    from dataclasses import replace

    def broken(element, context):
        raise RuntimeError("oh")
        yield

    rule = replace(registry.rule("INC-SW-LABELSIZE"), check=broken)
    (finding,) = check(model('<swModel><labels name="L"/></swModel>', tmp_path), [rule])
    assert finding.rule == "CHK001"
    assert "INC-SW-LABELSIZE failed" in finding.message
    assert finding.object == "L"


def test_only_what_is_selected_is_imported():
    code = (
        "import sys; from amalthea_uros.validate import registry; list(registry.ids()); registry.rule('INC-HW-PU-CLOCK'); "
        "print([name for name in sys.modules if '.rules.inchron.' in name])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "['amalthea_uros.validate.rules.inchron.inc_hw_pu_clock']"
