"""Findings for CI systems: what they make of them."""

import json

import jsonschema
import pytest
from command import amuros
from junitparser import JUnitXml
from support import DATA, MODEL

from amalthea_uros.validate.rule import RuleProfile

SCHEMA = json.loads((DATA / "sarif-2.1.0-part.schema.json").read_text())


@pytest.fixture
def model(tmp_path):
    """A model with findings of all severities, and one that is no object's; with odd characters in its names."""
    path = tmp_path / "my models" / "brems & co.amxmi"
    path.parent.mkdir()
    text = '<swModel><tasks name="Bremse „vorn“" what="?"/><labels name="L"/></swModel>'
    path.write_text(MODEL.format(text), encoding="utf-8")
    return path


#: Findings of all severities count only where the importer is asked for.
ALL = ("--profile", ",".join(RuleProfile))


def found(model):
    return json.loads(amuros("check", model, *ALL, "--output", "json", cwd=model.parent.parent).stdout)


def test_sarif_is_valid(model):
    run = amuros("check", model, *ALL, "--output", "sarif", cwd=model.parent.parent)
    log = json.loads(run.stdout)
    jsonschema.Draft7Validator(SCHEMA, format_checker=jsonschema.FormatChecker()).validate(log)
    (part,) = log["runs"]
    rules = part["tool"]["driver"]["rules"]
    assert {result["level"] for result in part["results"]} == {"error", "warning", "note"}
    shown = [finding for finding in found(model)["findings"] if finding["part_of"] is None]
    assert [result["ruleId"] for result in part["results"]] == [finding["rule"] for finding in shown]
    for result in part["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
        place = result["locations"][0]["physicalLocation"]["artifactLocation"]
        assert place == {"uri": "my%20models/brems%20%26%20co.amxmi", "uriBaseId": "SRCROOT"}
        assert place["uriBaseId"] in part["originalUriBaseIds"]
    fingerprints = [result["partialFingerprints"]["object/v1"] for result in part["results"]]
    assert len(set(fingerprints)) == len(fingerprints)


def test_with_details_there_are_all_findings(model):
    run = amuros("check", model, *ALL, "--details", "--output", "sarif", cwd=model.parent.parent)
    assert len(json.loads(run.stdout)["runs"][0]["results"]) == len(found(model)["findings"])


def test_junit_has_what_the_text_shows(model, tmp_path):
    path = tmp_path / "result.xml"
    amuros("check", model, *ALL, "--output", f"junit={path}")
    (suite,) = JUnitXml.fromfile(str(path))
    shown = {finding["rule"] for finding in found(model)["findings"] if finding["part_of"] is None}
    assert {case.name for case in suite if case.result or case.system_out} == shown


def test_a_file_outside_of_the_current_folder_has_an_absolute_uri(model, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    log = json.loads(amuros("check", model, *ALL, "--output", "sarif", cwd=other).stdout)
    jsonschema.Draft7Validator(SCHEMA, format_checker=jsonschema.FormatChecker()).validate(log)
    places = [result["locations"][0]["physicalLocation"]["artifactLocation"] for result in log["runs"][0]["results"]]
    assert {place["uri"] for place in places} == {model.as_uri()}


def test_junit_is_read_as_ci_systems_do(model, tmp_path):
    path = tmp_path / "result.xml"
    amuros("check", model, *ALL, "--details", "--output", f"junit={path}")
    findings = found(model)["findings"]
    (suite,) = JUnitXml.fromfile(str(path))
    cases = {case.name: case for case in suite}
    # The rules that found nothing have a case, too.
    assert cases.keys() > {finding["rule"] for finding in findings}
    failing = {finding["rule"] for finding in findings if finding["severity"] != "info"}
    assert {name for name, case in cases.items() if case.result} == failing
    hints = {finding["rule"] for finding in findings} - failing
    assert hints
    assert all("info: " in cases[name].system_out for name in hints)
    assert (suite.tests, suite.failures, suite.errors) == (len(cases), len(failing), 0)
    task = next(finding for finding in findings if finding["rule"] == "INC-ST-NONE")
    assert task["message"] in cases["INC-ST-NONE"].result[0].text


def test_junit_of_a_model_without_findings(tmp_path):
    path = tmp_path / "result.xml"
    amuros("check", DATA / "brake.amxmi", "--select", "INC-EC-CYCLE", "--output", f"junit={path}")
    (suite,) = JUnitXml.fromfile(str(path))
    assert [(case.name, case.result) for case in suite] == [("INC-EC-CYCLE", [])]
    assert (suite.tests, suite.failures) == (1, 0)


def test_annotations_escape_what_has_a_meaning(tmp_path):
    path = tmp_path / "a,b:c.amxmi"
    path.write_text(MODEL.format('<swModel><tasks name="100%"/></swModel>'))
    run = amuros("check", path, "--select", "INC-ST-NONE", "--output", "github", cwd=tmp_path)
    assert run.stdout.startswith("::warning file=a%2Cb%3Ac.amxmi,line=")
    assert "'100%25'" in run.stdout


@pytest.mark.parametrize("format_name", ["text", "sarif", "github", "json", "junit"])
def test_a_circle_of_links_is_a_finding(format_name, tmp_path):
    path = tmp_path / "loop.amxmi"
    path.symlink_to(path)
    run = amuros("check", path, "--output", format_name)
    assert (run.returncode, run.stderr.count("Traceback")) == (2, 0)
    assert "the file cannot be read: Too many levels of symbolic links" in run.stdout + run.stderr
