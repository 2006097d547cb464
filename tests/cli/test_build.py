"""`amuros build` and `amuros schema` as their user sees them."""

import json
import shutil
from pathlib import Path

import jsonschema
import pytest
import yaml
from command import amuros
from support import ROOT

import amalthea_uros
from amalthea_uros.am import PeriodicStimulus, ProcessingUnit, Task, Ticks

SAMPLES = sorted((ROOT / "samples").glob("*.yaml"))
ADVANCED = ROOT / "samples" / "bodas-test-advanced.yaml"


@pytest.fixture
def advanced(tmp_path):
    return shutil.copy(ADVANCED, tmp_path / "app.yaml")


def test_the_advanced_model_of_the_thesis(advanced, tmp_path):
    assert len(advanced.read_text().splitlines()) <= 40
    run = amuros("build", advanced, "-o", tmp_path / "app.amxmi")
    assert run.returncode == 0
    model = amalthea_uros.load(tmp_path / "app.amxmi")
    assert model.findings == ()
    tasks = {task.name: task for task in model.all(Task)}
    periods = {name: (task.stimuli[0].recurrence.value, task.stimuli[0].recurrence.unit) for name, task in tasks.items()}
    # Thesis, section 6.2: periods, priorities, execution times.
    assert periods == {"Executor_Task": (1, "ms"), "Message_Factor": (20, "ms"), "Control_Function": (1, "ms")}
    priorities = {
        allocation.task.name: allocation.scheduling_parameters[0].value.value
        for allocation in model.root.mapping_model.task_allocation
    }
    assert priorities["Executor_Task"] > priorities["Control_Function"] > priorities["Message_Factor"]
    always, sometimes = tasks["Executor_Task"].activity_graph.items
    assert always.counter is None
    assert sometimes.counter.prescaler == 20
    assert [next(t for t in call.runnable.walk() if isinstance(t, Ticks)).default.value for call in (always, sometimes)] == [
        12,
        13,
    ]
    (chain,) = model.root.constraints_model.event_chains
    (first, second) = (item.event_chain for item in chain.items)
    events = [chain.stimulus, first.response, second.response]
    assert [event.entity.name for event in events] == ["Executor_Task", "Message_Factor", "Control_Function"]
    written = {
        access.data.name: access.enclosing(amalthea_uros.am.Runnable).name
        for access in model.all(amalthea_uros.am.LabelAccess)
        if access.access == "write"
    }
    assert written["memory_1"] == "Take_Message_Factor"
    assert written["memory_2"] == "Message_Factor_Callback"
    assert [core.frequency_domain.default_value.value for core in model.all(ProcessingUnit)] == [1.0]


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_the_samples_are_what_their_descriptions_say(sample, tmp_path):
    run = amuros("build", sample, "-o", tmp_path / "built.amxmi")
    assert run.returncode == 0
    assert (tmp_path / "built.amxmi").read_bytes() == sample.with_suffix(".amxmi").read_bytes()


def test_what_was_decided_is_shown(advanced):
    run = amuros("build", advanced)
    assert (
        "Message_Factor    every 20 ms         1  Core_0  longest available period that keeps up with messages every 20 ms"
        in run.stdout
    )
    assert "factor  received      20 ms          16 B       3      common            1.62 ms     8.1 %" in run.stdout
    assert run.stderr == ""
    assert advanced.with_suffix(".amxmi").exists()


def test_what_the_importer_changes_is_summed_up_where_it_is_the_target(advanced):
    (advanced.parent / "amuros.toml").write_text('[check]\ntargets = ["inchron"]\n')
    run = amuros("build", advanced)
    assert run.returncode == 0
    assert run.stderr == "INCHRON's importer: drops 1; amuros check --profile inchron shows them\n"


