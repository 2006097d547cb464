"""Bad input is told as findings: what, where and what to do; never as a traceback, and nothing is half written."""

import random
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from support import DATA

import amalthea_uros as amuros

GOOD = (DATA / "brake.amxmi").read_bytes()
HEAD = GOOD[: GOOD.index(b"<am:Amalthea")]
NAMESPACES = (
    b'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    b'xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0"'
)
LAUGHS = b'<!DOCTYPE x [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
NESTED = (
    b"<am:Amalthea " + NAMESPACES + b"><swModel><runnables name='R'><activityGraph>" + b"<items xsi:type='am:Group'>" * 10_000
)

UNREADABLE = {
    "empty": (b"", "XMI001", "empty"),
    "blank": (b" \n\t ", "XMI001", "empty"),
    "prose": (b"Dear reader,\nthis is no model.", "XMI002", "not XML"),
    "binary": (bytes(range(256)) * 20, "XMI002", "not XML"),
    "not utf-8": (HEAD + b'<am:Amalthea name="\xff\xfe"/>', "XMI002", "utf-8"),
    "unknown encoding": (GOOD.replace(b"UTF-8", b"klingon"), "XMI002", "klingon"),
    "truncated": (GOOD[:900], "XMI002", "not well-formed"),
    "truncated between elements": (GOOD[: GOOD.index(b"</swModel>")], "XMI002", "SWModel on line 3 is not closed"),
    "attribute twice": (GOOD.replace(b'name="Act"', b'name="Act" name="Act"'), "XMI002", "duplicate attribute"),
    "NUL": (GOOD.replace(b"Pedal", b"Pe\x00dal"), "XMI002", "not well-formed"),
    "document type": (HEAD + b"<!DOCTYPE x>" + GOOD[len(HEAD) :], "XMI003", "DTD"),
    "entities": (HEAD + LAUGHS + GOOD[len(HEAD) :], "XMI003", "document type declaration"),
    "external entity": (HEAD + b'<!DOCTYPE x SYSTEM "file:///etc/passwd">' + GOOD[len(HEAD) :], "XMI003", "DTD"),
    "undeclared prefix": (GOOD.replace(b"xmlns:xsi", b"xmlns:xs"), "XMI002", "undeclared namespace prefix 'xsi'"),
    "undefined entity": (GOOD.replace(b"Pedal", b"&pedal;"), "XMI002", "undefined entity"),
    "nested": (NESTED, "XMI004", "nested"),
    "other root": (HEAD + b"<html/>", "XMI005", "<html>"),
    "other root of the namespace": (HEAD + b"<am:SWModel " + NAMESPACES + b"/>", "XMI005", "<am:SWModel>"),
    "no version": (GOOD.replace(b"3.0.0", b"3.0.0/../.."), "XMI005", "does not end with an AMALTHEA version"),
    "old version": (GOOD.replace(b"3.0.0", b"0.8.7"), "XMI006", "0.8.7"),
    "ITEA version": (
        b'<central:AMALTHEA xmlns:central="http://www.amalthea.itea2.org/model/1.0.0/central"/>',
        "XMI006",
        "ITEA 1.0.0 is no known version",
    ),
    "damaged archive": (b"PK\x03\x04" + bytes(60), "XMI001", "damaged"),
}


@pytest.fixture(params=UNREADABLE, ids=lambda name: name.replace(" ", "-"))
def unreadable(request, tmp_path):
    data, rule, words = UNREADABLE[request.param]
    path = tmp_path / "bad.amxmi"
    path.write_bytes(data)
    return path, rule, words


def test_an_unreadable_file_is_one_finding(unreadable):
    path, rule, words = unreadable
    with pytest.raises(amuros.ReadError) as caught:
        amuros.load(path)
    (finding,) = caught.value.findings
    assert finding.rule == rule
    assert words in finding.message
    assert finding.location.path == path


@pytest.mark.parametrize("name", ["truncated", "entities", "other root", "damaged archive", "binary", "empty"])
def test_on_the_command_line_it_is_one_message_and_exit_code_2(name, tmp_path):
    path = tmp_path / "bad.amxmi"
    path.write_bytes(UNREADABLE[name][0])
    run = subprocess.run([sys.executable, "-m", "amalthea_uros", "fmt", path], capture_output=True, text=True, check=False)
    assert run.returncode == 2
    assert run.stdout == ""
    assert run.stderr.startswith(f"{path}:") or run.stderr.startswith(f"{path} ")
    assert "Traceback" not in run.stderr
    assert path.read_bytes() == UNREADABLE[name][0]


def refused(*paths, **options):
    with pytest.raises(amuros.ReadError) as caught:
        amuros.load(*paths, **options)
    return [finding.message for finding in caught.value.findings]


