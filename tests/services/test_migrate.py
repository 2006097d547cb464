"""`amuros.migrate`, and what the other functions do with models of older versions."""

import os
import zipfile
from pathlib import Path

import pytest

import amalthea_uros as amuros
from amalthea_uros import am
from amalthea_uros._internal.file_writing import write_all
from amalthea_uros._internal.files import FileError
from amalthea_uros.diagnostics import Severity
from amalthea_uros.services.fix import fix_files
from amalthea_uros.services.format import format_files
from amalthea_uros.services.info import info
from amalthea_uros.services.migrate import FileState, migrate_files
from amalthea_uros.xmi.emf.versions import version_of
from amalthea_uros.xmi.migrate import chain
from amalthea_uros.xmi.migrate.chain import _UP
from amalthea_uros.xmi.tree.model_set import Step
from amalthea_uros.xmi.tree.notes import NoteKind

ITEA = "http://www.amalthea.itea2.org/model/"


def text(version: str, content: str = '<swModel><labels name="L"/></swModel>') -> str:
    if version.startswith("ITEA"):
        number = version.split()[1]
        spaces = " ".join(f'xmlns:{package}="{ITEA}{number}/{package}"' for package in ("central", "sw", "stimuli", "hw"))
        root, spaces = "central:AMALTHEA", spaces
    else:
        root, spaces = "am:Amalthea", f'xmlns:am="http://app4mc.eclipse.org/amalthea/{version}"'
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<{root} xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
        f" {spaces}>\n{content}\n</{root}>\n"
    )


def write(path: Path, version: str, *content: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text(version, *content))
    return path


