"""Selecting and naming rules, exit codes and comments: the same in all commands."""

import json
import sys
from importlib.metadata import metadata
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest
from support import MODEL, ROOT

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros.cli.main import main
from amalthea_uros.validate import registry

ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"
TWO_TASKS = MODEL.format('<swModel><tasks name="A"/><tasks name="B"/></swModel>')


@pytest.fixture
def amuros(monkeypatch, capsys):
    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["amuros", *map(str, arguments)])
        with pytest.raises(SystemExit) as end:
            main()
        shown = capsys.readouterr()
        return SimpleNamespace(code=end.value.code or 0, stdout=shown.out, stderr=shown.err)

    return run


@pytest.fixture
def two_tasks(tmp_path):
    path = tmp_path / "two.amxmi"
    path.write_text(TWO_TASKS)
    return path


def rules_in(run):
    return {finding["rule"] for finding in json.loads(run.stdout)["findings"]}


def test_the_first_letters_of_ids_select_rules(amuros, two_tasks):
    everything = rules_in(amuros("check", two_tasks, "--output", "json"))
    timing = {rule for rule in everything if rule.startswith("TIM")}
    assert timing
    assert rules_in(amuros("check", two_tasks, "--output", "json", "--select", "TIM")) == timing
    assert rules_in(amuros("check", two_tasks, "--output", "json", "--ignore", "TIM")) == everything - timing


def test_files_of_other_programs_are_not_named_among_those_that_are_not_repaired(amuros, tmp_path, two_tasks):
    other = tmp_path / "compose.yaml"
    other.write_text("services: {}\n")
    run = amuros("check", "--fix", "--only-amuros", other, two_tasks)
    assert "compose.yaml" not in run.stdout + run.stderr
    assert "compose.yaml: a description is not repaired" in amuros("check", "--fix", other, two_tasks).stderr


@pytest.mark.parametrize(
    "arguments", [["-", "--rules", "-"], ["-", "--baseline", "-"], [ADVANCED, "--rules", "-", "--baseline", "-"], ["-", "-"]]
)
def test_standard_input_is_one_file(amuros, arguments):
    run = amuros("check", *arguments)
    assert run.code == 2
    assert "standard input can be only one of the files" in run.stderr


@pytest.mark.parametrize("command", ["analyze", "build", "info", "simulate"])
def test_a_description_with_errors_gives_no_result_and_a_line_that_says_so(amuros, tmp_path, command):
    path, result = tmp_path / "app.yaml", tmp_path / "result.json"
    path.write_text("amuros: 1\nname: app\nhardware: {platform: single-core, frequenzy: 1 MHz}\napplication: {nodes: []}\n")
    run = amuros(command, path, "--output", f"json={result}")
    assert run.code == 1
    assert run.stderr.splitlines()[-1] == "2 findings: 2 errors; no result is written"
    assert not result.exists()


def test_an_id_is_not_the_beginning_of_another_one(amuros):
    run = amuros("rules", "TIM-PRIORITY", "--output", "json")
    assert [rule["id"] for rule in json.loads(run.stdout)["rules"]] == ["TIM-PRIORITY"]


