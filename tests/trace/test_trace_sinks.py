"""Traces appear whole or not at all, in the format that their name stands for."""

import gzip
import io
import json
import os
from pathlib import Path
from random import Random

import pytest
from traces import random_trace, table

from amalthea_uros.errors import InvalidArgumentError, WriteError
from amalthea_uros.trace.sinks import open_sink
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

ENTITIES = [Entity(EntityKind.STIMULUS, "S")]
TRACE = table(ENTITIES, [(5, EventKind.TRIGGER, 0, 0, 0, 0)])
FORMATS = {
    "run.btf": b"#version 2.3.0\n",
    "run.csv": b"time_ps,",
    "run.log": b"",
    "run.json": b'{"traceEvents"',
    "run.perfetto.json": b'{"traceEvents"',
    "run.pftrace": b"\x0a",
    "run.perfetto-trace": b"\x0a",
}


def write(target, **options):
    with open_sink(target, ENTITIES, **options) as sink:
        sink.write(TRACE)


@pytest.mark.parametrize(("name", "begin"), FORMATS.items())
def test_the_name_stands_for_the_format(tmp_path, name, begin):
    write(tmp_path / name)
    plain = (tmp_path / name).read_bytes()
    assert plain.startswith(begin)
    write(tmp_path / f"{name.upper()}.GZ")
    assert gzip.decompress((tmp_path / f"{name.upper()}.GZ").read_bytes()) == plain


def test_a_stream_is_given_the_format(tmp_path):
    stream = io.BytesIO()
    write(stream, suffix=".btf")
    write(tmp_path / "run.btf")
    assert stream.getvalue() == (tmp_path / "run.btf").read_bytes()


@pytest.mark.parametrize("name", ["run.txt", "run", "run.gz", "btf"])
def test_an_unknown_format_is_refused_with_the_known_ones(tmp_path, name):
    with pytest.raises(InvalidArgumentError, match=r"'.*'; .* \.btf, .*\.json, \.csv, .*e\.g\. run\.btf\.gz"):
        open_sink(tmp_path / name, ENTITIES)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", [*FORMATS, "run.btf.gz"])
@pytest.mark.parametrize("former", [None, b"former"])
def test_after_an_exception_everything_is_as_it_was(tmp_path, name, former):
    path = tmp_path / name
    if former is not None:
        path.write_bytes(former)
    with pytest.raises(KeyError), open_sink(path, ENTITIES) as sink:  # noqa: PT012 - that it comes after an event is the point
        sink.write(TRACE)
        raise KeyError
    assert [found.read_bytes() for found in tmp_path.iterdir()] == ([] if former is None else [former])


def test_until_it_is_complete_the_former_file_is_there(tmp_path):
    path = tmp_path / "run.btf"
    path.write_bytes(b"former")
    sink = open_sink(path, ENTITIES)
    sink.write(TRACE)
    assert path.read_bytes() == b"former"
    sink.close()
    assert path.read_bytes().startswith(b"#version")
    sink.close()  # a second time does nothing


def test_a_place_that_cannot_be_written_to(tmp_path):
    for path in (tmp_path / "missing" / "run.btf", tmp_path):
        with pytest.raises(WriteError) as error:
            open_sink(path, ENTITIES, suffix=".btf")
        assert [finding.rule for finding in error.value.findings] == ["TRC101"]


def test_devices_are_written_and_links_remain(tmp_path):
    write(Path(os.devnull), suffix=".btf")
    assert not Path(os.devnull).is_file()
    file, link = tmp_path / "run.btf", tmp_path / "latest.btf"
    file.write_bytes(b"former")
    link.symlink_to(file)
    write(link)
    assert link.is_symlink()
    assert file.read_bytes().startswith(b"#version")


@pytest.mark.parametrize("name", [*FORMATS, "run.btf.gz"])
def test_equal_traces_are_equal_files(tmp_path, name):
    contents = []
    for folder in ("first", "second"):
        (tmp_path / folder).mkdir()
        trace = random_trace(Random(3), steps=300)
        with open_sink(tmp_path / folder / name, trace.entities) as sink:
            sink.write(trace)
        contents.append((tmp_path / folder / name).read_bytes())
    assert contents[0] == contents[1]


def test_a_trace_without_events_is_complete(tmp_path):
    with open_sink(tmp_path / "run.json", ENTITIES):
        pass
    assert {event["ph"] for event in json.loads((tmp_path / "run.json").read_text())["traceEvents"]} == {"M"}
