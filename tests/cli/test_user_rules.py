"""Rules that users make."""

import pytest
from command import amuros
from support import MODEL, ROOT

from amalthea_uros import check
from amalthea_uros.errors import ReadError
from amalthea_uros.validate import registry, user_rules
from amalthea_uros.validate.rule import RuleProfile
from amalthea_uros.validate.user_rules import rules_of_file
from amalthea_uros.xmi.load import load

SAMPLE = ROOT / "samples" / "naming_rules.py"


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format('<swModel><tasks name="Control"/><tasks name="Spin_Task"/></swModel>'))
    return path


@pytest.fixture
def clean(monkeypatch):
    """A registry to which nothing was added, also afterwards."""
    monkeypatch.setattr(registry, "_added", {})
    registry._installed.cache_clear()
    yield monkeypatch
    monkeypatch.undo()
    registry._installed.cache_clear()


def test_a_file_of_rules(model):
    run = amuros("check", model, "--rules", SAMPLE, "--profile", "emf", "--ignore", "EMF-*")
    assert "ACME-TASK-NAME warning: the name of the task 'Control' does not end with '_Task'" in run.stdout
    assert "  help: Rename the task.\n" in run.stdout
    assert run.stdout.endswith("1 finding: 1 warning\n")
    assert "ACME" in amuros("check", model, "--rules", SAMPLE, "--select", "ACME-*").stdout
    assert "ACME" not in amuros("check", model, "--rules", SAMPLE, "--ignore", "ACME-*").stdout
    assert "ACME" not in amuros("check", model).stdout


def test_the_rules_of_an_installed_package(clean, model, tmp_path):
    package = tmp_path / "site"
    package.mkdir()
    (package / "acme.py").write_text(SAMPLE.read_text())
    info = package / "acme-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[amuros.rules]\nall = acme\n")
    clean.syspath_prepend(str(package))
    assert list(registry.ids([RuleProfile.USER])) == ["ACME-TASK-NAME"]
    assert registry.profile_of("ACME-TASK-NAME") is RuleProfile.USER
    assert [finding.object for finding in check(load(model), ["ACME-TASK-NAME"])] == ["Control"]
    # One that cannot be loaded is named.
    (info / "entry_points.txt").write_text("[amuros.rules]\nall = acme:NOTHING\n")
    registry._installed.cache_clear()
    with pytest.raises(ReadError, match="RUL001 error: the rules of the package 'acme' cannot be loaded: AttributeError"):
        list(registry.ids())


RULES = SAMPLE.read_text()


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("def", ":1:4", "RUL001 error: the rules are not valid Python"),
        ("x = 1\nimport nothing_at_all\n", ":2:1", "ModuleNotFoundError: No module named 'nothing_at_all'"),
        ("def f():\n    raise SystemExit(0)\nf()\n", ":2:1", "SystemExit: 0"),
        ("x = 1\n", "", "there is no ModelRule"),
        ("RULES = [1]\n", "", "RULES must contain instances of ModelRule, not int"),
        (RULES.replace("    target=Task,\n", ""), ":16:1", "missing 1 required keyword-only argument: 'target'"),
        (RULES.replace("ACME-TASK-NAME", "UR101"), "", "the id 'UR101' is already used"),
        (RULES.replace("ACME-TASK-NAME", "XMI020"), "", "the id 'XMI020' is already used"),
        (RULES.replace("ACME-TASK-NAME", "tim-clock"), "", "the id 'tim-clock' is already used"),
        (RULES.replace("ACME-TASK-NAME", "a, b"), "", "'a, b' cannot be the id of a rule"),
    ],
)
def test_a_file_that_is_broken(text, place, message, model, tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(text)
    run = amuros("check", model, "--rules", path)
    assert run.returncode == 2
    assert message in run.stderr
    assert not place or run.stderr.startswith(f"{path}{place}: RUL001 error")
    assert "Traceback" not in run.stderr


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ReadError, match="RUL001 error: file not found"):
        rules_of_file(tmp_path / "none.py")


def test_the_same_rule_twice(model):
    run = amuros("check", model, "--rules", SAMPLE, "--rules", SAMPLE)
    assert run.returncode == 2
    assert "RUL002 error: the id 'ACME-TASK-NAME' is already used" in run.stderr


@pytest.mark.parametrize("function", ["check", "among"])
def test_a_rule_that_fails(function, clean, model, tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(RULES.replace("    check=_check,\n", "    check=lambda *_: 1 / 0,\n    among=None,\n"))
    if function == "among":
        path.write_text(path.read_text().replace("among=None", "among=lambda _: 1 / 0"))
    registry.add(rules_of_file(path))
    findings = check(load(model), ["ACME-TASK-NAME"])
    assert {finding.rule for finding in findings} == {"CHK001"}
    assert "ZeroDivisionError: division by zero (mine.py:" in findings[0].message


def test_settings_bring_no_rules(model):
    (model.parent / "amuros.toml").write_text('[check]\nrules = ["mine.py"]\n')
    assert "unknown setting 'rules'" in amuros("check", model).stderr


def test_the_group_of_entry_points_is_the_documented_one():
    assert f"`{user_rules.GROUP}`" in (ROOT / "docs" / "check.md").read_text()
