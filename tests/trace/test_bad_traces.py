"""Files that are no traces, or damaged ones, give findings and never an exception."""

import io
from pathlib import Path
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from state_charts import check_trace
from traces import encoded, other_btf, random_trace

from amalthea_uros.trace.readers import BY_NAME, open_trace
from amalthea_uros.trace.sinks import WRITERS, open_sink

BREAKERS = [
    b"\n",
    b"\r",
    b",",
    b'"',
    b"#",
    b"-",
    b"9" * 30,
    b"\x00",
    b"\xff",
    b"#timescale s\n",
    b"#-0 T\n",
    b"x" * 200_000,
    b"",
]


def read(path: Path):
    reader = open_trace(path)
    times = [table.time for table in reader]
    return np.concatenate(times) if times else np.array([])


@pytest.mark.parametrize("suffix", [known.suffix for known in BY_NAME])
@given(content=st.binary(max_size=300), packed=st.booleans())
def test_any_bytes(tmp_path_factory, suffix, content, packed):
    path = tmp_path_factory.mktemp("traces") / (f"run{suffix}.gz" if packed else f"run{suffix}")
    path.write_bytes(content)
    read(path)
    check_trace(path)


@pytest.mark.parametrize("suffix", [known.suffix for known in BY_NAME])
@given(
    seed=st.integers(0, 5),
    places=st.lists(st.tuples(st.floats(0, 1), st.sampled_from(BREAKERS), st.integers(0, 40)), max_size=6),
    numeric=st.booleans(),
)
def test_a_damaged_trace(tmp_path_factory, suffix, seed, places, numeric):
    path = tmp_path_factory.mktemp("traces") / f"run{suffix}"
    trace = random_trace(Random(seed))
    content = encoded(suffix, trace)
    if numeric and suffix == ".btf":
        content = other_btf(content.decode()).encode()
    for place, breaker, length in places:
        at = int(place * len(content))
        content = content[:at] + breaker.replace(b"LONG", b"x" * 200_000) + content[at + length :]
    path.write_bytes(content)
    times = read(path)
    assert (np.diff(times) >= 0).all()
    assert not len(times) or times[0] >= 0
    check_trace(path)
    for target in WRITERS:
        reader = open_trace(path)
        with open_sink(io.BytesIO(), reader.entities, suffix=target) as sink:
            for table in reader:
                sink.write(table)


@pytest.mark.parametrize("suffix", ["btf", "csv"])
def test_a_trace_without_line_ends_is_read_up_to_a_limit(suffix, tmp_path):
    path = tmp_path / f"endless.{suffix}"
    path.symlink_to("/dev/zero")
    reader = open_trace(path)
    assert sum(map(len, reader)) == 0
    assert "TRC002" in [finding.rule for finding in reader.findings]
    assert any("longer than 65,536 characters" in finding.message for finding in reader.findings)
