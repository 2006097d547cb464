"""The programs of docs/frequent-problems.md: what is written for each is read when its gaps are filled."""

import re

import pytest
from importing import described
from support import ROOT

from amalthea_uros.errors import ReadError
from amalthea_uros.services.import_code import import_code

TEXT = (ROOT / "docs" / "frequent-problems.md").read_text()
PROGRAMS = dict(re.findall(r'^```cpp title="(.+?)"\n(.*?)^```', TEXT, re.DOTALL | re.MULTILINE))
#: The errors that are the problem: more handles than the executor was initialised with, and a message that is too long.
ERRORS = {"handles.cpp": {"EXE001"}, "odometry.cpp": {"UR121"}}


def test_there_are_fifteen():
    assert len(re.findall("^## ", TEXT, re.MULTILINE)) == 15
    assert len(PROGRAMS) == 14  # and a description


@pytest.mark.parametrize("name", PROGRAMS)
def test_what_is_written_is_read(name, tmp_path):
    (tmp_path / name).write_text(PROGRAMS[name])
    try:
        findings = described(import_code([tmp_path / name]), tmp_path)[1]
    except ReadError as error:
        findings = error.findings
    assert {each.rule for each in findings if each.severity == "error"} == ERRORS.get(name, set())
