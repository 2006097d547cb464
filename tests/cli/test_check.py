"""`amuros check` as its user sees it."""

import json
import re
from xml.etree import ElementTree

import pytest
import yaml
from command import amuros
from support import MODEL, ROOT

INCHRON = ("--profile", "inchron")
ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"


@pytest.fixture
def bad(tmp_path):
    """A model with a core without a clock, and a label without a size."""
    text = ADVANCED.with_suffix(".amxmi").read_text()
    start = text.index(" frequencyDomain=")
    end = text.index('"', start + len(" frequencyDomain=") + 1) + 1
    path = tmp_path / "bad.amxmi"
    path.write_text(text[:start] + text[end:])
    return path


def test_findings_point_into_the_description():
    run = amuros("check", ADVANCED, *INCHRON)
    assert run.returncode == 0
    line = next(number for number, text in enumerate(ADVANCED.read_text().splitlines(), 1) if "response_time: 1 ms" in text)
    assert f"bodas-test-advanced.yaml:{line}:" in run.stdout
    assert "INC-CO-KIND warning" in run.stdout


def test_severities_decide_about_the_exit_code(bad):
    assert amuros("check", ADVANCED, *INCHRON, "--fail-on", "warning").returncode == 1
    run = amuros("check", bad, *INCHRON)
    assert run.returncode == 1
    assert "INC-HW-PU-CLOCK error (fails): the processing unit 'Core_0' has no frequency domain" in run.stdout
    assert "help: Give the processing unit a frequency domain." in run.stdout


def test_select_and_ignore(bad):
    run = amuros("check", bad, "--select", "INC-CO-*")
    assert (run.returncode, run.stdout.count("INC-")) == (0, 1)
    run = amuros("check", bad, "--ignore", "INC-*", "--ignore", "TIM-*,TA-*")
    assert (run.returncode, run.stdout) == (0, "no findings\n")
    assert "unknown rule 'INC-NOTHING'" in amuros("check", bad, "--select", "INC-NOTHING").stderr


def test_several_outputs_in_one_run(bad, tmp_path):
    names = {kind: tmp_path / kind for kind in ("json", "sarif", "junit", "github")}
    run = amuros("check", bad, *INCHRON, *(part for kind, path in names.items() for part in ("--output", f"{kind}={path}")))
    assert (run.returncode, run.stdout) == (1, "")
    findings = json.loads(names["json"].read_text())["findings"]
    (sarif,) = json.loads(names["sarif"].read_text())["runs"]
    failures = ElementTree.parse(names["junit"]).findall(".//failure")
    assert "INC-HW-PU-CLOCK" in {finding["rule"] for finding in findings}
    assert len(sarif["results"]) == len(names["github"].read_text().splitlines()) == len(findings)
    assert len(failures) == len({finding["rule"] for finding in findings if finding["severity"] != "info"})


def test_the_schema_of_the_version(tmp_path):
    path = tmp_path / "odd.amxmi"
    path.write_text(ADVANCED.with_suffix(".amxmi").read_text().replace('unit="ms"', 'unit="hours"', 1))
    for arguments in ([], ["--profile", "schema"]):
        run = amuros("check", path, *arguments)
        assert run.returncode == 1
        assert "XSD001 error" in run.stdout
    assert "XSD001" not in amuros("check", path, "--profile", "timing").stdout
    assert "INC-" not in amuros("check", path, "--profile", "schema").stdout


def test_statistics(bad):
    run = amuros("check", bad, *INCHRON, "--statistics")
    assert "INC-HW-PU-CLOCK" in run.stdout
    assert "help:" not in run.stdout


def test_rules_are_explained_and_listed():
    run = amuros("explain", "inc-hw-pu-clock")
    assert run.stdout.startswith("INC-HW-PU-CLOCK: processing unit without a clock (error, profile inchron)")
    assert "segmentation fault" in run.stdout
    assert "unknown rule or finding 'X'" in amuros("explain", "X").stderr
    # Findings that no rule reports are explained, too.
    assert amuros("explain", "xmi020").stdout.startswith("XMI020: unresolved reference (warning)\n\nThe referenced object")
    assert "INC-EC-CYCLE" in amuros("rules").stdout


def test_files_that_cannot_be_read(tmp_path):
    missing, empty = tmp_path / "none.amxmi", tmp_path / "app.yaml"
    empty.write_text("a: [")
    for path, rule in ((missing, "XMI001"), (empty, "YML001")):
        run = amuros("check", path, "--output", "json")
        assert run.returncode == 2
        assert [finding["rule"] for finding in json.loads(run.stdout)["findings"]] == [rule]
    # What can be read is checked all the same.
    run = amuros("check", "--each", missing, ADVANCED, *INCHRON)
    assert run.returncode == 2
    assert "INC-CO-KIND" in run.stdout


