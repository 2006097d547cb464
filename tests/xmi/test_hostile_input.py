"""Whatever is in a file, it is read as a model or refused in words; writing leaves the old file or the new one, nothing else."""

import io
import os
import random
import sys
import zipfile
from pathlib import Path

import pytest
from effort import every, examples
from hypothesis import given
from hypothesis import strategies as st
from support import DATA

from amalthea_uros import ReadError, WriteError, load, save
from amalthea_uros._internal import files
from amalthea_uros.cli.main import main
from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.model import Model
from amalthea_uros.xmi.emf.versions import version_of

#: A file as APP4MC writes it.
GOOD = (DATA / "brake.amxmi").read_bytes()

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

#: What a file holds, the rule that refuses it, and what is said.
REFUSED = {
    "text": (b"Hello, world!", "XMI002", "not XML"),
    "JSON": (b'{"a": 1}', "XMI002", "not XML"),
    "no elements": (DECLARATION.encode(), "XMI002", ""),
    "HTML": (b"<!DOCTYPE html>\n<html></html>", "XMI003", ""),
    "a DTD": (with_doctype(""), "XMI003", "document type declaration (DTD)"),
    "a billion laughs": (with_doctype(LAUGHS), "XMI003", "DTD"),
    "an external entity": (with_doctype('<!ENTITY a SYSTEM "file:///etc/passwd">'), "XMI003", "DTD"),
    "an external DTD": (root(declaration='<!DOCTYPE am:Amalthea SYSTEM "http://localhost/x.dtd">').encode(), "XMI003", "DTD"),
    "an entity that is not declared": (root("&a;").encode(), "XMI002", "undefined entity"),
    "a zip with several entries": (zipped(("a", VALID), ("b", VALID)), "XMI001", "contains 2 files, expected one"),
    "a zip with no entry": (zipped(), "XMI002", ""),
    "a zip in a zip": (zipped(("a", ARCHIVE)), "XMI002", ""),
    "a zip with an entry without a name": (
        ARCHIVE.replace(b"ResourceContents", b"\0" * 16),
        "XMI001",
        "contains a file without a name",
    ),
    # It packs a gigabyte in less than a kilobyte, and is unpacked as a whole.
    "a zip by bzip2": (
        zipped(("ResourceContents", VALID), method=zipfile.ZIP_BZIP2),
        "XMI001",
        "compressed by a method that AMALTHEA tools do not use",
    ),
    "half a zip": (ARCHIVE[: len(ARCHIVE) // 2], "XMI001", "damaged"),
    "a zip with a damaged entry": (ARCHIVE[:60] + bytes(20) + ARCHIVE[80:], "XMI001", ""),
    "another root": (b"<a/>", "XMI005", "<a>"),
    "another root of the namespace": (root().replace("am:Amalthea", "am:SWModel").encode(), "XMI005", "<am:SWModel>"),
    "another namespace": (root().replace("app4mc", "other").encode(), "XMI005", ""),
    "no namespace": (b"<Amalthea/>", "XMI005", ""),
    "a prefix without a namespace": (b"<am:Amalthea/>", "XMI005", ""),
    "a prefix of types without a namespace": (
        VALID.replace(b"xmlns:xsi", b"xmlns:x"),
        "XMI002",
        "undeclared namespace prefix 'xsi'",
    ),
    "an ITEA version": (
        b'<central:AMALTHEA xmlns:central="http://www.amalthea.itea2.org/model/1.0.0/central"/>',
        "XMI006",
        "ITEA 1.0.0 is no known version",
    ),
    "an older version": (root(version="0.8.9").encode(), "XMI006", "0.8.9"),
    "a path as version": (root(version="3.3.0/../..").encode(), "XMI005", "does not end with an AMALTHEA version"),
    "no version": (root(version="").encode(), "XMI005", ""),
    "a version with letters": (root(version="3.x").encode(), "XMI005", ""),
    "a version of long numbers": (root(version="3." + "9" * 5000).encode(), "XMI005", ""),
    "a version in other digits": (root(version="\u0663.\u0663.\u0660").encode(), "XMI005", ""),
    "bytes by chance": (random.Random(1).randbytes(500), "XMI002", ""),
    "zeros": (bytes(100), "XMI002", ""),
    "a zero byte inside": (VALID.replace(b"T?type", b"T\0type"), "XMI002", "not well-formed"),
    "nothing": (b"", "XMI001", "the file is empty"),
    "white space": (b" \r\n\t\n", "XMI001", "the file is empty"),
    "a byte order mark only": (b"\xef\xbb\xbf", "XMI001", ""),
    "invalid UTF-8": (VALID.replace(b'"T"', b'"\xff"'), "XMI002", "utf-8"),
    "a lone surrogate in UTF-8": (VALID.replace(b'"T"', b'"\xed\xa0\x80"'), "XMI002", ""),
    "half a character of UTF-16": (b"\xff\xfe<\0a", "XMI002", ""),
    "an unknown encoding": (declared("klingon"), "XMI002", "klingon"),
    "an encoding that is none": (declared("base64"), "XMI002", ""),
    "an encoding of Python source": (declared("unicode_escape", "\\ud800"), "XMI002", ""),
    "a surrogate in UTF-7": (declared("UTF-7").replace(b"></am", b' a="+2AA-"></am'), "XMI002", ""),
    "an encoding without letters": (declared("undefined"), "XMI002", ""),
    "an encoding of domain names": (declared("idna", "x" * 100), "XMI002", ""),
    "an encoding of punctuation": (declared("punycode", "x-99999999999"), "XMI002", ""),
    "deep nesting": (
        root('<customProperties><value xsi:type="am:ListObject">' + LIST_START * 5000).encode(),
        "XMI004",
        "nested",
    ),
    "an element that is not closed": (VALID[: VALID.index(b"</swModel>")], "XMI002", "SWModel on line 3 is not closed"),
    "another end tag": (VALID.replace(b"<tasks", b"<task"), "XMI002", "mismatched tag"),
    "an attribute twice": (VALID.replace(b'name="T"', b'name="T" name="U"'), "XMI002", "duplicate attribute"),
    "two roots": (VALID + b"<a/>", "XMI002", ""),
    "text after the root element": (VALID + b"a", "XMI002", ""),
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


@pytest.mark.parametrize(("data", "rule", "words"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_model_is_refused_with_words(data, rule, words, tmp_path):
    path = file(tmp_path, data)
    with pytest.raises(ReadError) as caught:
        load(path)
    check_refusal(caught.value, path)
    (finding,) = caught.value.findings
    assert finding.rule == rule
    assert words in finding.message


@pytest.mark.parametrize(("data", "rule"), [case[:2] for case in REFUSED.values()], ids=REFUSED)
def test_the_command_line_refuses_without_a_traceback(data, rule, tmp_path, monkeypatch, capfd):
    path = file(tmp_path, data)
    monkeypatch.setattr(sys, "argv", ["amuros", "fmt", "--check", str(path)])
    with pytest.raises(SystemExit) as caught:
        main()
    out, err = capfd.readouterr()
    assert (caught.value.code, out) == (2, "")
    assert rule in err
    assert "Traceback" not in err
    assert [(entry, entry.read_bytes()) for entry in tmp_path.iterdir()] == [(path, data)]


# Places that are no file


@pytest.mark.parametrize(
    ("place", "message"),
    {
        "missing": ("missing.amxmi", "file not found"),
        "a long name": ("a" * 300, None),
        "an impossible name": ("a\0b", None),
        "a folder without models": ("empty", r"no \.amxmi file"),
        "a file in place of a folder": ("file/model.amxmi", None),
    }.values(),
)
def test_a_place_without_a_model_is_refused(place, message, tmp_path):
    (tmp_path / "empty").mkdir()
    file(tmp_path, VALID, "file")
    with pytest.raises(ReadError, match=message):
        load(tmp_path / place)


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


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (VALID, "the file is larger than 300 bytes"),
        (zipped(("a", bytes(5000))), "the unpacked content is larger than 300 bytes"),
    ],
)
def test_what_is_larger_than_the_limit_is_refused_before_it_is_unpacked(data, message, tmp_path):
    with pytest.raises(ReadError, match=message) as caught:
        load(file(tmp_path, data), max_size=300)
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
    monkeypatch.setattr("amalthea_uros.xmi.emf.references.MODEL_REFERENCES", 5)
    many = "<swModel>" + '<tasks name="T" stimuli="a b c"/>' * 2 + "</swModel>"
    with pytest.raises(ReadError, match="more than 5 references in lists"):
        load(file(tmp_path, root(many).encode()))


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
    assert [finding.rule for finding in touched(path).findings] == ["XMI010"]
    assert path.read_bytes() == before


# Values that are none, and what else is odd


SIZE = '<swModel><labels><size value="{}"/></labels></swModel>'
ADDRESS = '<mappingModel><memoryMapping memoryPositionAddress="{}"/></mappingModel>'
NUMBERS = ["9" * 5000, "1e999999999", "", " ", "0x" + "f" * 5000, "\u0661", "1_000", "NaN", "1.5", "--1", "+"]
ADDRESSES = ["9" * 5000, "0" + "7" * 9000, "0x" + "f" * 9000, "-1", "08"]


@pytest.mark.parametrize("content", [*map(SIZE.format, NUMBERS), *map(ADDRESS.format, ADDRESSES)])
def test_odd_values_are_kept_as_they_stand(content, tmp_path):
    data = root(content).encode()
    path = file(tmp_path, data)
    touched(path)
    assert path.read_bytes() == data


def touched(path: Path) -> Model:
    """A file that was read and written again, each of its objects as if it had been changed."""
    model = load(path)
    model.documents[0].changes.modified.update(model.walk())
    save(model)
    return model


def test_values_of_a_wrong_kind_count_as_not_set_and_are_kept(tmp_path):
    path = tmp_path / "model.amxmi"
    text = GOOD.replace(b'Limit="1"', b'Limit="many"').replace(b'average="120.5"', b'average="' + b"9" * 200_000 + b'x"')
    path.write_bytes(text)
    model = load(path)
    assert [finding.rule for finding in model.findings] == ["XMI013", "XMI013"]
    assert model[classes.Task, "Brake (left)"].multiple_task_activation_limit is None
    save(model)
    assert path.read_bytes() == text


@pytest.mark.parametrize(
    ("old", "new", "rule", "words"),
    [
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
        findings = load(path).findings
    except ReadError as error:
        findings = error.findings
    found = {finding.rule: finding for finding in findings}
    assert words in found[rule].message
    assert found[rule].location.line


def test_a_near_name_is_suggested(tmp_path):
    path = tmp_path / "odd.amxmi"
    path.write_bytes(GOOD.replace(b'access="read"', b'acess="read"').replace(b'data="Pedal', b'data="Pedel'))
    helps = [finding.help for finding in load(path).findings]
    assert any("Did you mean 'access'?" in text for text in helps)
    assert any("Did you mean 'Pedal?type=Label'?" in text for text in helps)


@pytest.mark.parametrize("value", [10**5000, -(10**5000)], ids=["positive", "negative"])
def test_numbers_that_are_too_long_to_write_are_refused(value, tmp_path):
    path = file(tmp_path, VALID)
    model = load(path)
    model[classes.Task, "T"].size.value = value
    with pytest.raises(WriteError, match="value"):
        save(model)
    assert path.read_bytes() == VALID


# Files cut off, and with changed bytes


def is_read(path: Path, data: bytes) -> bool:
    """Whether a file is read, and not refused in words."""
    path.write_bytes(data)
    try:
        load(path)
    except ReadError as error:
        check_refusal(error, path)
        return False
    return True


@pytest.mark.parametrize("data", [VALID.rstrip(), ARCHIVE], ids=["text", "zip"])
def test_a_file_cut_off_anywhere_is_refused(data, tmp_path):
    for size in every(7, range(len(data))):
        assert not is_read(tmp_path / "cut.amxmi", data[:size]), size


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


def test_changed_bytes_are_refused_or_kept(tmp_path):
    rng, path, read = random.Random(0), tmp_path / "changed.amxmi", 0
    for _ in every(30, range(5000)):
        data = mutated(rng, VALID)
        if is_read(path, data):
            read += 1
            save(load(path))
            assert path.read_bytes() == data
            # A prefix that is used and not declared gets its declaration.
            if b" xmlns:xsi=" in data:
                touched(path)
                assert path.read_bytes() == data
    assert read


def test_a_zip_with_changed_bytes_is_read_or_refused(tmp_path):
    rng = random.Random(6)
    for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA):
        packed = zipped(("ResourceContents", VALID), method=method)
        for _ in every(10, range(300)):
            is_read(tmp_path / "changed.amxmi", mutated(rng, packed))


def test_a_token_without_an_end_is_parsed_again_a_few_times():
    """Each time, expat begins with it anew, so that pieces of one size took the square of its length."""
    calls = []

    def profile(_frame, event, function):
        if event == "c_call" and function.__name__ == "Parse":
            calls.append(function)

    sys.setprofile(profile)
    try:
        assert version_of(b"a" * 10**7) == ""
    finally:
        sys.setprofile(None)
    assert 0 < len(calls) < 15


@pytest.mark.parametrize("size", [9_990, 10_000, 20_001, 90_000])
def test_the_version_is_known_behind_a_comment_of_any_length(size):
    assert version_of(f"<!--{' ' * size}-->{root(declaration='')}".encode()) == "3.3.0"


@examples(40)
@given(st.binary(max_size=60))
def test_any_bytes_behind_a_declared_encoding_are_read_or_refused(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "bytes.amxmi"
    for encoding in ("utf-8", "utf-7", "utf-16", "cp037", "iso2022_jp", "raw_unicode_escape"):
        is_read(path, declared(encoding).replace(b"></am", b">" + data + b"</am"))


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


def test_values_that_are_not_allowed_are_all_named_and_nothing_is_written(tmp_path):
    model = load(file(tmp_path, GOOD))
    task = model[classes.Task, "Brake (left)"]
    task.preemption = "sometimes"
    task.multiple_task_activation_limit = 1.5
    task.stimuli.append(model[classes.Label, "Pedal"])
    model[classes.Label, "Pedal"].name = "Pe\x07dal"
    with pytest.raises(WriteError) as caught:
        save(model)
    messages = [finding.message for finding in caught.value.findings]
    assert len(messages) == 4
    assert any("Brake (left)" in m and "'preemption'" in m and "'sometimes'" in m for m in messages)
    assert any("'multiple_task_activation_limit' must be of type int, not 1.5" in m for m in messages)
    assert any("'stimuli' must be Stimulus" in m for m in messages)
    assert any("U+0007" in m for m in messages)
    assert (tmp_path / "model.amxmi").read_bytes() == GOOD


SWITCH = classes.ActivityGraph(items=[classes.ModeSwitch()])


@pytest.mark.parametrize(
    ("root_object", "version", "message"),
    [
        (
            classes.Amalthea(sw_model=classes.SWModel(runnables=[classes.Runnable(name="R", activity_graph=SWITCH)])),
            "3.0.0",
            r"R\.activityGraph\.items\[0\]: the class ModeSwitch does not exist in AMALTHEA 3\.0\.0",
        ),
        (
            classes.Amalthea(os_model=classes.OSModel(semaphores=[classes.Semaphore(name="S", ownership=True)])),
            "2.2.0",
            r"S: Semaphore has no feature 'ownership' in AMALTHEA 2\.2\.0",
        ),
    ],
)
def test_what_the_version_does_not_have_is_named(root_object, version, message, tmp_path):
    with pytest.raises(WriteError, match=message):
        save(Model.of(root_object, version), tmp_path / "m.amxmi")


def test_what_the_reader_would_refuse_as_too_deep_is_not_written(tmp_path):
    path = tmp_path / "deep.amxmi"

    def nested(levels):
        innermost = top = classes.Group(name="G")
        for _ in range(levels - 1):
            innermost.items.append(classes.Group(name="G"))
            innermost = innermost.items[0]
        runnable = classes.Runnable(name="R", activity_graph=classes.ActivityGraph(items=[top]))
        return Model.of(classes.Amalthea(sw_model=classes.SWModel(runnables=[runnable])))

    save(nested(196), path)
    text = path.read_text()
    assert sum(1 for _ in load(path).all(classes.Group)) == 196
    for levels in (197, 2000):
        with pytest.raises(WriteError, match="nested more than 200 levels deep"):
            save(nested(levels), path)
    assert path.read_text() == text
    innermost = '<items xsi:type="am:Group" name="G" ordered="true" interruptible="true"/>'
    path.write_text(text.replace(innermost, innermost.replace("/>", f">{innermost}</items>")))
    with pytest.raises(ReadError, match="200 levels deep"):
        load(path)
