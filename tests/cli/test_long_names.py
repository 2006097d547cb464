"""Every screen fits a terminal of 80 columns, whatever the names of objects and files are."""

import pytest
from command import amuros
from effort import every

SIDE = "of_the_left_front_wheel_of_the_vehicle_whose_name_is_longer_than_a_line_of_it"
TEXT = f"""\
amuros: 1
name: app_{SIDE}
hardware: single-core
tasks:
  - {{name: Read_{SIDE}, period: 10 ms, execution_time: {{min: 1 ms, max: 2 ms}}, writes: [speed_{SIDE}]}}
  - {{name: Write_{SIDE}, period: 20 ms, execution_time: 3 ms, reads: [speed_{SIDE}]}}
chains:
  - {{name: chain_{SIDE}, path: [Read_{SIDE}, speed_{SIDE}, Write_{SIDE}], reaction: 5 ms}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("long")
    (folder / f"file_{SIDE}.yaml").write_text(TEXT)
    (folder / f"changed_{SIDE}.yaml").write_text(TEXT.replace("20 ms", "40 ms"))
    amuros("simulate", f"file_{SIDE}.yaml", "--duration", "1s", "--trace", "run.btf", cwd=folder)
    return folder


@pytest.mark.parametrize(
    "words",
    every(
        2,
        [
            "analyze FILE",
            "analyze FILE --keys",
            f"analyze FILE --explain chain_{SIDE}",
            f"analyze FILE --explain Write_{SIDE}",
            f"analyze FILE --set Read_{SIDE}.period=5ms",
            f"analyze FILE --set Read_{SIDE}.perod=5ms",
            "check FILE",
            "check MISSING",
            "simulate FILE --duration 1s",
            f"sweep FILE --sweep Read_{SIDE}.period=5ms,10ms",
            f"optimize FILE --offer Read_{SIDE}.period=5ms,10ms",
            "diff FILE CHANGED --impact",
            "info FILE",
            "measure run.btf",
            "compare FILE run.btf",
        ],
    ),
)
def test_a_screen_has_80_columns(words, folder, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    names = {"FILE": f"file_{SIDE}.yaml", "CHANGED": f"changed_{SIDE}.yaml", "MISSING": f"no_{SIDE}.yaml"}
    run = amuros(*(names.get(word, word) for word in words.split()), cwd=folder)
    lines = (run.stdout + run.stderr).splitlines()
    assert lines
    assert max(map(len, lines)) <= 80
