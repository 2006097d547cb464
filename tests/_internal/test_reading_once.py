"""Descriptions and pipes are read once, however many readers ask for them."""

import os
from collections import Counter
from shutil import copy

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros._internal import files
from amalthea_uros._internal.file_writing import write_bytes
from amalthea_uros._internal.files import is_open_file, read_bytes, reading_once
from amalthea_uros._internal.limits import DESCRIPTION_SIZE, MODEL_SIZE

DESCRIPTION = ROOT / "samples" / "bodas-test-simple.yaml"
MODEL = ROOT / "samples" / "bodas-test-simple.amxmi"
MEASURED = ROOT / "samples" / "bodas-test-measured.yaml"


@pytest.fixture
def pipe():
    """Makes pipes with the content of files."""
    readers = []

    def make(path):
        reader, writer = os.pipe()
        readers.append(reader)
        os.write(writer, path.read_bytes())
        os.close(writer)
        return f"/dev/fd/{reader}"

    yield make
    for reader in readers:
        os.close(reader)


@pytest.fixture
def reads(monkeypatch):
    """How often each file is read."""
    counted, read = Counter(), files._read

    def counting(path, max_size):
        counted[path] += 1
        return read(path, max_size)

    monkeypatch.setattr(files, "_read", counting)
    return counted


@pytest.fixture
def path(tmp_path):
    return copy(DESCRIPTION, tmp_path / "app.yaml")


@pytest.mark.parametrize(
    "answer",
    [
        amuros.analyze,
        amuros.build,
        amuros.check_files,
        lambda path: amuros.explain(path, "Control_Function"),
        amuros.generate,
        amuros.optimize,
        lambda path: amuros.diff(path, path),
        lambda path: amuros.simulate(path, duration="2ms"),
        lambda path: amuros.what_if(path, ["Executor_Task.priority=2"]),
    ],
)
def test_a_description_is_read_once(answer, path, reads):
    answer(path)
    assert reads[path] == 1


def test_a_description_that_is_calibrated_is_read_once(reads):
    trace = amuros.measure(ROOT / "samples" / "bodas-test-measured.log", markers=MEASURED.with_suffix(".markers.yml"))
    amuros.calibrate(MEASURED, trace)
    assert reads[MEASURED] == 1


@pytest.mark.parametrize("removed", [0, 1])
def test_a_description_that_vanishes_meanwhile_was_read(removed, tmp_path, monkeypatch):
    pair = [copy(DESCRIPTION, tmp_path / name) for name in ("old.yaml", "new.yaml")]
    read = files._read

    def removing(path, max_size):
        content = read(path, max_size)
        if path == pair[removed]:
            path.unlink()
        return content

    monkeypatch.setattr(files, "_read", removing)
    assert not amuros.diff(*pair).described


@pytest.mark.parametrize("source", [DESCRIPTION, MODEL])
def test_a_pipe_is_known_by_its_content(source, pipe):
    assert amuros.analyze(pipe(source)).summary.schedulable == amuros.analyze(source).summary.schedulable
    found, expected = (amuros.check_files(path).findings for path in (pipe(source), source))
    assert [finding.message for finding in found] == [finding.message for finding in expected]


def test_pipes_are_compared(pipe):
    assert not amuros.diff(pipe(DESCRIPTION), pipe(DESCRIPTION)).changes
    assert not amuros.diff(pipe(DESCRIPTION), MODEL).changes


def test_every_call_reads_again(path):
    assert "Control_Function" in amuros.analyze(path).processes.names
    path.write_text(path.read_text().replace("Control_Function", "Controller"))
    assert "Controller" in amuros.analyze(path).processes.names


def test_readers_get_the_same_content_until_something_is_written(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"one")
    with reading_once():
        assert read_bytes(path, DESCRIPTION_SIZE) == b"one"
        path.write_bytes(b"two")
        with reading_once():
            assert read_bytes(path, DESCRIPTION_SIZE) == b"one"
        write_bytes(tmp_path / "other", b"")
        assert read_bytes(path, DESCRIPTION_SIZE) == b"two"


def test_a_pipe_is_kept_though_something_is_written(tmp_path, pipe):
    (tmp_path / "source").write_bytes(b"one")
    path = files.Path(pipe(tmp_path / "source"))
    with reading_once():
        for _ in range(2):
            assert read_bytes(path, MODEL_SIZE) == b"one"
            write_bytes(tmp_path / "other", b"")


def test_a_model_is_not_kept(reads):
    with reading_once():
        amuros.load(MODEL)
        amuros.load(MODEL)
    assert reads[MODEL] == 2


def test_open_files():
    assert is_open_file(files.STANDARD_INPUT)
    assert is_open_file(files.Path("/dev/fd/0"))
    assert not is_open_file(DESCRIPTION)
