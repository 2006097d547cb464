"""Whatever is in a file, it is read as a model or refused in words; writing leaves the old file or the new one, nothing else."""

import io
import os
import random
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros import ReadError, WriteError, load, save
from amalthea_uros._internal import files
from amalthea_uros.cli.main import main
from amalthea_uros.metamodel import classes

DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>\n'
SPACES = 'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
NAMESPACE = "http://app4mc.eclipse.org/amalthea/"


def root(content: str = "", version: str = "3.3.0", declaration: str = DECLARATION) -> str:
    return f'{declaration}<am:Amalthea {SPACES} xmlns:am="{NAMESPACE}{version}">{content}</am:Amalthea>\n'


VALID = root(
    '\n  <swModel>\n    <tasks xmi:id="T?type=Task" name="T" stimuli="S?type=PeriodicStimulus" multipleTaskActivationLimit="0">\n'
    '      <size value="5" unit="B"/>\n    </tasks>\n    <!-- ä -->\n    <labels name="é&amp;"/>\n  </swModel>\n  <stimuliModel>\n'
    '    <stimuli xsi:type="am:PeriodicStimulus" xmi:id="S?type=PeriodicStimulus" name="S"/>\n  </stimuliModel>\n'
).encode()


def zipped(*entries: tuple[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, data in entries:
            archive.writestr(name, data)
    return packed.getvalue()


def with_doctype(inside: str) -> bytes:
    return root("<swModel>&a;</swModel>", declaration=f"<!DOCTYPE am:Amalthea [{inside}]>").encode()


def declared(encoding: str, text: str = "") -> bytes:
    return root(text, declaration=f'<?xml version="1.0" encoding="{encoding}"?>\n').encode()


LAUGHS = '<!ENTITY a "ha">' + "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
LIST_START = '<values xsi:type="am:ListObject">'
ARCHIVE = zipped(("ResourceContents", VALID))

#: What a file holds, and the rule that refuses it.
REFUSED = {
    "text": (b"Hello, world!", "XMI002"),
    "JSON": (b'{"a": 1}', "XMI002"),
    "no elements": (DECLARATION.encode(), "XMI002"),
    "HTML": (b"<!DOCTYPE html>\n<html></html>", "XMI003"),
    "a DTD": (with_doctype(""), "XMI003"),
    "a billion laughs": (with_doctype(LAUGHS), "XMI003"),
    "an external entity": (with_doctype('<!ENTITY a SYSTEM "file:///etc/passwd">'), "XMI003"),
    "an external DTD": (root(declaration='<!DOCTYPE am:Amalthea SYSTEM "http://localhost/x.dtd">').encode(), "XMI003"),
    "an entity that is not declared": (root("&a;").encode(), "XMI002"),
    "a zip with several entries": (zipped(("a", VALID), ("b", VALID)), "XMI001"),
    "a zip with no entry": (zipped(), "XMI002"),
    "a zip in a zip": (zipped(("a", ARCHIVE)), "XMI002"),
    "a zip with an entry without a name": (ARCHIVE.replace(b"ResourceContents", b"\0" * 16), "XMI001"),
    "half a zip": (ARCHIVE[: len(ARCHIVE) // 2], "XMI001"),
    "a zip with a damaged entry": (ARCHIVE[:60] + bytes(20) + ARCHIVE[80:], "XMI001"),
    "another root": (b"<a/>", "XMI005"),
    "another namespace": (root().replace("app4mc", "other").encode(), "XMI005"),
    "no namespace": (b"<Amalthea/>", "XMI005"),
    "a prefix without a namespace": (b"<am:Amalthea/>", "XMI005"),
    "an ITEA version": (b'<central:AMALTHEA xmlns:central="http://www.amalthea.itea2.org/model/1.0.0/central"/>', "XMI006"),
    "an older version": (root(version="0.8.9").encode(), "XMI006"),
    "a path as version": (root(version="3.3.0/../..").encode(), "XMI005"),
    "no version": (root(version="").encode(), "XMI005"),
    "a version with letters": (root(version="3.x").encode(), "XMI005"),
    "a version of long numbers": (root(version="3." + "9" * 5000).encode(), "XMI005"),
    "a version in other digits": (root(version="\u0663.\u0663.\u0660").encode(), "XMI005"),
    "bytes by chance": (random.Random(1).randbytes(500), "XMI002"),
    "zeros": (bytes(100), "XMI002"),
    "a zero byte inside": (VALID.replace(b"T?type", b"T\0type"), "XMI002"),
    "nothing": (b"", "XMI001"),
    "white space": (b" \r\n\t\n", "XMI001"),
    "a byte order mark only": (b"\xef\xbb\xbf", "XMI001"),
    "invalid UTF-8": (VALID.replace(b'"T"', b'"\xff"'), "XMI002"),
    "a lone surrogate in UTF-8": (VALID.replace(b'"T"', b'"\xed\xa0\x80"'), "XMI002"),
    "half a character of UTF-16": (b"\xff\xfe<\0a", "XMI002"),
    "an unknown encoding": (declared("klingon"), "XMI002"),
    "an encoding that is none": (declared("base64"), "XMI002"),
    "an encoding of Python source": (declared("unicode_escape", "\\ud800"), "XMI002"),
    "a surrogate in UTF-7": (declared("UTF-7").replace(b"></am", b' a="+2AA-"></am'), "XMI002"),
    "an encoding without letters": (declared("undefined"), "XMI002"),
    "an encoding of domain names": (declared("idna", "x" * 100), "XMI002"),
    "an encoding of punctuation": (declared("punycode", "x-99999999999"), "XMI002"),
    "deep nesting of objects": (
        root('<customProperties><value xsi:type="am:ListObject">' + LIST_START * 5000).encode(),
        "XMI004",
    ),
    "an attribute twice": (VALID.replace(b'name="T"', b'name="T" name="U"'), "XMI002"),
    "two roots": (VALID + b"<a/>", "XMI002"),
    "text behind the root": (VALID + b"a", "XMI002"),
}


def file(folder: Path, data: bytes, name: str = "model.amxmi") -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


def check_refusal(error: ReadError, path: Path) -> None:
    """Every finding says what is wrong and where."""
    assert error.findings
    for finding in error.findings:
        assert finding.rule.startswith("XMI")
        assert finding.message
        assert finding.location.path == path
        assert (finding.location.line or 1) >= 1
        assert (finding.location.column or 1) >= 1
        assert str(path) in str(finding)


@pytest.mark.parametrize(("data", "rule"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_model_is_refused_with_words(data, rule, tmp_path):
    path = file(tmp_path, data)
    if rule is None:
        load(path)
        return
    with pytest.raises(ReadError) as caught:
        load(path)
    check_refusal(caught.value, path)
    assert caught.value.findings[0].rule == rule


@pytest.mark.parametrize(("data", "rule"), REFUSED.values(), ids=REFUSED)
def test_the_command_line_refuses_without_a_traceback(data, rule, tmp_path, monkeypatch, capfd):
    path = file(tmp_path, data)
    monkeypatch.setattr(sys, "argv", ["amuros", "fmt", "--check", str(path)])
    with pytest.raises(SystemExit) as caught:
        main()
    out, err = capfd.readouterr()
    assert caught.value.code == (2 if rule else 1)
    assert (rule or "") in err
    assert "Traceback" not in err
    assert (not out) is (rule is not None)
    assert [(entry, entry.read_bytes()) for entry in tmp_path.iterdir()] == [(path, data)]


def test_the_command_exits_with_2(tmp_path):
    arguments = [sys.executable, "-m", "amalthea_uros", "fmt", "--check", file(tmp_path, b"<a/>")]
    done = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "XMI005" in done.stderr
    assert "Traceback" not in done.stderr


# Places that are no file


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(ReadError, match="file not found"):
        load(tmp_path / "missing.amxmi")


@pytest.mark.parametrize("name", ["a" * 300, "a\0b"])
def test_an_impossible_name_is_refused(name, tmp_path):
    with pytest.raises(ReadError):
        load(tmp_path / name)


def test_a_folder_without_models_is_refused(tmp_path):
    with pytest.raises(ReadError, match=r"no \.amxmi file"):
        load(tmp_path)


def test_a_file_in_place_of_a_folder_is_refused(tmp_path):
    with pytest.raises(ReadError):
        load(file(tmp_path, VALID) / "model.amxmi")


def test_a_file_without_permission_is_refused(tmp_path, monkeypatch):
    path = file(tmp_path, VALID)

    def refuse(*_arguments, **_more):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(ReadError, match="Permission denied"):
        load(path)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_a_folder_without_permission_is_refused(tmp_path):
    tmp_path.chmod(0)
    try:
        with pytest.raises(ReadError):
            load(tmp_path)
    finally:
        tmp_path.chmod(0o700)


def test_an_archive_that_unpacks_to_more_than_the_limit_is_refused(tmp_path):
    path = file(tmp_path, zipped(("ResourceContents", bytes(5_000_000))))
    with pytest.raises(ReadError) as caught:
        load(path, max_size=1_000_000)
    assert caught.value.findings[0].rule == "XMI004"


def test_elements_are_counted_before_objects_are_made(tmp_path, monkeypatch):
    # 100 kB of ZIP hold ten million tasks; no object of them is made.
    path = file(tmp_path, zipped(("ResourceContents", root("<swModel>" + "<tasks/>" * 1_000_000 + "</swModel>"))))
    monkeypatch.setattr("amalthea_uros.xmi.load.read", lambda *_arguments: pytest.fail("an object was made"))
    assert path.stat().st_size < 20_000
    with pytest.raises(ReadError, match=r"more than 1,000,000 elements") as caught:
        load(path)
    (finding,) = caught.value.findings
    assert finding.rule == "XMI004"
    assert "AMUROS_LIMITS=4" in finding.help


def test_a_larger_size_allows_more_elements(tmp_path, monkeypatch):
    monkeypatch.setattr("amalthea_uros.xmi.emf.files.MODEL_ELEMENTS", 10)
    monkeypatch.setattr("amalthea_uros.xmi.emf.files.MODEL_SIZE", 1000)
    path = file(tmp_path, root("<swModel>" + "<tasks/>" * 10 + "</swModel>").encode())
    with pytest.raises(ReadError, match="more than 10 elements"):
        load(path, max_size=1000)
    assert len(load(path, max_size=2000).documents[0].root.sw_model.tasks) == 10


def test_references_in_lists_are_counted(tmp_path, monkeypatch):
    monkeypatch.setattr("amalthea_uros.xmi.emf.reader.MODEL_REFERENCES", 5)
    many = "<swModel>" + '<tasks name="T" stimuli="a b c"/>' * 2 + "</swModel>"
    with pytest.raises(ReadError, match="more than 5 references in lists"):
        load(file(tmp_path, root(many).encode()))


def test_an_archive_with_a_method_without_limits_is_refused(tmp_path):
    # bzip2 packs a gigabyte in less than a kilobyte, and is unpacked as a whole.
    path = file(tmp_path, zipped(("ResourceContents", VALID), method=zipfile.ZIP_BZIP2))
    with pytest.raises(ReadError, match="compressed by a method that AMALTHEA tools do not use"):
        load(path)


def test_an_archive_with_many_entries_is_refused_before_its_directory_is_read(tmp_path, monkeypatch):
    path = file(tmp_path, zipped(*((str(number), b"") for number in range(1001))))
    monkeypatch.setattr(zipfile, "ZipFile", lambda *_arguments: pytest.fail("the directory was read"))
    with pytest.raises(ReadError, match="more than 1,000 files"):
        load(path)


def test_no_more_memory_is_reserved_than_the_file_needs():
    asked = []

    class Counting(io.BytesIO):
        def read(self, size=-1):
            asked.append(size)
            return super().read(size)

    assert files.read_up_to(Counting(b"x" * 100), 1 << 40, block=101) == b"x" * 100
    assert max(asked) <= 101


def test_all_bad_files_of_a_folder_are_told(tmp_path):
    for name in ("a.amxmi", "b.amxmi"):
        file(tmp_path, b"<a/>", name)
    file(tmp_path, VALID, "c.amxmi")
    with pytest.raises(ReadError) as caught:
        load(tmp_path)
    assert [finding.location.path.name for finding in caught.value.findings] == ["a.amxmi", "b.amxmi"]


def test_files_of_different_versions_can_be_read_together(tmp_path):
    file(tmp_path, VALID, "a.amxmi")
    file(tmp_path, root('<swModel><tasks name="U"/></swModel>', version="1.0.0").encode(), "b.amxmi")
    model = load(tmp_path)
    assert [document.version for document in model.documents] == ["3.3.0", "1.0.0"]
    assert model[classes.Task, "U"].document.version == "1.0.0"


def test_unknown_elements_may_be_nested_deep(tmp_path):
    path = file(tmp_path, root("<a>" * 10_000 + "</a>" * 10_000).encode())
    before = path.read_bytes()
    model = load(path)
    assert [finding.rule for finding in model.findings] == ["XMI010"]
    model.documents[0].changes.modified.update(model.walk())
    save(model)
    assert path.read_bytes() == before


# Values that are none


@pytest.mark.parametrize(
    "number", ["9" * 5000, "1e999999999", "", " ", "0x" + "f" * 5000, "\u0661", "1_000", "NaN", "1.5", "--1", "+"]
)
@pytest.mark.parametrize("content", ['<swModel><labels><size value="{}"/></labels></swModel>'])
def test_odd_numbers_are_kept_as_they_stand(number, content, tmp_path):
    text = root(content.format(number))
    path = file(tmp_path, text.encode())
    model = load(path)
    model.documents[0].changes.modified.update(model.walk())
    save(model)
    assert path.read_bytes().decode() == text


@pytest.mark.parametrize("address", ["9" * 5000, "0" + "7" * 9000, "0x" + "f" * 9000, "-1", "08"])
def test_odd_addresses_are_kept_as_they_stand(address, tmp_path):
    text = root(f'<mappingModel><memoryMapping memoryPositionAddress="{address}"/></mappingModel>')
    path = file(tmp_path, text.encode())
    model = load(path)
    model.documents[0].changes.modified.update(model.walk())
    save(model)
    assert path.read_bytes().decode() == text


@pytest.mark.parametrize("value", [10**5000, -(10**5000)], ids=["positive", "negative"])
def test_numbers_that_are_too_long_to_write_are_refused(value, tmp_path):
    path = file(tmp_path, VALID)
    model = load(path)
    model[classes.Task, "T"].size.value = value
    with pytest.raises(WriteError, match="value"):
        save(model)
    assert path.read_bytes() == VALID


# Files cut off, and with changed bytes


def loads_or_refuses(path: Path, data: bytes) -> bool:
    """Whether a file is read; if so, saving gives its bytes."""
    path.write_bytes(data)
    try:
        model = load(path)
    except ReadError as error:
        check_refusal(error, path)
        return False
    assert model.documents[0].source.text.encode(model.documents[0].source.encoding) == data
    return True


def test_a_file_cut_off_anywhere_is_refused(tmp_path):
    end = VALID.rstrip()
    for size in range(len(end)):
        assert not loads_or_refuses(tmp_path / "cut.amxmi", end[:size]), size


def test_a_zip_cut_off_anywhere_is_refused(tmp_path):
    for size in range(len(ARCHIVE)):
        assert not loads_or_refuses(tmp_path / "cut.amxmi", ARCHIVE[:size]), size


def mutated(rng: random.Random, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 5])):
        at = rng.randrange(len(changed))
        size = rng.choice([0, 1, 1, 3])
        some = rng.choice(
            [bytes([rng.randrange(256)]), rng.choice([b"<", b">", b"&", b'"', b"/", b" ", b"=", b"<!--", b"]]>", b"&#0;"])]
        )
        changed[at : at + size] = rng.choice([b"", some, changed[at : at + size] * 2])
    return bytes(changed)


@pytest.mark.parametrize("seed", range(4))
def test_changed_bytes_are_refused_or_kept(seed, tmp_path):
    rng = random.Random(seed)
    read = sum(loads_or_refuses(tmp_path / "changed.amxmi", mutated(rng, VALID)) for _ in range(1000))
    assert 0 < read < 1000


def test_merging_unchanged_objects_keeps_changed_bytes(tmp_path):
    rng = random.Random(5)
    path = tmp_path / "changed.amxmi"
    for _ in range(500):
        data = mutated(rng, VALID)
        # A prefix that is used and not declared gets its declaration.
        if b"xmlns:xsi=" in data and loads_or_refuses(path, data):
            model = load(path)
            model.documents[0].changes.modified.update(model.walk())
            save(model)
            assert path.read_bytes() == data


def test_a_zip_with_changed_bytes_is_read_or_refused(tmp_path):
    rng = random.Random(6)
    path = tmp_path / "changed.amxmi"
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA) * 300:
        path.write_bytes(mutated(rng, zipped(("ResourceContents", VALID), method=method)))
        try:
            load(path)
        except ReadError as error:
            check_refusal(error, path)


@examples(119)
@given(st.binary(max_size=60))
def test_any_bytes_behind_a_declared_encoding_are_read_or_refused(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "bytes.amxmi"
    for encoding in ("utf-8", "utf-7", "utf-16", "cp037", "iso2022_jp", "raw_unicode_escape"):
        path.write_bytes(declared(encoding).replace(b"></am", b">" + data + b"</am"))
        try:
            load(path)
        except ReadError as error:
            check_refusal(error, path)


@pytest.mark.parametrize("codec", ["utf-16-le", "utf-16-be"])
def test_the_byte_order_of_utf_16_is_kept(codec, tmp_path):
    data = ("\ufeff" + root(declaration='<?xml version="1.0" encoding="UTF-16"?>\n')).encode(codec)
    path = file(tmp_path, data)
    save(load(path))
    assert path.read_bytes() == data


def test_a_name_that_the_encoding_of_the_file_lacks_is_written_as_references(tmp_path):
    path = file(tmp_path, declared("ISO-8859-1", '<swModel><tasks name="T"/></swModel>'))
    model = load(path)
    model[classes.Task, "T"].name = "é名"
    save(model)
    assert 'name="é&#21517;"'.encode("iso-8859-1") in path.read_bytes()
    assert load(path)[classes.Task, "é名"]


# Writing


@pytest.fixture
def changed(tmp_path):
    """A loaded model with a change."""
    path = file(tmp_path, VALID)
    model = load(path)
    model[classes.Task, "T"].name = "new"
    return model


def test_a_file_that_cannot_be_replaced_stays_and_nothing_is_left_behind(changed, tmp_path, monkeypatch):
    def refuse(*_arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", refuse)
    with pytest.raises(WriteError, match="No space left"):
        save(changed)
    assert [(entry.name, entry.read_bytes()) for entry in tmp_path.iterdir()] == [("model.amxmi", VALID)]


def test_an_interrupted_write_leaves_nothing_behind(changed, tmp_path, monkeypatch):
    def interrupt(*_arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        save(changed)
    assert [(entry.name, entry.read_bytes()) for entry in tmp_path.iterdir()] == [("model.amxmi", VALID)]


@pytest.mark.parametrize("name", ["missing/model.amxmi", "x" * 300, "a\0b"])
def test_a_place_that_cannot_be_written_to_is_told(changed, tmp_path, name):
    with pytest.raises(WriteError):
        save(changed, tmp_path / name)
    assert [entry.name for entry in tmp_path.iterdir()] == ["model.amxmi"]


@pytest.mark.parametrize("name", ["\0", "\ud800", "\uffff", "\x1b", 5, b"T"])
def test_values_that_cannot_be_written_leave_the_file_as_it_was(changed, tmp_path, name):
    changed[classes.Task, "new"].name = name
    with pytest.raises(WriteError):
        save(changed)
    assert [(entry.name, entry.read_bytes()) for entry in tmp_path.iterdir()] == [("model.amxmi", VALID)]


def test_of_several_files_none_is_written_if_one_has_errors(tmp_path):
    file(tmp_path, VALID, "a.amxmi")
    file(tmp_path, root('<swModel><tasks name="U"/></swModel>').encode(), "b.amxmi")
    before = {entry: entry.read_bytes() for entry in tmp_path.iterdir()}
    model = load(tmp_path)
    model[classes.Task, "T"].name = "new"
    model[classes.Task, "U"].name = "\0"
    with pytest.raises(WriteError):
        save(model)
    assert {entry: entry.read_bytes() for entry in tmp_path.iterdir()} == before