def versions(folder: Path) -> dict[str, str]:
    """The versions of all files below a folder."""
    return {
        path.relative_to(folder).as_posix(): version_of(path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


TASK = '<swModel><tasks name="T"><stimuli href="amlt:/#S?type=SingleStimulus"/></tasks></swModel>'
STIMULUS = '<stimuliModel><stimuli xsi:type="am:SingleStimulus" name="S"/></stimuliModel>'


class TestWhereResultsGo:
    def test_beside_a_file_with_the_version_in_the_name(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.9.8")
        (file,) = migrate_files(path).files
        assert (file.version, file.target, file.state) == ("0.9.8", tmp_path / "a-3.3.0.amxmi", FileState.WRITTEN)
        assert versions(tmp_path) == {"a.amxmi": "0.9.8", "a-3.3.0.amxmi": "3.3.0"}

    def test_to_a_file(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.9.8")
        migrate_files(path, "2.0.0", tmp_path / "b.amxmi")
        assert versions(tmp_path) == {"a.amxmi": "0.9.8", "b.amxmi": "2.0.0"}

    def test_of_a_folder_to_a_folder_beside_it(self, tmp_path):
        write(tmp_path / "models" / "a.amxmi", "0.9.8")
        write(tmp_path / "models" / "sub" / "b.amxmi", "1.0.0")
        write(tmp_path / "models" / "sub" / ".hidden" / "c.amxmi", "1.0.0")
        result = migrate_files(tmp_path / "models")
        assert versions(tmp_path / "models-3.3.0") == {"a.amxmi": "3.3.0", "sub/b.amxmi": "3.3.0"}
        assert result.is_complete

    def test_to_a_folder_inside_the_folder_which_is_not_migrated_itself(self, tmp_path):
        write(tmp_path / "a.amxmi", "0.9.8")
        for _ in range(2):
            result = migrate_files(tmp_path, "3.0.0", tmp_path / "new", force=True)
            assert [file.path.name for file in result.files] == ["a.amxmi"]
        assert versions(tmp_path) == {"a.amxmi": "0.9.8", "new/a.amxmi": "3.0.0"}

    @pytest.mark.parametrize("given", [".", ".."])
    def test_of_the_current_folder_to_a_folder_beside_it(self, given, tmp_path, monkeypatch):
        write(tmp_path / "models" / "a.amxmi", "0.9.8")
        (tmp_path / "models" / "inner").mkdir()
        monkeypatch.chdir(tmp_path / "models" / ("" if given == "." else "inner"))
        assert migrate_files(given).is_complete
        assert versions(tmp_path / "models-3.3.0") == {"a.amxmi": "3.3.0"}

    def test_a_link_in_a_folder_to_a_file_elsewhere(self, tmp_path):
        write(tmp_path / "models" / "inner" / "a.amxmi", "0.9.8")
        (tmp_path / "models" / "inner" / "b.amxmi").symlink_to(write(tmp_path / "other" / "x.amxmi", "0.9.8"))
        assert migrate_files(tmp_path / "models").is_complete
        assert versions(tmp_path / "models-3.3.0") == {"inner/a.amxmi": "3.3.0", "inner/b.amxmi": "3.3.0"}
        assert versions(tmp_path / "models") == {"inner/a.amxmi": "0.9.8", "inner/b.amxmi": "0.9.8"}

    def test_a_file_that_has_the_version_is_copied_if_the_others_of_its_folder_go_elsewhere(self, tmp_path):
        write(tmp_path / "models" / "a.amxmi", "0.9.8")
        path = write(tmp_path / "models" / "b.amxmi", "3.3.0")
        migrate_files(tmp_path / "models")
        assert (tmp_path / "models-3.3.0" / "b.amxmi").read_text() == path.read_text()

    def test_no_folder_is_made_for_a_file(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.9.8")
        (finding,) = migrate_files(path, target=tmp_path / "missing" / "b.amxmi").findings
        assert finding.rule == "XMI101"
        assert [file.name for file in tmp_path.iterdir()] == ["a.amxmi"]

    def test_in_place(self, tmp_path):
        write(tmp_path / "a.amxmi", "0.9.8")
        write(tmp_path / "sub" / "b.amxmi", "3.3.0")
        before = (tmp_path / "sub" / "b.amxmi").stat().st_mtime_ns
        result = migrate_files(tmp_path, in_place=True)
        assert [file.state for file in result.files] == [FileState.WRITTEN, FileState.AS_IS]
        assert versions(tmp_path) == {"a.amxmi": "3.3.0", "sub/b.amxmi": "3.3.0"}
        assert (tmp_path / "sub" / "b.amxmi").stat().st_mtime_ns == before

    def test_nothing_is_copied_if_everything_has_the_version(self, tmp_path):
        write(tmp_path / "models" / "a.amxmi", "3.3.0")
        assert [file.state for file in migrate_files(tmp_path / "models").files] == [FileState.AS_IS]
        assert [path.name for path in tmp_path.iterdir()] == ["models"]

    def test_a_file_that_has_the_version_is_copied_to_a_folder_to_the_letter(self, tmp_path):
        write(tmp_path / "models" / "a.amxmi", "0.9.8")
        path = write(tmp_path / "models" / "b.amxmi", "3.3.0", '<swModel>\n\n<labels   name="M"/></swModel>')
        migrate_files(tmp_path / "models", target=tmp_path / "new")
        assert (tmp_path / "new" / "b.amxmi").read_text() == path.read_text()

    def test_nothing_is_overwritten_unless_forced(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.9.8", "<swModel>to do</swModel>")
        (tmp_path / "a-3.3.0.amxmi").write_text("mine")
        result = migrate_files(path)
        assert (result.files[0].state, result.findings[0].rule) == (FileState.FAILED, "XMI101")
        assert result.changes == ()
        assert (tmp_path / "a-3.3.0.amxmi").read_text() == "mine"
        assert migrate_files(path, target=path).findings[0].message == "the file exists already"
        assert migrate_files(path, force=True).is_complete
        assert version_of((tmp_path / "a-3.3.0.amxmi").read_bytes()) == "3.3.0"

    def test_two_files_do_not_become_one(self, tmp_path):
        one, other = write(tmp_path / "x" / "a.amxmi", "0.9.8"), write(tmp_path / "y" / "a.amxmi", "0.9.8")
        result = migrate_files([one, other], target=tmp_path / "new")
        assert [file.state for file in result.files] == [FileState.WRITTEN, FileState.FAILED]
        assert "two files would be written here" in result.findings[0].message

    def test_a_folder_is_migrated_once_however_often_it_is_given(self, tmp_path):
        write(tmp_path / "models" / "inner" / "a.amxmi", "0.9.8")
        result = migrate_files([tmp_path / "models", tmp_path / "models" / "inner"], target=tmp_path / "new")
        assert [file.state for file in result.files] == [FileState.WRITTEN]
        assert versions(tmp_path / "new") == {"inner/a.amxmi": "3.3.0"}

    @pytest.mark.parametrize("name", ["loop", "loop/x", "x" * 300])
    @pytest.mark.parametrize("in_folder", [False, True])
    def test_to_an_impossible_path(self, in_folder, name, tmp_path):
        (tmp_path / "loop").symlink_to(tmp_path / "loop")
        path = write(tmp_path / "models" / "a.amxmi", "0.9.8")
        (finding,) = migrate_files(path.parent if in_folder else path, target=tmp_path / name).findings
        assert (finding.rule, finding.message.partition(":")[0]) == ("XMI101", "the file cannot be written")

    def test_a_dry_run_writes_nothing(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.9.8")
        assert migrate_files(path, is_dry_run=True).files[0].state is FileState.PLANNED
        assert [file.name for file in tmp_path.iterdir()] == ["a.amxmi"]

    def test_zipped_stays_zipped_unless_told_otherwise(self, tmp_path):
        path = tmp_path / "a.amxmi"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("ResourceContents", text("0.9.8"))
        for compress, expected in ((None, True), (False, False), (True, True)):
            migrate_files(path, target=tmp_path / "b.amxmi", compress=compress, force=True)
            assert zipfile.is_zipfile(tmp_path / "b.amxmi") is expected
            assert amuros.load(tmp_path / "b.amxmi").documents[0].version == "3.3.0"

    def test_the_name_in_a_zip_stays(self, tmp_path):
        with zipfile.ZipFile(tmp_path / "a.amxmi", "w") as archive:
            archive.writestr("model", text("0.9.8"))
        for compress in (None, True):
            migrate_files(tmp_path / "a.amxmi", target=tmp_path / "b.amxmi", compress=compress, force=True)
            assert zipfile.ZipFile(tmp_path / "b.amxmi").namelist() == ["model"]

    def test_another_encoding_becomes_utf_8(self, tmp_path):
        path = tmp_path / "a.amxmi"
        content = text("0.9.8", '<swModel><labels name="é"/></swModel>').replace("UTF-8", "ISO-8859-1")
        path.write_bytes(content.encode("iso-8859-1"))
        migrate_files(path)
        assert 'name="é"' in (tmp_path / "a-3.3.0.amxmi").read_text("utf-8")

    def test_sub_models_of_itea_get_the_usual_suffix(self, tmp_path):
        write(tmp_path / "models" / "x.amxmi-sw", "ITEA 1.3.0")
        migrate_files(tmp_path / "models")
        assert versions(tmp_path / "models-3.3.0") == {"x.amxmi-sw.amxmi": "3.3.0"}
        migrate_files(tmp_path / "models", in_place=True)
        assert versions(tmp_path / "models") == {"x.amxmi-sw.amxmi": "3.3.0"}

    def test_they_keep_it_up_to_itea_1_2_0(self, tmp_path):
        path = write(tmp_path / "x.amxmi-sw", "ITEA 1.1.0")
        migrate_files(path, "ITEA 1.2.0")
        assert versions(tmp_path) == {"x.amxmi-sw": "ITEA 1.1.0", "x-ITEA-1.2.0.amxmi-sw": "ITEA 1.2.0"}


class TestSets:
    def test_references_by_name_make_a_set_of_the_files_of_a_folder(self, tmp_path):
        write(tmp_path / "models" / "sw.amxmi", "0.8.2", TASK)
        write(tmp_path / "models" / "stimuli.amxmi", "0.8.2", STIMULUS)
        write(tmp_path / "models" / "other.amxmi", "0.8.2")
        result = amuros.migrate(tmp_path / "models")
        assert [[tree.path.name for tree in one.models.trees] for one in result.sets] == [
            ["other.amxmi"],
            ["stimuli.amxmi", "sw.amxmi"],
        ]
        model = result.models[1]
        (stimulus,) = model[am.Task, "T"].stimuli
        assert stimulus is model[am.Stimulus, "S"]
        assert [finding.rule for finding in model.findings] == []

    def test_files_with_the_same_names_are_models_of_their_own(self, tmp_path):
        for name in ("a", "b"):
            write(tmp_path / "models" / f"{name}.amxmi", "0.8.2", STIMULUS)
        assert len(amuros.migrate(tmp_path / "models").sets) == 2

    def test_files_that_are_named_belong_to_the_set_wherever_they_are(self, tmp_path):
        content = '<swModel><tasks name="T"><stimuli href="../b/x%20y.amxmi#S?type=SingleStimulus"/></tasks></swModel>'
        path = write(tmp_path / "a" / "a.amxmi", "0.8.2", content)
        write(tmp_path / "b" / "x y.amxmi", "0.8.2", STIMULUS)
        result = migrate_files(path)
        assert [file.path.name for file in result.files] == ["a.amxmi", "x y.amxmi"]
        assert versions(tmp_path)["b/x y-3.3.0.amxmi"] == "3.3.0"
        assert not migrate_files(path, target=tmp_path / "c.amxmi").is_complete
        assert migrate_files(path, target=tmp_path / "c").is_complete
        assert versions(tmp_path / "c") == {"a.amxmi": "3.3.0", "x y.amxmi": "3.3.0"}
        assert len(amuros.load(path).documents) == 2

    def test_of_a_set_all_files_are_written_or_none(self, tmp_path, monkeypatch):
        folder = tmp_path / "models"
        write(folder / "a.amxmi", "0.8.2", TASK)
        write(folder / "b.amxmi", "0.8.2", STIMULUS)
        before = {path: path.read_text() for path in folder.iterdir()}
        really, calls = Path.replace, []

        def full(self, target):
            calls.append(target)
            if len(calls) == 2:
                raise OSError(28, "No space left on device")
            return really(self, target)

        monkeypatch.setattr(Path, "replace", full)
        result = migrate_files(folder, in_place=True)
        assert [file.state for file in result.files] == [FileState.FAILED] * 2
        assert "No space left" in result.findings[0].message
        assert {path: path.read_text() for path in folder.iterdir()} == before

    def test_one_bad_file_does_not_stop_the_rest(self, tmp_path):
        folder = tmp_path / "models"
        write(folder / "a.amxmi", "0.9.8")
        (folder / "b.amxmi").write_text("<am")
        write(folder / "c.amxmi", "3.9.0")
        write(folder / "d.amxmi", "0.8.8")
        (folder / "e.amxmi").write_text("<html/>")
        result = migrate_files(folder)
        assert [finding.rule for finding in result.findings] == ["XMI002", "XMI103", "XMI006", "XMI005"]
        assert versions(tmp_path / "models-3.3.0") == {"a.amxmi": "3.3.0"}

    def test_an_impossible_path_in_a_folder_does_not_stop_the_rest(self, tmp_path):
        folder = tmp_path / "models"
        write(folder / "a.amxmi", "0.9.8")
        (folder / "loop.amxmi").symlink_to(folder / "loop.amxmi")
        (folder / "nowhere.amxmi").symlink_to(folder / "missing.amxmi")
        os.mkfifo(folder / "pipe.amxmi")
        result = migrate_files(folder)
        assert [(finding.rule, finding.location.path.name) for finding in result.findings] == [
            ("XMI001", "loop.amxmi"),
            ("XMI001", "nowhere.amxmi"),
        ]
        assert versions(tmp_path / "models-3.3.0") == {"a.amxmi": "3.3.0"}

    @pytest.mark.parametrize("name", ["x" * 300, "loop"])
    @pytest.mark.parametrize("version", ["0.8.2", "2.0.0"])
    def test_a_reference_to_a_file_at_an_impossible_path_leads_nowhere(self, version, name, tmp_path):
        (tmp_path / "loop.amxmi").symlink_to(tmp_path / "loop.amxmi")
        path = write(tmp_path / "a.amxmi", version, TASK.replace("amlt:/", f"{name}.amxmi"))
        result = migrate_files(path, target=tmp_path / "b.amxmi")
        assert result.is_complete
        assert [finding.rule for finding in result.findings] == ["XMI025"]
        assert "XMI025" in [finding.rule for finding in amuros.load(path).findings]

    def test_what_is_no_part_of_a_model_is_refused(self, tmp_path):
        spaces = f'xmlns:hw="{ITEA}1.3.0/hw"'
        (tmp_path / "a.amxmi-hw").write_text(f"<hw:Nothing {spaces}/>")
        (finding,) = migrate_files(tmp_path / "a.amxmi-hw").findings
        assert (finding.rule, finding.message) == ("XMI005", "not a whole model: the root element is a Nothing")

    def test_a_set_with_a_bad_file_is_not_written(self, tmp_path):
        folder = tmp_path / "models"
        write(folder / "a.amxmi", "0.8.2", TASK.replace("amlt:/", "b.amxmi"))
        (folder / "b.amxmi").write_text("<am")
        result = migrate_files(folder)
        assert [file.state for file in result.files] == [FileState.FAILED] * 2
        assert not (tmp_path / "models-3.3.0").exists()

    def test_too_little_memory_is_no_error_of_ours(self, tmp_path, monkeypatch):
        def large(models, notes):
            raise MemoryError

        monkeypatch.setitem(_UP, "0.9.8", Step("0.9.8", "0.9.9", large))
        write(tmp_path / "a.amxmi", "0.9.8")
        (finding,) = migrate_files(tmp_path / "a.amxmi").findings
        assert (finding.rule, finding.message) == ("XMI105", "there is not enough memory for the migration")

    def test_an_error_in_a_step_is_a_finding(self, tmp_path, monkeypatch):
        def broken(models, notes):
            if models.nodes("tasks"):
                raise AttributeError("'NoneType' object has no attribute 'get'")

        monkeypatch.setitem(_UP, "0.9.8", Step("0.9.8", "0.9.9", broken))
        write(tmp_path / "models" / "a.amxmi", "0.9.8", "<swModel><tasks name='T'/></swModel>")
        write(tmp_path / "models" / "b.amxmi", "0.9.8")
        result = migrate_files(tmp_path / "models")
        assert [(finding.rule, finding.location.path.name) for finding in result.findings] == [("XMI105", "a.amxmi")]
        with pytest.raises(amuros.ReadError, match="the migration failed: AttributeError"):
            amuros.migrate(tmp_path / "models" / "a.amxmi")
        assert versions(tmp_path / "models-3.3.0") == {"b.amxmi": "3.3.0"}

    def test_a_file_with_the_version_follows_what_it_refers_to(self, tmp_path, monkeypatch):
        def rename(models, notes):
            for node in models.nodes("stimuli"):
                node.attributes["name"] = "Other"
                notes.renamed(node, "renamed")

        monkeypatch.setitem(_UP, "0.9.8", Step("0.9.8", "0.9.9", rename))
        write(tmp_path / "models" / "a.amxmi", "3.3.0", TASK)
        write(tmp_path / "models" / "b.amxmi", "0.9.8", STIMULUS)
        migrate_files(tmp_path / "models")
        assert "#Other?type" in (tmp_path / "models-3.3.0" / "a.amxmi").read_text()


class TestVersions:
    @pytest.mark.parametrize("version", ["ITEA 1.2.0", "0.7.0", "0.9.6", "0.9.7", "1.0.0", "3.2.0"])
    def test_any_newer_one(self, version, tmp_path):
        path = write(tmp_path / "a.amxmi", "ITEA 1.1.0", '<swModel><labels name="a b"/></swModel>')
        migrate_files(path, version, tmp_path / "b.amxmi")
        assert version_of((tmp_path / "b.amxmi").read_bytes()) == version
        model = amuros.load(tmp_path / "b.amxmi")
        assert model[am.Label, "a b"]

    def test_older_ones_back_to_1_2_0(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "3.3.0")
        for version in ("3.0.0", "2.2.0", "2.0.0", "1.2.0"):
            assert amuros.migrate(path, version).model.documents[0].version == version

    @pytest.mark.parametrize(
        ("version", "to"), [("3.3.0", "1.1.0"), ("1.2.0", "1.1.0"), ("0.9.8", "0.9.7"), ("0.8.1", "ITEA 1.3.0")]
    )
    def test_no_further(self, version, to, tmp_path):
        path = write(tmp_path / "a.amxmi", version)
        with pytest.raises(amuros.ReadError, match=f"XMI103.*AMALTHEA {version} cannot be migrated to the older version {to}"):
            amuros.migrate(path, to)

    @pytest.mark.parametrize(("to", "advice"), [("3.3", "'3.3.0'"), ("ITEA 1.1.0", "ITEA 1.2.0"), ("", "known: ")])
    def test_an_unknown_one(self, to, advice, tmp_path):
        with pytest.raises(amuros.InvalidArgumentError, match=f"unknown AMALTHEA version '{to}'.*{advice}"):
            amuros.migrate(tmp_path, to)

    def test_a_file_between_versions_takes_the_step_again(self, tmp_path, monkeypatch):
        def convert(models, notes):
            for node in models.nodes("oldLabels"):
                node.tag = "labels"
                notes.renamed(node, "oldLabels -> labels")

        monkeypatch.setitem(_UP, "3.2.0", Step("3.2.0", "3.3.0", convert, frozenset({"oldLabels"})))
        path = write(tmp_path / "a.amxmi", "3.3.0", '<swModel><oldLabels name="L"/></swModel>')
        model = amuros.migrate(path).model
        assert model[am.Label, "L"]
        amuros.save(model, tmp_path / "b.amxmi")
        assert "oldLabels" not in (tmp_path / "b.amxmi").read_text()


class TestWhatIsLost:
    def test_on_the_way_up_it_is_in_the_report(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.9.8", '<swModel><labels name="L"/>to do</swModel>')
        result = migrate_files(path)
        (change,) = result.changes
        assert (change.kind, change.object, change.location.line, change.detail) == (
            NoteKind.LOST,
            "Amalthea / swModel",
            3,
            "'to do'",
        )
        assert result.lost == (change,)

    def test_what_was_unknown_before_stays(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.9.8", '<swModel><labels name="L" x="1"/></swModel>')
        result = migrate_files(path)
        assert [(finding.rule, finding.location.line) for finding in result.findings] == [("XMI011", 3)]
        assert 'x="1"' in (tmp_path / "a-3.3.0.amxmi").read_text()

    def test_on_the_way_back_it_is_an_error_and_nothing_is_written(self, tmp_path, monkeypatch):
        # As if no step knew of the attribute that 2.2.0 does not have.
        monkeypatch.setitem(chain._DOWN, "3.0.0", Step("3.0.0", "2.2.0"))
        content = '<osModel>\n<semaphores name="Q" unknown="1" ownership="true"/>\n</osModel>'
        path = write(tmp_path / "a.amxmi", "3.3.0", content)
        (finding,) = migrate_files(path, "2.2.0").findings
        assert (finding.rule, finding.severity, finding.location.line) == ("XMI102", Severity.ERROR, 4)
        assert "'ownership'" in finding.message
        assert [file.name for file in tmp_path.iterdir()] == ["a.amxmi"]

    def test_what_a_step_back_and_the_reader_say_of_the_same_place_is_one_error(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "3.3.0", '<osModel><semaphores name="Q" semaphoreType="Mutex"/></osModel>')
        (finding,) = migrate_files(path, "2.2.0").findings
        assert "semaphore type Mutex: only AMALTHEA 3.0.0 and later have it" in finding.message

    @pytest.mark.parametrize(("number", "more"), [(30, " (and 10 more of this kind)"), (20, "")])
    def test_a_step_back_that_loses_something_is_an_error(self, number, more, tmp_path, monkeypatch):
        def lose(models, notes):
            for node in models.nodes("labels"):
                notes.lost(node, "has no place", node.name, "name")

        monkeypatch.setitem(chain._DOWN, "3.3.0", Step("3.3.0", "3.2.0", lose))
        labels = "\n".join(f'<labels name="L{number}"/>' for number in range(number))
        path = write(tmp_path / "a.amxmi", "3.3.0", f"<swModel>\n{labels}\n</swModel>")
        with pytest.raises(amuros.WriteError) as caught:
            amuros.migrate(path, "3.2.0")
        findings = caught.value.findings
        assert len(findings) == 20
        assert str(findings[1]) == f"{path}:5:9: XMI102 error: AMALTHEA 3.2.0 cannot hold this: has no place: L1"
        assert findings[1].object == "labels 'L1'"
        assert findings[-1].message.endswith(f"has no place: L19{more}")


class TestLibrary:
    def test_a_model_that_was_changed(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "2.0.0")
        model = amuros.load(path)
        model[am.Label, "L"].constant = True
        migrated = amuros.migrate(model, "3.0.0").model
        assert (migrated[am.Label, "L"].constant, migrated.documents[0].version) == (True, "3.0.0")
        assert model.documents[0].version == "2.0.0"

    def test_a_new_model(self):
        model = amuros.Model.of(am.Amalthea(sw_model=am.SWModel(labels=[am.Label(name="L")])))
        assert amuros.migrate(model, "3.1.0").model.documents[0].version == "3.1.0"

    def test_saving(self, tmp_path):
        write(tmp_path / "models" / "sub" / "a.amxmi", "0.9.8")
        result = amuros.migrate(tmp_path / "models")
        assert [file.state for file in result.files] == [FileState.MIGRATED]
        assert not (tmp_path / "models-3.3.0").exists()
        assert [file.state for file in result.save().files] == [FileState.WRITTEN]
        assert versions(tmp_path / "models-3.3.0") == {"sub/a.amxmi": "3.3.0"}
        with pytest.raises(amuros.WriteError, match="exists already"):
            result.save()
        result.save(in_place=True)
        assert versions(tmp_path / "models") == {"sub/a.amxmi": "3.3.0"}

    def test_versions_without_classes_can_only_be_saved(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.8.1")
        result = amuros.migrate(path, "0.9.3")
        assert result.models == ()
        with pytest.raises(ValueError, match="no typed classes"):
            _ = result.model
        result.save(tmp_path / "b.amxmi")
        assert version_of((tmp_path / "b.amxmi").read_bytes()) == "0.9.3"

    def test_several_models(self, tmp_path):
        for name in "ab":
            write(tmp_path / f"{name}.amxmi", "0.9.8")
        with pytest.raises(ValueError, match="2 models; use models"):
            _ = amuros.migrate(tmp_path).model

    def test_impossible_paths(self, tmp_path):
        (tmp_path / "loop.amxmi").symlink_to(tmp_path / "loop.amxmi")
        for path in ("a\0b", "x" * 5000, tmp_path / "loop.amxmi"):
            with pytest.raises(amuros.ReadError, match="XMI001"):
                amuros.migrate(path)
        (finding,) = migrate_files(
            [write(tmp_path / "a.amxmi", "0.9.8"), tmp_path / "loop.amxmi"], target=tmp_path / "b"
        ).findings
        assert finding.rule == "XMI001"

    def test_bad_files(self, tmp_path):
        for name in "ab":
            (tmp_path / f"{name}.amxmi").write_text("<am")
        with pytest.raises(amuros.ReadError) as caught:
            amuros.migrate(tmp_path)
        assert len(caught.value.findings) == 2


class TestModelsInMemory:
    def test_loading_says_that_the_model_was_migrated(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.8.2")
        model = amuros.load(path)
        (finding,) = model.findings
        assert (finding.rule, finding.severity) == ("XMI008", Severity.INFO)
        assert finding.message == "AMALTHEA 0.8.2 was migrated to 3.3.0 in memory; the file is unchanged"
        assert (model.documents[0].version, model.documents[0].migrated_from) == ("3.3.0", "0.8.2")

    def test_a_folder_of_sub_models_and_of_old_and_new_files(self, tmp_path):
        write(tmp_path / "a.amxmi-sw", "ITEA 1.3.0")
        write(tmp_path / "b.amxmi", "0.8.2", TASK)
        write(tmp_path / "c.amxmi", "3.0.0", STIMULUS)
        write(tmp_path / "d.amxmi~", "3.0.0")
        model = amuros.load(tmp_path)
        assert sorted((d.path.name, d.version) for d in model.documents) == [
            ("a.amxmi-sw", "3.3.0"),
            ("b.amxmi", "3.3.0"),
            ("c.amxmi", "3.0.0"),
        ]
        assert model[am.Task, "T"].stimuli == [model[am.Stimulus, "S"]]
        assert [finding.message for finding in model.findings if "migrated" in finding.message] == [
            "ITEA 1.3.0, AMALTHEA 0.8.2 was migrated to 3.3.0 in memory (2 files); the files are unchanged"
        ]

    def test_a_new_file_that_an_old_one_names_is_read_once(self, tmp_path):
        write(tmp_path / "a.amxmi", "0.8.2", TASK.replace("amlt:/", "b.amxmi"))
        write(tmp_path / "b.amxmi", "3.0.0", STIMULUS)
        model = amuros.load(tmp_path)
        assert [document.path.name for document in model.documents] == ["b.amxmi", "a.amxmi"]
        assert model[am.Task, "T"].stimuli == [model[am.Stimulus, "S"]]

    def test_a_file_of_the_newest_version_that_an_old_one_names_is_not_migrated(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.8.2", TASK.replace("amlt:/", "b.amxmi"))
        write(tmp_path / "b.amxmi", "3.3.0", STIMULUS)
        model = amuros.load(path)
        assert [document.migrated_from for document in model.documents] == ["0.8.2", None]
        assert model[am.Task, "T"].stimuli == [model[am.Stimulus, "S"]]

    def test_it_is_not_saved_over_the_old_file_by_accident(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.8.2")
        before = path.read_text()
        model = amuros.load(path)
        link = tmp_path / "link.amxmi"
        link.symlink_to(path)
        for target in (None, path, tmp_path, path.parent / ".." / path.parent.name / path.name, link):
            with pytest.raises(amuros.WriteError, match=r"XMI104.*has AMALTHEA 0\.8\.2, but the model was migrated"):
                amuros.save(model, target)
        with pytest.raises(amuros.WriteError, match=r"the model has AMALTHEA version 3\.3\.0, not 2\.0\.0"):
            amuros.save(model, tmp_path / "b.amxmi", version="2.0.0")
        assert path.read_text() == before
        link.unlink()
        amuros.save(model, tmp_path / "b.amxmi")
        amuros.save(model, version="3.3.0")
        assert versions(tmp_path) == {"a.amxmi": "3.3.0", "b.amxmi": "3.3.0"}
        assert amuros.load(path)[am.Label, "L"]

    def test_it_is_saved_in_utf_8_and_with_the_usual_names(self, tmp_path):
        path = tmp_path / "old" / "a.amxmi-sw"
        write(path, "ITEA 1.3.0")
        path.write_bytes(path.read_text().replace("UTF-8", "ISO-8859-1").replace('"L"', '"é"').encode("iso-8859-1"))
        write(tmp_path / "old" / "b.amxmi", "ITEA 1.3.0")
        amuros.save(amuros.load(tmp_path / "old"), tmp_path / "new")
        assert versions(tmp_path / "new") == {"a.amxmi-sw.amxmi": "3.3.0", "b.amxmi": "3.3.0"}
        assert 'name="é"' in (tmp_path / "new" / "a.amxmi-sw.amxmi").read_text("utf-8")

    def test_it_is_neither_repaired_nor_formatted(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.8.2", '<swModel><tasks name="T"/><tasks name="T"/></swModel>')
        before = path.read_text()
        result = fix_files(path)
        assert (result.models, result.older) == ((), ((path, "0.8.2"),))
        (finding,) = format_files(path).findings
        assert (finding.rule, finding.help) == ("XMI104", f"Migrate it first: amuros migrate {path}")
        assert path.read_text() == before

    def test_versions_of_itea_are_not_called_amalthea(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "ITEA 1.3.0")
        assert format_files(path).findings[0].message == "a model of ITEA 1.3.0 has no canonical form"
        with pytest.raises(amuros.WriteError, match=r"the file has ITEA 1\.3\.0, but the model was migrated"):
            amuros.save(amuros.load(path))

    def test_findings_are_located_in_the_old_file(self, tmp_path):
        content = '<swModel>\n  <!-- é -->\n  <tasks name="T" multipleTaskActivationLimit="many"/></swModel>'
        path = write(tmp_path / "a.amxmi", "0.8.2", content)
        result = amuros.check_files(path)
        (finding,) = [finding for finding in result.findings if finding.rule == "XMI013"]
        assert (finding.location.line, finding.location.column) == (5, 19)
        (other,) = [f for f in amuros.check_files(path).findings if f.rule == "XMI008"]
        assert other.location.line == 2

    def test_the_form_of_the_old_file_does_not_matter(self, tmp_path):
        path = write(
            tmp_path / "a.amxmi", "0.8.2", '<stimuliModel/><swModel><tasks name="T" preemption="_undefined_"/></swModel>'
        )
        assert not {f.rule for f in amuros.check_files(path).findings} & {"EMF-ID", "EMF-ORDER", "EMF-DEFAULT"}

    def test_the_schema_of_the_old_version_applies(self, tmp_path):
        path = write(tmp_path / "a.amxmi", "0.8.2")
        assert [f.rule for f in info(path, schema=True).findings] == ["XMI008", "XSD000"]

    def test_the_summary_names_both_versions(self, tmp_path):
        (document,) = info(write(tmp_path / "a.amxmi", "0.8.2")).summary.documents
        assert (document.version, document.migrated_from) == ("3.3.0", "0.8.2")


class TestDifference:
    @pytest.mark.parametrize(("old", "new"), [("0.8.2", "2.0.0"), ("0.9.8", "3.3.0"), ("2.0.0", "2.1.0"), ("3.0.0", "0.9.5")])
    def test_models_of_different_versions(self, old, new, tmp_path):
        one = write(tmp_path / "a.amxmi", old, '<swModel><labels name="L"/><labels name="M"/></swModel>')
        other = write(tmp_path / "b.amxmi", new, '<swModel><labels name="L"/></swModel>')
        result = amuros.diff(one, other)
        assert [(change.class_name, change.feature) for change in result.changes] == [
            ("Amalthea", "AMALTHEA version"),
            ("Label", ""),
        ]
        assert (result.changes[0].old, result.changes[0].new) == (old, new)
        assert {finding.rule for finding in result.findings} == {"XMI008"}
        label = result.changes[1].old_element
        assert (label.name, label.document.location_of(label).line) == ("M", 3)

    def test_models_of_the_same_version_are_compared_as_they_are(self, tmp_path):
        one, other = write(tmp_path / "a.amxmi", "1.0.0"), write(tmp_path / "b.amxmi", "1.0.0")
        assert amuros.diff(one, other).findings == ()

    def test_an_unknown_version(self, tmp_path):
        one, other = write(tmp_path / "a.amxmi", "3.9.0"), write(tmp_path / "b.amxmi", "2.0.0")
        assert [change.feature for change in amuros.diff(one, other).changes] == ["AMALTHEA version"]


def test_writing_several_files_fails_as_a_whole(tmp_path):
    kept, removed = tmp_path / "kept", tmp_path / "removed"
    kept.write_bytes(b"1")
    removed.write_bytes(b"2")
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileError, match="directory"):
        write_all({kept: b"3", tmp_path / "new": b"4", tmp_path / "folder": b"5"}, [removed])
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()} == {"kept": b"1", "removed": b"2"}
    write_all({kept: b"3", tmp_path / "new": b"4"}, [removed])
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()} == {"kept": b"3", "new": b"4"}
