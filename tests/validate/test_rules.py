"""Every rule, by its own examples."""

import subprocess
import sys
from importlib import import_module

import pytest
from excerpts import model
from support import ROOT, model_text

from amalthea_uros import check, check_files, load
from amalthea_uros.findings.kind import ids_in
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import run
from amalthea_uros.validate.rule import CHECKS, ModelCheck, RuleProfile

IDS = list(registry.ids())


@pytest.mark.parametrize("identifier", IDS)
def test_a_rule(identifier, tmp_path):
    rule = registry.kind(identifier)
    assert rule.id == identifier
    assert rule.title[0].islower()
    assert rule.title[-1] != "."
    assert rule.rationale.endswith(".")
    assert rule.remedy.endswith(".")
    findings = found_in(rule, rule.fails, tmp_path)
    assert findings
    for finding in findings:
        assert (finding.rule, finding.severity) == (rule.id, rule.severity)
    assert not found_in(rule, rule.passes, tmp_path)


def found_in(rule, example, folder):
    """What a rule finds in one of its examples."""
    profile = registry.profile_of(rule.id)
    if profile is RuleProfile.MICRO_ROS:
        path = folder / "app.yaml"
        path.write_text(example)
        return [finding for finding in told_of(path) if finding.rule == rule.id]
    if profile is RuleProfile.SCHEMA:
        path = folder / "model.amxmi"
        path.write_text(example)
        return check(load(path), [rule.id])
    version = rule.example_version if example == rule.fails else "3.3.0"
    (folder / "model.amxmi").write_text(model_text(example, version))
    if rule.beside is not None:
        (folder / "beside.amxmi").write_text(model_text(rule.beside))
    read = load(folder)
    check_of_rule = registry.check(rule.id)
    if not (isinstance(check_of_rule, ModelCheck) and check_of_rule.is_about_files):
        # The examples are models of which everything is understood.
        assert not read.findings
    findings = check(read, [rule.id])
    assert all(finding.help == rule.remedy and finding.location.line for finding in findings)
    return findings


def told_of(path):
    """The findings about a description, whether it becomes a system or not."""
    return check_files(path).findings


def test_ids_are_unique():
    assert len(IDS) == len(set(IDS))


FOLDER = ROOT / "amalthea_uros" / "validate" / "rules"


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*/*.yaml")), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_the_checks_of_a_module_are_those_of_the_texts_beside_it(path):
    module = f"amalthea_uros.validate.rules.{path.parent.name}.{path.stem}"
    import_module(module)
    assert {identifier for identifier, check in CHECKS.items() if check.check.__module__ == module} == set(ids_in(path))


def test_a_circle_of_calls_is_told_from_each_of_its_runnables(tmp_path):
    def calls(name, *called):
        items = "".join(f'<items t="RunnableCall" runnable="{other}?type=Runnable"/>' for other in called)
        return f'<runnables name="{name}"><activityGraph>{items}</activityGraph></runnables>'

    excerpt = f"<swModel>{calls('A', 'D', 'B')}{calls('B', 'C')}{calls('C', 'A')}{calls('D')}</swModel>"
    found = check(model(excerpt, tmp_path), ["TIM-RECURSION"])
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

    rule = replace(registry.check("INC-SW-LABELSIZE"), check=broken)
    (finding,) = run(model('<swModel><labels name="L"/></swModel>', tmp_path), [rule])
    assert finding.rule == "CHK001"
    assert "INC-SW-LABELSIZE failed" in finding.message
    assert finding.object == "L"


def test_no_more_findings_of_a_rule_are_kept_than_fit_into_memory(tmp_path, monkeypatch):
    monkeypatch.setattr("amalthea_uros.validate.engine.RULE_FINDINGS", 2)
    rule = registry.check("INC-SW-LABELSIZE")
    for number, rules in ((2, 2 * [rule.id]), (3, [rule.id, rule.id, "CHK002"])):
        labels = "".join(f'<labels name="L{index}"/>' for index in range(number))
        found = run(model(f"<swModel>{labels}</swModel>", tmp_path), [rule])
        assert [finding.rule for finding in found] == rules
    assert found[-1].message == "the rule INC-SW-LABELSIZE has more than 2 findings; it is not checked further"
    assert found[-1].severity is found[0].severity


def test_only_what_is_selected_is_imported():
    code = (
        "import sys; from amalthea_uros.cli.main import cli\n"
        f"try: cli(['check', {str(ROOT / 'samples' / 'executor.amxmi')!r}, '--select', 'INC-OS-ALGORITHM', '--output', 'sarif'])\n"
        "except SystemExit: print([m for m in sys.modules if '.validate.rules.' in m and m.count('.') > 3], file=sys.stderr)"
    )
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "INC-OS-ALGORITHM" in process.stdout
    assert process.stderr.strip() == "['amalthea_uros.validate.rules.inchron.scheduling']"