def test_findings_that_no_rule_reports_can_be_ignored(amuros, tmp_path):
    path = tmp_path / "odd.amxmi"
    path.write_text(MODEL.format('<swModel what="?"/>'))
    assert "XMI011" in rules_in(amuros("check", path, "--profile", "timing", "--output", "json"))
    assert "XMI011" not in rules_in(amuros("check", path, "--profile", "timing", "--output", "json", "--ignore", "XMI01"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["check", ADVANCED, "--select", "tim"], "unknown rule 'tim'; did you mean 'TIM'?"),
        (["check", ADVANCED, "--select", "INC-HWW"], "unknown rule 'INC-HWW'; did you mean 'INC-HW'"),
        (["check", ADVANCED, "--ignore", "TIMM"], "unknown rule 'TIMM'; did you mean 'TIM'?"),
        (["check", ADVANCED, "--ignore", ""], "unknown rule ''"),
        (["check", ADVANCED, "--selct", "TIM"], "--select"),
        (["chek", ADVANCED], "No such command 'chek'; did you mean 'check'"),
        (["explain", "TIM-WIAT"], "unknown rule or finding 'TIM-WIAT'; did you mean 'TIM-WAIT'"),
        (["explain", "xmi0200"], "did you mean 'XMI020'"),
        (["rules", "TIMX"], "unknown rule 'TIMX'; did you mean 'TIM'?"),
        (["rules", "--profile", "timin"], "'timin' is not one of schema, emf,"),
        (["chains", ADVANCED, "--from", "Message_Facto", "--to", "output"], "did you mean 'Message_Factor'"),
        (["chains", ADVANCED, "--from", "Executor_Task", "--to", "outputs"], "label 'outputs'; did you mean 'output'?"),
        (["analyze", ADVANCED, "--chain", "factor-to-outptu"], "did you mean 'factor-to-output'?"),
    ],
)
def test_what_was_meant_is_suggested(amuros, arguments, message):
    run = amuros(*arguments)
    assert run.code == 2
    assert message in run.stderr


def test_rules_are_filtered(amuros):
    def listed(*arguments):
        return {rule["id"]: rule for rule in json.loads(amuros("rules", *arguments, "--output", "json").stdout)["rules"]}

    assert list(listed()) == list(registry.ids())
    errors = listed("--profile", "timing,app4mc", "--severity", "error")
    assert {rule["severity"] for rule in errors.values()} == {"error"}
    assert {rule["profile"] for rule in errors.values()} == {"timing", "app4mc"}
    assert "TIM-OVERLOAD" in errors
    # What is searched for may be in any sentence of a rule, in any case.
    assert "TIM-RECURSION" in listed("TIM", "--search", "RECURSIVE")
    assert "TIM-CLOCK" not in listed("TIM", "--search", "RECURSIVE")
    assert amuros("rules", "--search", "no such words").stdout == "no rules\n"


@pytest.mark.parametrize(
    "command", [["build"], ["check"], ["analyze"], ["simulate"], ["info"], ["chains", "--from", "a", "--to", "b"]]
)
@pytest.mark.parametrize(("text", "code"), [("a: [", 2), ("amuros: 1\nname: x\napplication: {nodes: []}\n", 1)])
def test_exit_codes_tell_mistakes_from_unreadable_files(amuros, tmp_path, command, text, code):
    path = tmp_path / "app.yaml"
    path.write_text(text)
    run = amuros(*command, path)
    assert run.code == code
    assert "YML0" in run.stdout + run.stderr
    assert not path.with_suffix(".amxmi").exists()


def test_the_model_of_a_description_is_shown_and_compared(amuros):
    run = amuros("info", ADVANCED)
    assert run.code == 0
    assert run.stdout.startswith(f"{ADVANCED}: AMALTHEA 3.3.0, 90 objects, built in memory\n")
    assert amuros("diff", ADVANCED, ADVANCED.with_suffix(".amxmi")).stdout == "no differences in meaning\n"


@pytest.mark.parametrize("arguments", [["fmt"], ["migrate"], ["analyze", ADVANCED.with_suffix(".amxmi")]])
def test_where_only_models_are_taken_a_description_has_to_be_built_first(amuros, tmp_path, arguments):
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.read_text())
    run = amuros(*arguments, path)
    assert run.code == 2
    assert f"build it first: amuros build {path} -o {path.with_suffix('.amxmi')}" in run.stderr


def test_a_comment_accepts_a_finding_in_all_commands(amuros, tmp_path):
    # Two tasks of a core with the same priority: a warning at the second one.
    path = tmp_path / "app.yaml"
    text = ADVANCED.read_text()
    for name in ("name: Message_Factor,", "name: Control_Function,"):
        text = text.replace(name, f"{name} priority: 2,")
    path.write_text(text)
    commands = (
        ["build", "-o", tmp_path / "app.amxmi"],
        ["analyze"],
        ["simulate", "--duration", "10ms"],
        ["chains", "--from", "Message_Factor", "--to", "Control_Function"],
    )
    assert all("UR106 warning" in amuros(*command, path).stderr for command in commands)
    lines = text.splitlines()
    path.write_text("\n".join(f"{line} # amuros: ignore[UR106]" if "priority: 2" in line else line for line in lines) + "\n")
    assert all("UR106" not in amuros(*command, path).stderr for command in commands)


