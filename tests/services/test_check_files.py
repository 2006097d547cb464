"""The library gives the findings of the command line."""

import json
import shutil
import subprocess
import sys

import pytest
from support import MODEL, ROOT

import amalthea_uros as amuros
from amalthea_uros.findings.accepted import fingerprint
from amalthea_uros.findings.grouping import FindingGroup
from amalthea_uros.findings.presentation import Presentation
from amalthea_uros.services.check import write_baseline

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"


@pytest.fixture
def project(tmp_path):
    """A project with settings, a suppressing comment and a description."""
    (tmp_path / "amuros.toml").write_text('[check]\nprofile = ["inchron", "timing", "ta"]\nfail-on = "info"\n')
    return shutil.copy(ADVANCED, tmp_path / "app.yaml")


def rules(result):
    return [finding.rule for finding in result.findings]


def test_the_settings_of_the_project_count(project):
    result = amuros.check_files(project)
    command = [sys.executable, "-m", "amalthea_uros", "check", project, "--output", "json"]
    told = json.loads(subprocess.run(command, capture_output=True, check=False).stdout)["findings"]
    assert rules(result) == [finding["rule"] for finding in told] != []
    assert result.fails
    # What the caller gives replaces them.
    assert not amuros.check_files(project, amuros.CheckSettings(fail_on=amuros.Severity.ERROR)).fails
    assert rules(amuros.check_files(project, amuros.CheckSettings(select=["INC-CO-*"]))) == ["INC-CO-KIND"]


def finding(rule, severity, name):
    return amuros.Finding(rule, severity, f"the object {name!r}", None, "", name)


def test_a_baseline_has_what_is_shown():
    first, repeated = finding("AM-1", amuros.Severity.WARNING, "a"), finding("XMI011", amuros.Severity.INFO, "a")
    effect, worse = finding("TIM-1", amuros.Severity.WARNING, "b"), finding("TIM-2", amuros.Severity.ERROR, "b")
    shown = Presentation([FindingGroup((first, repeated), (effect, worse))], {})
    # What is more severe than the flaw it follows from is accepted by itself, or shown.
    assert shown.to_accept == [first, worse]
    assert shown.accepted({fingerprint(first)}) == {first, repeated, effect}
    assert shown.accepted({fingerprint(effect)}) == set()


def test_a_baseline_accepts_findings(project, tmp_path):
    before = amuros.check_files(project)
    write_baseline(before, tmp_path / "accepted.json")
    assert amuros.check_files(project, amuros.CheckSettings(baseline=tmp_path / "accepted.json")).findings == ()
    with pytest.raises(ValueError, match="is not a baseline"):
        amuros.check_files(project, amuros.CheckSettings(baseline=project))
    with pytest.raises(ValueError, match=r"missing[.]json: file not found[.] Check the path[.]"):
        amuros.check_files(project, amuros.CheckSettings(baseline=tmp_path / "missing.json"))


def test_a_comment_suppresses_a_finding_of_a_model(tmp_path):
    path = tmp_path / "model.amxmi"
    comment = "<!-- amuros: ignore[INC-SW-LABELSIZE] -->"
    path.write_text(MODEL.format(f'<swModel>\n<labels name="A"/>\n<labels name="B"/>{comment}\n</swModel>'))
    assert [finding.object for finding in amuros.check(amuros.load(path), ["INC-SW-LABELSIZE"])] == ["A"]


def test_a_suppressed_finding_does_not_come_back_in_general_terms(tmp_path):
    path = tmp_path / "model.amxmi"
    comment = "<!-- amuros: ignore[INC-IO-REF, AM-EMF-INTRINSIC/proxy-resolves] -->"
    path.write_text(MODEL.format(f'<swModel>\n<tasks name="T" stimuli="S?type=SingleStimulus"/>{comment}\n</swModel>'))
    found = rules(amuros.check_files(path))
    assert not {"XMI020", "INC-IO-REF", "AM-EMF-INTRINSIC/proxy-resolves"} & set(found)


def test_a_file_that_cannot_be_read_is_a_finding(tmp_path):
    result = amuros.check_files([tmp_path / "none.amxmi", ADVANCED], each=True)
    assert not result.is_readable
    assert {"XMI001", "INC-CO-KIND"} <= set(rules(result))