def test_a_description_that_becomes_no_system_is_told_to_all_outputs(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(ADVANCED.read_text().replace("period: 1 ms, execution_time: {base", "period: 10 ms, execution_time: {base"))
    run = amuros("check", path, "--output", "sarif")
    assert run.returncode == 1
    results = json.loads(run.stdout)["runs"][0]["results"]
    assert ("UR101", "error") in [(result["ruleId"], result["level"]) for result in results]


def test_a_comment_in_the_line_accepts_a_finding(tmp_path):
    path = tmp_path / "app.yaml"
    line = "  - {process: Control_Function, response_time: 1 ms}"
    assert line in ADVANCED.read_text()
    path.write_text(ADVANCED.read_text().replace(line, line + " # amuros: ignore[INC-CO-KIND]"))
    assert "INC-CO-KIND" in amuros("check", ADVANCED, *INCHRON).stdout
    assert amuros("check", path, *INCHRON).stdout == "no findings\n"
    path.write_text(ADVANCED.read_text().replace(line, line + " # amuros: ignore[INC-OTHER]"))
    assert "INC-CO-KIND" in amuros("check", path, *INCHRON).stdout


def test_a_baseline_accepts_what_is_there_today(bad, tmp_path):
    baseline = tmp_path / "baseline.json"
    assert amuros("check", bad, *INCHRON, "--write-baseline", baseline).returncode == 1
    # Also where the lines have moved.
    bad.write_text(bad.read_text().replace("<am:Amalthea", "\n\n<am:Amalthea", 1))
    run = amuros("check", bad, *INCHRON, "--baseline", baseline)
    assert (run.returncode, run.stdout) == (0, "no findings\n")
    bad.write_text(bad.read_text().replace('preemption="preemptive"', 'preemption="cooperative"', 1))
    run = amuros("check", bad, *INCHRON, "--baseline", baseline)
    assert "INC-SW-PREEMPTION" in run.stdout
    assert "1 finding:" in run.stdout
    baseline.write_text("{}")
    assert "is not a baseline of amuros" in amuros("check", bad, *INCHRON, "--baseline", baseline).stderr


def test_a_baseline_sarif_and_junit_have_as_many_results_as_the_text(bad, tmp_path):
    files = {name: tmp_path / name for name in ("sarif", "junit", "json")}
    outputs = [word for name, file in files.items() for word in ("--output", f"{name}={file}")]
    run = amuros("check", bad, "--write-baseline", tmp_path / "b.json", "--output", "text", *outputs)
    shown = int(run.stdout.splitlines()[-1].split()[0])
    accepted = json.loads((tmp_path / "b.json").read_text())["accepted"]
    results = json.loads(files["sarif"].read_text())["runs"][0]["results"]
    failures = ElementTree.parse(files["junit"]).findall(".//failure")
    assert len(accepted) == len(results) == len(failures) == shown
    assert len(json.loads(files["json"].read_text())["findings"]) > shown


def test_of_what_is_found_very_often_the_first_are_shown(tmp_path):
    path = tmp_path / "labels.amxmi"
    # All in one line, as some tools write: the line is not shown as a whole.
    labels = "".join(f'<labels name="L{number}"/>' for number in range(150))
    path.write_text(MODEL.format(f"<swModel>{labels}</swModel>"))
    run = amuros("check", path, "--select", "INC-SW-LABELSIZE")
    # Three are written, and of the first hundred the others are counted.
    assert run.stdout.count("INC-SW-LABELSIZE warning") == 3
    assert "and 97 more INC-SW-LABELSIZE of this kind, in line 3\n" in run.stdout
    assert "INC-SW-LABELSIZE: 50 more not shown" in run.stdout
    assert run.stdout.endswith("\n150 findings: 150 warnings\n")
    assert max(map(len, run.stdout.splitlines())) < 160
    run = amuros("check", path, "--select", "INC-SW-LABELSIZE", "--output", "json")
    assert len(json.loads(run.stdout)["findings"]) == 150


def test_several_profiles_and_rules(bad):
    both = amuros("check", bad, "--profile", "inchron,timing").stdout
    assert "INC-HW-PU-CLOCK" in both
    assert "TIM-CLOCK" in both
    assert both == amuros("check", bad, *INCHRON, "--profile", "timing").stdout
    assert "TIM-CLOCK" not in amuros("check", bad, "--select", "INC-CO-*,INC-HW-*").stdout
    assert "'nothing' is not one of schema, emf," in amuros("check", bad, "--profile", "inchron,nothing").stderr


CHECK = "[check]\n"
TOOL = "[tool.amuros.check]\n"


@pytest.mark.parametrize(("name", "table"), [("amuros.toml", CHECK), ("pyproject.toml", TOOL)])
def test_settings_of_a_project(name, table, bad, tmp_path):
    folder = tmp_path / "models"
    folder.mkdir()
    model = bad.rename(folder / bad.name)
    settings = tmp_path / name
    settings.write_text(table + 'profile = ["inchron"]\nignore = ["INC-HW-*"]\nfail-on = "warning"\n')
    run = amuros("check", model)
    assert "INC-HW-PU-CLOCK" not in run.stdout
    assert "INC-CO-KIND" in run.stdout
    assert "TIM-CLOCK" not in run.stdout
    assert run.returncode == 1
    # What is said on the command line takes their place.
    assert "INC-HW-PU-CLOCK" in amuros("check", model, "--ignore", "INC-CO-*").stdout
    assert "TIM-CLOCK" in amuros("check", model, "--profile", "timing").stdout
    assert amuros("check", model, "--fail-on", "error").returncode == 0
    # A baseline stands beside the settings.
    amuros("check", model, "--write-baseline", tmp_path / "accepted.json")
    settings.write_text(table + 'baseline = "accepted.json"\nprofile = ["inchron"]\nignore = ["INC-HW-*"]\n')
    assert amuros("check", model).stdout == "no findings\n"


def test_the_nearest_settings_count(bad, tmp_path):
    (tmp_path / "pyproject.toml").write_text(TOOL + 'select = ["INC-CO-*"]\n')
    (tmp_path / "amuros.toml").write_text(CHECK + 'select = ["TIM-*"]\n')
    assert "INC-CO" not in amuros("check", bad).stdout
    # A file without our table is none of ours.
    (tmp_path / "amuros.toml").unlink()
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "pyproject.toml").write_text("[project]\nname = 'x'\n")
    assert "INC-CO-KIND" in amuros("check", bad.rename(inner / "bad.amxmi")).stdout


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[check", "not valid TOML"),
        (CHECK + "selct = ['INC-*']", "unknown setting 'selct'\n  help: Did you mean 'select'?"),
        (CHECK + "select = 'INC-*'", "'select' must be a list of strings"),
        (CHECK + "profile = ['inchrn']", "'profile' cannot be 'inchrn'"),
        (CHECK + "fail-on = 'never'", "'fail-on' cannot be 'never'\n  help: Expected one of error, warning, info."),
        (CHECK + "targets = ['inchrom']", "'targets' cannot be 'inchrom'\n  help: Expected one of inchron, ta."),
        (CHECK + "baseline = 1", "'baseline' must be a string"),
        ("check = 1", "must be a table"),
    ],
)
def test_settings_that_are_wrong(text, message, bad, tmp_path):
    (tmp_path / "amuros.toml").write_text(text)
    run = amuros("check", bad)
    assert run.returncode == 2
    assert message in run.stderr
    assert "Traceback" not in run.stderr


