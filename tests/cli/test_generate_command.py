"""`amuros generate`: build options of the firmware on the command line."""

from command import amuros
from support import ROOT

APP = ROOT / "samples" / "drive-and-lift.yaml"


def test_what_is_written_passes_its_check(tmp_path):
    run = amuros("generate", APP, "-o", "new/firmware", cwd=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert "rebuild it from clean" in run.stdout
    meta = tmp_path / "new" / "firmware" / "colcon.meta"
    check = amuros("generate", APP, "--check", meta, cwd=tmp_path)
    assert (check.returncode, check.stderr) == (0, "")
    meta.write_text(meta.read_text().replace("MAX_NODES=2", "MAX_NODES=1"))
    check = amuros("generate", APP, "--check", meta, cwd=tmp_path)
    assert check.returncode == 1
    assert "GEN001" in check.stderr
    assert "Creating the last nodes fails." in check.stderr


def test_larger_than_necessary_is_no_failure(tmp_path):
    meta = tmp_path / "colcon.meta"
    meta.write_text('{"names": {"rmw_microxrcedds": {"cmake-args": ["-DRMW_UXRCE_MAX_NODES=3"]}}}')
    check = amuros("generate", APP, "--check", meta)
    assert check.returncode == 0
    assert "GEN002" in check.stderr


def test_exactly_one_of_both_is_asked_for(tmp_path):
    assert amuros("generate", APP).returncode == 2
    assert amuros("generate", APP, "-o", tmp_path, "--check", APP).returncode == 2
    assert amuros("generate", APP, "-o", "-", cwd=tmp_path).returncode == 2


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    run = amuros("generate", APP, "-o", tmp_path / "file" / "folder")
    assert run.returncode == 2
    assert "Traceback" not in run.stderr
    assert "the folder cannot be created" in run.stderr
