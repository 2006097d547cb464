"""Machine code is made where it pays, also in the first run."""

import os

import pytest

from amalthea_uros._internal import machine_code
from amalthea_uros._internal.machine_code import LOADING, CompilationEffort


@pytest.fixture(autouse=True)
def numba_in(monkeypatch, tmp_path):
    monkeypatch.setattr(machine_code, "is_available", lambda: True)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))


@pytest.fixture
def effort(tmp_path):
    source = tmp_path / "loop.py"
    source.touch()
    return CompilationEffort("a loop", [source], "play_*", compiling=25)


def keep(tmp_path, name="loop.play_a1b2-39.py311.nbi"):
    """What numba leaves: an index in a folder for each source."""
    folder = tmp_path / "cache" / "kernel_7f7d"
    folder.mkdir(parents=True)
    (folder / name).touch()
    return folder / name


def test_nothing_is_compiled_for_a_run_that_is_shorter_than_compiling(effort):
    assert [effort.pays_compiling(left) for left in (0, 5, 24, 26)] == [False, False, False, True]


def test_short_runs_compile_when_together_they_have_taken_as_long(effort):
    effort.spent = 24
    assert not effort.pays_compiling(left=5)
    effort.spent += 5
    assert effort.pays_compiling(left=5)


def test_what_numba_has_kept_pays_after_loading(effort, tmp_path):
    keep(tmp_path)
    assert [effort.pays_compiling(left) for left in (LOADING / 2, 2 * LOADING)] == [False, True]


def test_what_numba_has_kept_of_an_older_source_or_of_another_function_counts_for_nothing(effort, tmp_path):
    old = keep(tmp_path)
    os.utime(old, (0, 0))
    old.with_name("loop.replay-12.py311.nbi").touch()
    assert not effort.pays_compiling(left=5)


def test_without_numba_nothing_pays(effort, monkeypatch):
    monkeypatch.setattr(machine_code, "is_available", lambda: False)
    assert not effort.pays_compiling(left=10**6)


def test_the_log_says_why(effort, tmp_path, caplog):
    effort.spent = 0.31
    with caplog.at_level("INFO", logger="amalthea_uros"):
        effort.report(is_used=False)
        keep(tmp_path)
        effort.report(is_used=True, left=60.0)
    assert caplog.messages == [
        "machine code of a loop: not used, 0.3 s as Python, compiling takes about 25 s",
        "machine code of a loop: used, 60.0 s as Python, compiled by an earlier run",
    ]