def test_yaml_files_of_other_programs_are_skipped_on_request(amuros, tmp_path):
    other, quoted = tmp_path / "compose.yaml", tmp_path / "quoted.yaml"
    other.write_text("services:\n  amuros: 1\n# amuros: 1\n")
    quoted.write_text("# a comment\nname: x\n'amuros': 1\n")
    run = amuros("check", "--only-amuros", other)
    assert (run.code, run.stdout, run.stderr) == (0, "no findings\n", "")
    assert amuros("check", other).code == 1
    # Other keys, comments and quotes in front of the key make no difference, and files that do not exist are not skipped.
    assert amuros("check", "--each", "--only-amuros", other, quoted).code == 1
    assert amuros("check", "--only-amuros", tmp_path / "none.yaml").code == 2


def test_junit_has_a_case_for_each_rule_that_was_checked(amuros, two_tasks, tmp_path):
    run = amuros("check", two_tasks, "--select", "TIM", "--output", "junit")
    suite = ElementTree.fromstring(run.stdout).find("testsuite")
    cases = {case.get("name"): case for case in suite}
    assert list(cases) == [rule for rule in registry.ids() if rule.startswith("TIM")]
    assert cases["TIM-CLOCK"].find("failure") is None
    assert cases["TIM-STIMULUS"].find("failure").attrib == {"message": "2 findings", "type": "warning"}
    assert (suite.get("tests"), suite.get("failures")) == (str(len(cases)), str(len(suite.findall("testcase/failure"))))
    # No rule was checked in a file that cannot be read.
    run = amuros("check", tmp_path / "none.amxmi", "--output", "junit")
    assert [case.get("name") for case in ElementTree.fromstring(run.stdout).iter("testcase")] == ["XMI001"]


def test_sarif_links_rules_to_the_documentation_that_the_package_states(amuros, two_tasks):
    run = json.loads(amuros("check", two_tasks, "--select", "TIM-STIMULUS", "--output", "sarif").stdout)["runs"][0]
    assert f"Documentation, {DOCUMENTATION}" in (metadata("amuros").get_all("Project-URL") or [])
    (rule,) = run["tool"]["driver"]["rules"]
    assert rule["helpUri"] == f"{DOCUMENTATION}/rules/TIM-STIMULUS/"


ITEA = "http://www.amalthea.itea2.org/model/1.3.0/sw"
APP4MC = "http://app4mc.eclipse.org/amalthea/"


@pytest.mark.parametrize("namespace", [ITEA, f"{APP4MC}0.7.0", f"{APP4MC}0.7.1", f"{APP4MC}0.7.2"])
def test_a_file_with_a_sub_model_as_its_root_is_a_model(amuros, tmp_path, namespace):
    path = tmp_path / "sw.amxmi"
    start = f'<sw:SWModel xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:sw="{namespace}">'
    path.write_text(f'{start}<tasks name="Control"/></sw:SWModel>')
    assert "  Control  task" in amuros("info", path).stdout
    assert "TIM-STIMULUS warning: " in amuros("check", path, "--select", "TIM").stdout
    assert "  Control  unknown" in amuros("analyze", path).stdout
    assert amuros("migrate", path, "-o", tmp_path / "new.amxmi").code == 0
    assert '<tasks xmi:id="Control?type=Task"' in (tmp_path / "new.amxmi").read_text()


@pytest.mark.parametrize("version", ["0.8.1", "0.9.5"])
def test_later_versions_have_no_sub_models_as_roots(amuros, tmp_path, version):
    path = tmp_path / "sw.amxmi"
    path.write_text(f'<am:SWModel xmlns:am="{APP4MC}{version}"/>')
    run = amuros("info", path)
    assert run.code == 2
    assert "help: Only models are migrated, whose root is AMALTHEA or Amalthea; up to 0.7.2 also sub-models" in run.stderr