def test_each_file_on_its_own_or_together(tmp_path):
    stimuli, tasks = tmp_path / "stimuli.amxmi", tmp_path / "tasks.amxmi"
    stimuli.write_text(MODEL.format('<stimuliModel><stimuli xsi:type="am:SingleStimulus" name="S"/></stimuliModel>'))
    tasks.write_text(MODEL.format('<swModel><tasks name="T" stimuli="S?type=SingleStimulus"/></swModel>'))
    select = ("--select", "AM-EMF-INTRINSIC/proxy-resolves")
    assert amuros("check", stimuli, tasks, *select).stdout == "no findings\n"
    assert (
        "refers to 'S?type=SingleStimulus', which is not defined" in amuros("check", "--each", stimuli, tasks, *select).stdout
    )
    # Descriptions are always models of their own.
    run = amuros("check", ADVANCED, stimuli, ADVANCED.with_name("bodas-test-simple.yaml"), "--select", "INC-CO-KIND")
    assert run.stdout.count("INC-CO-KIND warning") == 2


def test_the_hooks_for_pre_commit(tmp_path):
    hooks = {hook["id"]: hook for hook in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())}
    for hook in hooks.values():
        assert hook["entry"].startswith("amuros ")
        assert hook["language"] == "python"
    files = re.compile(hooks["amuros-check"]["files"])
    # The command itself skips YAML files of other programs.
    assert all(map(files.search, ["app.yaml", "models/system.yml", "a/b.yaml", "a.amxmi", "models/b.amxmi"]))
    assert not any(map(files.search, ["a.amxmi.txt", "a_yaml"]))
    # As it calls the command: with the files behind the arguments.
    command = hooks["amuros-check"]["entry"].split()[1:]
    other = tmp_path / "compose.yaml"
    other.write_text("services: {}\n")
    assert amuros(*command, other, ADVANCED, ADVANCED.with_suffix(".amxmi")).returncode == 0


