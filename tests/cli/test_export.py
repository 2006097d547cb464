"""`amuros export`, also as an importer of chronSUITE."""

import sys
from xml.etree import ElementTree

import pytest
from command import amuros
from support import ROOT, model_text

SAMPLE = ROOT / "samples" / "bodas-test-hardware.yaml"


def test_a_project_is_written_and_analysed(tmp_path):
    target = tmp_path / "project.iprx"
    run = amuros("export", SAMPLE, "-o", target)
    assert run.returncode == 0
    assert "INC004 warning" in run.stderr
    assert amuros("analyze", target).stdout == amuros("analyze", SAMPLE).stdout
    assert amuros("diff", SAMPLE, target).stdout == "no differences in meaning\n"


def test_without_a_file_the_project_is_written_to_standard_output():
    assert amuros("export", SAMPLE, "-q").stdout.startswith(
        '<?xml version="1.0" encoding="UTF-8" standalone="no" ?>\n<root:Root'
    )


def test_a_file_of_another_kind_is_refused(tmp_path):
    run = amuros("export", SAMPLE, "-o", tmp_path / "project.txt")
    assert run.returncode == 2
    assert "neither an INCHRON project (.iprx) nor an AMALTHEA model (.amxmi)" in run.stderr


def test_a_project_is_not_a_part_of_another_model(tmp_path):
    target = tmp_path / "project.iprx"
    amuros("export", SAMPLE, "-o", target)
    run = amuros("analyze", target, ROOT / "samples" / "executor.amxmi")
    assert run.returncode == 2
    assert "give it alone" in run.stderr


def test_the_form_of_an_importer(tmp_path):
    version = amuros("export", "--importer", "--version")
    assert version.stdout.splitlines()[1:] == ["version: 3.5.0", "capabilities: +multi"]
    target = tmp_path / "project.iprx"
    run = amuros("export", "--importer", "-o", target, SAMPLE)
    assert (run.returncode, run.stdout) == (0, "")
    assert all(line.startswith("[amuros] ") for line in run.stderr.splitlines())
    assert target.exists()


def test_an_importer_ends_with_the_codes_of_am2inc(tmp_path):
    assert amuros("export", "--importer").returncode == 1
    target = tmp_path / "project.iprx"
    run = amuros("export", "--importer", "-o", target, tmp_path / "missing.amxmi")
    assert run.returncode == 2
    assert run.stderr.startswith("[amuros] Error: ")
    assert not target.exists()


def test_ids_can_depend_on_a_text_or_on_the_files(tmp_path):
    texts = [amuros("export", SAMPLE, *more).stdout for more in ([], ["--stable-from-value", "v"], ["--stable-from-hash"])]
    assert len(set(texts)) == 3
    assert amuros("export", SAMPLE, "--stable-from-value", "v").stdout == texts[1]


MODEL = ROOT / "samples" / "executor.amxmi"


def test_a_mapping_names_both_objects_of_each_pair(tmp_path):
    project, mapping = tmp_path / "project.iprx", tmp_path / "mapping.xmi"
    run = amuros("export", "--importer", "--pedantic", "-m", mapping, "-o", project, MODEL)
    assert run.returncode == 0
    pairs = [
        tuple(each.get("href").split("#") for each in pair) for pair in ElementTree.parse(mapping).getroot().findall("mappings")
    ]
    names = {element.get("intrinsicId"): element.get("name") for element in ElementTree.parse(project).iter()}
    assert ["Executor_Task?type=Task", "Executor_Task"] in [[before[1], names[after[1]]] for before, after in pairs]
    assert {(before[0], after[0]) for before, after in pairs} == {("executor.amxmi", "project.iprx")}


def test_a_mapping_needs_two_files(tmp_path):
    assert amuros("export", "--importer", "-m", tmp_path / "mapping.xmi", MODEL).returncode == 1
    run = amuros("export", "-m", tmp_path / "mapping.xmi", "-o", tmp_path / "project.iprx", SAMPLE)
    assert run.returncode == 2
    assert "needs an AMALTHEA model" in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_memories_can_be_left_out(tmp_path):
    target = tmp_path / "project.iprx"
    assert amuros("export", SAMPLE, "--no-memory-accesses", "-o", target).returncode == 0
    kinds = {element.tag for element in ElementTree.parse(target).iter()}
    assert not kinds & {"memories", "interconnects", "initiator", "responder"}
    assert amuros("analyze", target).stdout == amuros("analyze", SAMPLE).stdout


def test_the_options_of_am2inc_are_understood(tmp_path):
    target = tmp_path / "project.iprx"
    assert amuros("export", "--importer", "-V").stdout == amuros("export", "--importer", "--version").stdout
    assert amuros("export", "--importer", "--relax", "--stable", "-v", "--no-output", "--output", target, MODEL).returncode == 0
    assert not target.exists()
    assert amuros("export", "--importer", "--output", target, MODEL).returncode == 0
    assert target.exists()


@pytest.mark.skipif(sys.platform != "linux", reason="the settings are a file on Linux only")
def test_errors_of_am2inc_are_written_only_on_request_and_with_a_warning(tmp_path):
    """A relation other than equal, which am2inc writes as an equality."""
    path = tmp_path / "model.amxmi"
    condition = '<entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="LESS_THAN" value="7"/>'
    path.write_text(
        model_text(
            f'<swModel><runnables name="R"><executionCondition>{condition}</executionCondition></runnables>'
            '<modes xsi:type="am:NumericMode" name="M"/>'
            '<modeLabels name="L" mode="M?type=NumericMode" initialValue="0"/></swModel>'
        )
    )
    plain, like = (amuros("export", "--importer", *option, path) for option in ((), ("--like-am2inc",)))
    assert (plain.returncode, like.returncode) == (0, 0)
    assert 'relationalOperator="lt"' in plain.stdout
    assert "relationalOperator" not in like.stdout
    warning = "[amuros] Warning: a relation other than equal, written as an equality, as INCHRON's importer writes it"
    assert (warning in plain.stderr, warning in like.stderr) == (False, True)


@pytest.mark.parametrize(
    ("name", "words"), [("INCHRON/ModelImporter.conf", "not UTF-8"), ("INCHRON", "folder cannot be created")]
)
def test_settings_of_importers_that_cannot_be_changed_are_refused_and_stay(tmp_path, monkeypatch, name, words):
    settings = tmp_path / name
    settings.parent.mkdir(exist_ok=True)
    settings.write_bytes(b"\xff[ModelImporter]\n")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    run = amuros("export", "--importer", "--install")
    assert (run.returncode, words in run.stderr) == (2, True), run.stderr
    assert settings.read_bytes() == b"\xff[ModelImporter]\n"


def test_an_importer_is_entered_in_the_settings_in_place_of_another_one(tmp_path, monkeypatch):
    settings = tmp_path / "INCHRON" / "ModelImporter.conf"
    settings.parent.mkdir()
    settings.write_text("[General]\nn=1\n\n[ModelImporter]\nAmaltheaImporter\\commandline=/opt/am2inc\nOther\\filter=x\n")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    run = amuros("export", "--importer", "--install")
    assert (run.returncode, str(settings) in run.stdout) == (0, True)
    first, *lines = settings.read_text().split("[ModelImporter]\n")
    assert first == "[General]\nn=1\n\n"
    names = [line.partition("=")[0].removeprefix("AmaltheaImporter\\") for line in lines[0].splitlines()]
    assert names == ["commandline", "arguments", "filter", "CurrentVersion", "Other\\filter"]
    assert 'export --importer -o %t %f %F"\n' in lines[0]
    assert "am2inc" not in lines[0]