def test_a_missing_file(tmp_path):
    assert refused(tmp_path / "none.amxmi") == ["file not found"]


def test_a_folder_without_models(tmp_path):
    assert refused(tmp_path) == ["the directory contains no .amxmi file"]


def test_a_file_without_permission(tmp_path, monkeypatch):
    def denied(*_arguments, **_options):
        raise PermissionError(13, "Permission denied")

    path = tmp_path / "model.amxmi"
    path.write_bytes(GOOD)
    monkeypatch.setattr(Path, "open", denied)
    assert refused(path) == ["the file cannot be read: Permission denied"]


def test_all_bad_files_of_a_folder_are_told(tmp_path):
    for name in ("a", "b"):
        (tmp_path / f"{name}.amxmi").write_bytes(b"")
    (tmp_path / "c.amxmi").write_bytes(GOOD)
    assert refused(tmp_path) == ["the file is empty"] * 2


def test_a_zip_bomb_is_refused_before_it_is_unpacked(tmp_path):
    path = tmp_path / "bomb.amxmi"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("ResourceContents", b" " * 20_000_000)
    assert refused(path, max_size=10 * 2**20) == ["the unpacked content is larger than 10 MiB"]


def test_a_zip_of_several_files(tmp_path):
    path = tmp_path / "two.amxmi"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("one", GOOD)
        archive.writestr("two", GOOD)
    assert refused(path) == ["the archive contains 2 files, expected one"]


def test_a_file_that_is_too_large(tmp_path):
    path = tmp_path / "large.amxmi"
    path.write_bytes(GOOD)
    assert refused(path, max_size=1000) == ["the file is larger than 1,000 bytes"]


@pytest.mark.parametrize("end", range(1, len(GOOD) - 1, 7))
def test_truncated_anywhere(end, tmp_path):
    path = tmp_path / "short.amxmi"
    path.write_bytes(GOOD[:end])
    assert len(refused(path)) == 1


def test_any_damage_is_told_or_kept(tmp_path):
    """Whatever happens to some bytes: the file is refused, or read and written back as it is."""
    generator = random.Random(7)
    path, copy = tmp_path / "damaged.amxmi", tmp_path / "copy.amxmi"
    for _ in range(3000):
        data = bytearray(GOOD)
        for _ in range(generator.randint(1, 4)):
            at = generator.randrange(len(data))
            action = generator.random()
            if action < 0.4:
                data[at] = generator.randrange(256)
            elif action < 0.7:
                del data[at : at + generator.randint(1, 20)]
            else:
                data[at:at] = bytes(generator.choice(b"<>\"'/&;= ax#") for _ in range(generator.randint(1, 4)))
        path.write_bytes(data)
        try:
            model = amuros.load(path)
        except amuros.ReadError:
            continue
        amuros.save(model, copy)
        assert copy.read_bytes() == bytes(data)
        model.documents[0].changes.modified.update(model.walk())
        amuros.save(model, copy)
        assert copy.read_bytes() == bytes(data)


def test_values_of_a_wrong_kind_count_as_not_set_and_are_kept(tmp_path):
    path = tmp_path / "model.amxmi"
    text = GOOD.replace(b'Limit="1"', b'Limit="many"').replace(b'average="120.5"', b'average="' + b"9" * 5000 + b'x"')
    path.write_bytes(text)
    model = amuros.load(path)
    assert [finding.rule for finding in model.findings] == ["XMI013", "XMI013"]
    assert model[amuros.am.Task, "Brake (left)"].multiple_task_activation_limit is None
    amuros.save(model)
    assert path.read_bytes() == text


@pytest.mark.parametrize(
    ("old", "new", "rule", "words"),
    [
        (b"<labels", b"<label", "XMI002", "mismatched tag"),
        (b'xsi:type="am:Ticks"', b'xsi:type="am:Label"', "XMI012", "has type Label, expected ActivityGraphItem"),
        (b' xsi:type="am:Ticks"', b"", "XMI012", "no xsi:type"),
        (b'access="read"', b'acess="read"', "XMI011", "'acess'"),
        (b'<size value="16" unit="bit"/>', b'<size value="1"/><size value="2"/>', "XMI014", "only one <size>"),
        (b'<size value="16" unit="bit"/>', b"sixteen", "XMI015", "'sixteen'"),
        (b'data="Pedal?type=Label"', b'data="Pedel?type=Label"', "XMI020", "'Pedel?type=Label', which does not exist"),
        (b'data="Pedal?type=Label"', b'data="Act?type=Runnable"', "XMI023", "which is not a Label"),
        (b'xmi:id="Pedal?type=Label"', b'xmi:id="Brake?type=Label"', "XMI022", "not the unique name"),
        (b"amalthea/3.0.0", b"amalthea/9.0.0", "XMI007", "read as 3.3.0"),
    ],
)
def test_what_is_odd_is_told_with_its_place(old, new, rule, words, tmp_path):
    path = tmp_path / "odd.amxmi"
    assert old in GOOD
    path.write_bytes(GOOD.replace(old, new, 1))
    try:
        findings = amuros.load(path).findings
    except amuros.ReadError as error:
        findings = error.findings
    found = {finding.rule: finding for finding in findings}
    assert words in found[rule].message
    assert found[rule].location.line