def test_findings_are_shown_with_their_lines(advanced, tmp_path):
    advanced.write_text(advanced.read_text().replace("reads: [memory_2, input]", "reads: [memory_2, outputs]"))
    run = amuros("build", advanced, "--output", f"json={tmp_path / 'built.json'}")
    (finding,) = json.loads((tmp_path / "built.json").read_text())["findings"]
    assert (finding["rule"], finding["line"]) == ("APP008", 17)
    assert "APP008 warning" in run.stderr


def test_the_same_for_programs(advanced, tmp_path):
    run = amuros("build", advanced, "--output", f"json={tmp_path / 'built.json'}", "--output", "text")
    assert run.returncode == 0
    built = json.loads((tmp_path / "built.json").read_text())
    assert built["choices"][1]["period_ps"] == 20 * 10**9
    assert built["messages"][0]["bus_time_ps"] == 3 * 135 * 4_000_000
    assert built["findings"] == []


def test_mistakes_are_told_and_nothing_is_written(advanced, tmp_path):
    advanced.write_text(advanced.read_text().replace("period: 1 ms", "period: 1"))
    run = amuros("build", advanced, "-o", tmp_path / "out.amxmi")
    assert run.returncode == 1
    assert run.stdout == ""
    lines = run.stderr.splitlines()
    assert lines[0].endswith("app.yaml:9:43: YML012 error: period: '1' has no unit; write a time such as '10 ms'")
    assert lines[1] == "  9 |   executor: {name: Executor_Task, period: 1, execution_time: {base: 12 us, per_message: 13 us}}"
    assert lines[2].index("^") == lines[1].index("1, execution")
    assert not (tmp_path / "out.amxmi").exists()


def test_an_older_file_stays_when_there_are_mistakes(advanced, tmp_path):
    out = tmp_path / "out.amxmi"
    out.write_text("precious")
    advanced.write_text(advanced.read_text().replace("Message_Factor, Control_Function]", "Mesage_Factor]"))
    run = amuros("build", advanced, "-o", out)
    assert run.returncode == 1
    assert "undefined process, runnable or label 'Mesage_Factor'" in run.stderr
    assert "Did you mean 'Message_Factor'?" in run.stderr
    assert out.read_text() == "precious"


class TestWithoutTarget:
    """A model beside the description is replaced only if nobody else made or edited it."""

    def test_its_own_model_is_replaced(self, advanced, tmp_path):
        assert amuros("build", advanced, "--amalthea", "3.2.0").returncode == 0
        assert amuros("build", advanced).returncode == 0
        assert amalthea_uros.load(tmp_path / "app.amxmi").documents[0].version == "3.3.0"

    @pytest.mark.parametrize("edit", [lambda text: text.replace("<swModel>", "<swModel><!-- mine -->"), lambda _: "precious"])
    def test_what_others_made_stays(self, edit, advanced, tmp_path):
        model = tmp_path / "app.amxmi"
        amuros("build", advanced)
        model.write_text(edit(model.read_text()))
        before = model.read_text()
        run = amuros("build", advanced)
        assert run.returncode == 2
        assert "XMI101 error: the file exists already" in run.stderr
        assert "--force" in run.stderr
        assert model.read_text() == before
        assert amuros("build", advanced, "--force").returncode == 0
        assert model.read_text() != before


def test_another_version(advanced, tmp_path):
    run = amuros("build", advanced, "--amalthea", "2.1.0", "-o", tmp_path / "old.amxmi")
    assert run.returncode == 0
    assert "http://app4mc.eclipse.org/amalthea/2.1.0" in (tmp_path / "old.amxmi").read_text()
    assert amuros("build", advanced, "--amalthea", "0.9.9").returncode == 2


def test_what_a_version_cannot_hold_is_told_with_its_line(tmp_path):
    sample = Path(shutil.copy(ROOT / "samples" / "drive-and-lift.yaml", tmp_path))
    run = amuros("build", sample, "--amalthea", "1.2.0")
    assert run.returncode == 2
    line = next(n for n, text in enumerate(sample.read_text().splitlines(), 1) if "name: Task_Log" in text)
    assert (
        f"drive-and-lift.yaml:{line}:5: BLD001 error: Task_Log: AMALTHEA 1.2.0 cannot represent the scheduling parameter 'deadline'"
        in run.stderr
    )
    assert not sample.with_suffix(".amxmi").exists()


