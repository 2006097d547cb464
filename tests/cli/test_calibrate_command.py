"""`amuros calibrate`: what goes where, and how it ends."""

import json
import shutil

import pytest
from command import amuros
from support import ROOT

NAMES = ("bodas-test-measured.yaml", "bodas-test-measured.log", "bodas-test-measured.markers.yml")


@pytest.fixture
def given(tmp_path, monkeypatch):
    for name in NAMES:
        shutil.copy(ROOT / "samples" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    return ("calibrate", *NAMES[:2], "--markers", NAMES[2])


def test_without_a_target_a_diff_is_shown_and_nothing_written(given, tmp_path):
    before = (tmp_path / NAMES[0]).read_bytes()
    run = amuros(*given)
    assert run.returncode == 0
    assert run.stdout.startswith("--- bodas-test-measured.yaml\n+++ bodas-test-measured.yaml (calibrated)\n@@")
    assert "Measured values and the description" in run.stderr
    assert (tmp_path / NAMES[0]).read_bytes() == before


def test_a_dry_run_writes_nothing(given, tmp_path):
    run = amuros(*given, "-o", "new.yaml", "--diff")
    assert run.stdout.startswith("---")
    assert not (tmp_path / "new.yaml").exists()


def test_the_description_itself_can_be_written(given, tmp_path):
    run = amuros(*given, "-o", NAMES[0])
    assert run.returncode == 0
    assert "9 measured values: 4 written, 5 confirmed" in run.stdout
    assert "# Control_Function.execution_time: measured in" in (tmp_path / NAMES[0]).read_text()
    again = amuros(*given, "-o", NAMES[0])
    assert "written" not in again.stdout


@pytest.mark.parametrize(
    ("target", "reason"), list(zip(NAMES[1:], ("does not end with .yaml", "-o would replace a file that is read"), strict=True))
)
def test_what_was_measured_is_not_replaced(given, target, reason, tmp_path):
    before = (tmp_path / target).read_bytes()
    run = amuros(*given, "-o", target)
    assert run.returncode == 2
    assert reason in run.stderr
    assert (tmp_path / target).read_bytes() == before


def test_a_refuted_value_is_an_error_and_the_file_is_written(given, tmp_path):
    text = (tmp_path / NAMES[0]).read_text().replace("execution_time: 4 us", "execution_time: 1 us")
    (tmp_path / NAMES[0]).write_text(text)
    run = amuros(*given, "-o", "new.yaml", "--output", "json")
    assert run.returncode == 1
    assert "CAL001" in run.stderr
    found = json.loads(run.stdout)
    assert found["refuted"] == 1
    assert found["changed"]
    assert (tmp_path / "new.yaml").read_text() != text


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--margin", "many"), "not a share"),
        (("--judge-on", "2"), "less than all"),
        (("-o", "no/such/folder.yaml"), "cannot be written"),
    ],
)
def test_wrong_use(given, options, message):
    run = amuros(*given, *options)
    assert run.returncode == 2
    assert message in run.stderr