def test_a_near_name_is_suggested(tmp_path):
    path = tmp_path / "odd.amxmi"
    path.write_bytes(GOOD.replace(b'access="read"', b'acess="read"').replace(b'data="Pedal', b'data="Pedel'))
    helps = [finding.help for finding in amuros.load(path).findings]
    assert any("Did you mean 'access'?" in text for text in helps)
    assert any("Did you mean 'Pedal?type=Label'?" in text for text in helps)


class TestWriting:
    @pytest.fixture
    def model(self, tmp_path):
        (tmp_path / "model.amxmi").write_bytes(GOOD)
        return amuros.load(tmp_path / "model.amxmi")

    def test_values_that_are_not_allowed_are_all_named_and_nothing_is_written(self, model, tmp_path):
        task = model[amuros.am.Task, "Brake (left)"]
        task.preemption = "sometimes"
        task.multiple_task_activation_limit = 1.5
        task.stimuli.append(model[amuros.am.Label, "Pedal"])
        model[amuros.am.Label, "Pedal"].name = "Pe\x07dal"
        with pytest.raises(amuros.WriteError) as caught:
            amuros.save(model)
        messages = [finding.message for finding in caught.value.findings]
        assert len(messages) == 4
        assert any("Brake (left)" in m and "'preemption'" in m and "'sometimes'" in m for m in messages)
        assert any("'multiple_task_activation_limit' must be of type int, not 1.5" in m for m in messages)
        assert any("'stimuli' must be Stimulus" in m for m in messages)
        assert any("U+0007" in m for m in messages)
        assert (tmp_path / "model.amxmi").read_bytes() == GOOD

    def test_what_the_version_does_not_have_is_named(self, model):
        model[amuros.am.Runnable, "Act"].activity_graph = amuros.am.ActivityGraph(items=[amuros.am.ModeSwitch()])
        with pytest.raises(
            amuros.WriteError, match=r"Act\.activityGraph\.items\[0\]: the class ModeSwitch does not exist in AMALTHEA 3\.0\.0"
        ):
            amuros.save(model)

    def test_a_failing_write_leaves_the_old_file(self, model, tmp_path, monkeypatch):
        def full(*_arguments):
            raise OSError(28, "No space left on device")

        model[amuros.am.Label, "Pedal"].constant = True
        monkeypatch.setattr(Path, "replace", full)
        with pytest.raises(amuros.WriteError, match="No space left"):
            amuros.save(model)
        assert [path.name for path in tmp_path.iterdir()] == ["model.amxmi"]
        assert (tmp_path / "model.amxmi").read_bytes() == GOOD

    def test_a_missing_folder(self, model, tmp_path):
        with pytest.raises(amuros.WriteError, match="No such file"):
            amuros.save(model, tmp_path / "none" / "model.amxmi")


def test_what_the_reader_would_refuse_as_too_deep_is_not_written(tmp_path):
    path = tmp_path / "deep.amxmi"

    def nested(levels):
        innermost = top = amuros.am.Group(name="G")
        for _ in range(levels - 1):
            innermost.items.append(amuros.am.Group(name="G"))
            innermost = innermost.items[0]
        runnable = amuros.am.Runnable(name="R", activity_graph=amuros.am.ActivityGraph(items=[top]))
        return amuros.Model.of(amuros.am.Amalthea(sw_model=amuros.am.SWModel(runnables=[runnable])))

    amuros.save(nested(196), path)
    text = path.read_text()
    assert sum(1 for _ in amuros.load(path).all(amuros.am.Group)) == 196
    for levels in (197, 3000):
        with pytest.raises(amuros.WriteError, match="nested more than 200 levels deep"):
            amuros.save(nested(levels), path)
    assert path.read_text() == text
    innermost = '<items xsi:type="am:Group" name="G" ordered="true" interruptible="true"/>'
    path.write_text(text.replace(innermost, innermost.replace("/>", f">{innermost}</items>")))
    with pytest.raises(amuros.ReadError, match="200 levels deep"):
        amuros.load(path)