def test_another_platform(advanced, tmp_path):
    text = advanced.read_text().replace("  platform: single-core # 1 MHz: a tick is a microsecond", "  platform: ./mine.yaml")
    advanced.write_text(text)
    (tmp_path / "mine.yaml").write_text("amuros: 1\nplatform: mine\nhardware: {frequency: 80 MHz, core_type: Mine}\n")
    assert amuros("build", advanced).returncode == 0
    model = amalthea_uros.load(advanced.with_suffix(".amxmi"))
    assert [ticks.default.value for ticks in model.all(Ticks)] == [12 * 80, 13 * 80, 2 * 80, 4 * 80]
    assert amuros("build", advanced, "--board", "bodas-rc18-12-40").returncode == 0
    assert len(list(amalthea_uros.load(advanced.with_suffix(".amxmi")).all(ProcessingUnit))) == 4
    (tmp_path / "mine.yaml").write_text("amuros: 1\nplatform: mine\nhardware: {frequency: 80}\n")
    run = amuros("build", advanced)
    assert run.returncode == 1
    assert "mine.yaml:3:23: YML012 error: frequency: '80' has no unit" in run.stderr


def test_a_zip(advanced, tmp_path):
    assert amuros("build", advanced, "--compress", "-o", tmp_path / "app.amxmi").returncode == 0
    assert (tmp_path / "app.amxmi").read_bytes()[:2] == b"PK"
    assert len(list(amalthea_uros.load(tmp_path / "app.amxmi").all(PeriodicStimulus))) == 2


def test_a_target_that_cannot_be_written(advanced, tmp_path):
    run = amuros("build", advanced, "-o", tmp_path / "none" / "app.amxmi")
    assert run.returncode == 2
    assert "Traceback" not in run.stderr


def test_files_that_are_no_descriptions(tmp_path):
    for name, content in {
        "a.yaml": b"\xff\x00",
        "b.yaml": b"",
        "c.yaml": (ADVANCED.with_suffix(".amxmi")).read_bytes(),
    }.items():
        (tmp_path / name).write_bytes(content)
        run = amuros("build", tmp_path / name)
        assert run.returncode == 2
        assert "YML0" in run.stderr
        assert "Traceback" not in run.stderr
    assert amuros("build", tmp_path / "none.yaml").returncode == 2


class TestSchema:
    def test_it_is_a_schema_and_takes_the_samples(self):
        schema = json.loads(amuros("schema").stdout)
        jsonschema.Draft7Validator.check_schema(schema)
        for sample in SAMPLES:
            jsonschema.validate(yaml.safe_load(sample.read_text()), schema, jsonschema.Draft7Validator)

    @pytest.mark.parametrize(
        ("old", "new"),
        [
            ("platform: single-core", "platfrm: single-core"),
            ("rate: 50 Hz", "rate: 50"),
            ("period: 1 ms, execution_time: 4 us", "period: 1 mss, execution_time: 4 us"),
            ("amuros: 1", "amuros: 2"),
            ("name: bodas-test-advanced\n", ""),
        ],
    )
    def test_it_refuses_mistakes(self, old, new):
        schema = json.loads(amuros("schema").stdout)
        text = ADVANCED.read_text().replace(old, new)
        assert text != ADVANCED.read_text()
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(yaml.safe_load(text), schema, jsonschema.Draft7Validator)

    def test_every_key_is_described(self):
        schema = json.loads(amuros("schema").stdout)
        sections = [schema, *schema["definitions"].values()]
        for section in sections:
            for whole in (section, *section.get("anyOf", ())):
                for key, value in whole.get("properties", {}).items():
                    # A reference without a description of its own has that of the section.
                    named = schema["definitions"].get(value.get("$ref", "").rpartition("/")[2], {})
                    assert value.get("description") or named.get("description"), key