def test_a_flaw_is_shown_once_and_written_to_files_completely(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format('<swModel><tasks name="T" what="?" stimuli="S?type=SingleStimulus"/></swModel>'))
    run = amuros(
        "check", path, "--profile", "schema,emf", "--ignore", "EMF-*", "--output", "text", "--output", f"json={tmp_path / 'j'}"
    )
    assert [line.split()[1] for line in run.stdout.splitlines() if line.startswith(str(path))] == [
        "XSD001",
        "AM-EMF-INTRINSIC/proxy-resolves",
    ]
    assert "  also: XMI020\n" in run.stdout
    assert "  also: XMI011\n" in run.stdout
    assert "2 findings" in run.stdout
    found = {finding["rule"]: finding for finding in json.loads((tmp_path / "j").read_text())["findings"]}
    assert found.keys() == {"AM-EMF-INTRINSIC/proxy-resolves", "XSD001", "XMI020", "XMI011"}
    for rule, shown in (("XMI020", "AM-EMF-INTRINSIC/proxy-resolves"), ("XMI011", "XSD001")):
        assert found[rule]["part_of"] == found[shown]["fingerprint"]
        assert found[shown]["part_of"] is None


def test_what_follows_from_a_finding_is_counted_below_it(tmp_path):
    path = tmp_path / "old.amxmi"
    # am2inc reads 1.1.0 as if it were 3.2.0, in which the attributes of the schedulers are others.
    text = MODEL.format(
        '<osModel><operatingSystems name="OS"><taskSchedulers name="S">'
        '<schedulingAlgorithm xsi:type="am:OSEK"/></taskSchedulers></operatingSystems></osModel>'
    )
    path.write_text(text.replace("3.3.0", "1.1.0"))
    run = amuros("check", path, *INCHRON, "--select", "INC-IO-*")
    assert run.returncode == 1
    assert "INC-IO-VERSION error" in run.stdout
    assert "  consequences: INC-IO-FEATURE (1)\n" in run.stdout
    assert run.stdout.endswith("1 finding: 1 error\n")


def test_target_tools_are_summed_up_unless_they_are_asked_for(bad, tmp_path):
    summary = "INCHRON's importer: fails at 1, drops 1; amuros check --profile inchron shows them\n"
    outputs = ("--output", "text", "--output", f"json={tmp_path / 'j'}", "--output", f"sarif={tmp_path / 's'}")
    run = amuros("check", bad, *outputs)
    assert run.returncode == 0
    assert summary in run.stdout
    assert "INC-HW-PU-CLOCK" not in run.stdout
    clock = next(f for f in json.loads((tmp_path / "j").read_text())["findings"] if f["rule"] == "INC-HW-PU-CLOCK")
    assert (clock["severity"], clock["effect"], clock["counts"]) == ("error", "fails", False)
    # CI systems see what people do, and more on request.
    results = json.loads((tmp_path / "s").read_text())["runs"][0]["results"]
    assert [result["ruleId"] for result in results] == ["TIM-CLOCK"]
    amuros("check", bad, *outputs, "--details")
    results = json.loads((tmp_path / "s").read_text())["runs"][0]["results"]
    of_importer = [(each["level"], each["properties"]["effect"]) for each in results if each["ruleId"].startswith("INC-")]
    assert sorted(of_importer) == [("note", "drops"), ("note", "fails")]
    for asked in (INCHRON, ("--select", "INC-*"), ("--profile", "timing,inchron")):
        run = amuros("check", bad, *asked)
        assert run.returncode == 1
        assert "INC-HW-PU-CLOCK" in run.stdout
        assert summary not in run.stdout
    (tmp_path / "amuros.toml").write_text(CHECK + 'targets = ["inchron"]\n')
    run = amuros("check", bad)
    assert run.returncode == 1
    assert "INC-HW-PU-CLOCK" in run.stdout
    assert "TA tools: note 1; amuros check --profile ta shows them" in run.stdout
