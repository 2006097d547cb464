"""Descriptions that are written to other folders name the same files."""

import shutil

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros._internal.files import STANDARD_OUTPUT
from amalthea_uros.compare.calibration.calibration import Calibration
from amalthea_uros.compare.calibration.options import CalibrationOptions
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.description.other_folder import moved
from amalthea_uros.services.changed_model import write_changed
from amalthea_uros.timing.basics.settings import Settings

ROBOT = """
amuros: 1
name: fleet
controllers:
  - {name: drive, file: two-controllers-drive.yaml} # the first one
  - name: lift
    file: &lift "./two-controllers-lift.yaml"
host: {ros: humble, computers: [{name: pc}], latency: 2 ms}
"""


@pytest.fixture
def folder(tmp_path):
    """A folder with a robot whose controllers have files, which name a database, and another folder."""
    for name in ("two-controllers-drive.yaml", "two-controllers-lift.yaml", "two-controllers.dbc"):
        (tmp_path / "robot").mkdir(exist_ok=True)
        shutil.copy(ROOT / "samples" / name, tmp_path / "robot" / name)
    (tmp_path / "robot" / "robot.yaml").write_text(ROBOT)
    (tmp_path / "results" / "best").mkdir(parents=True)
    return tmp_path


def test_the_files_of_controllers_are_the_same(folder):
    changed = folder / "results" / "best" / "robot.yaml"
    write_changed(folder / "robot" / "robot.yaml", [Change("host", "latency", "3ms")], Settings(), changed)
    expected = ROBOT.replace("latency: 2 ms", "latency: 3 ms").replace(
        "file: two-controllers", "file: ../../robot/two-controllers"
    )
    assert changed.read_text() == expected.replace('"./two-controllers', '"../../robot/two-controllers')
    assert len(amuros.analyze(changed).processes) == len(amuros.analyze(folder / "robot" / "robot.yaml").processes)


def test_a_database_is_the_same_one_after_a_calibration(folder):
    path = folder / "robot" / "two-controllers-drive.yaml"
    text = path.read_text()
    calibrated = Calibration(
        path=path, sources=(), options=CalibrationOptions(), values=(), before=text, text=text, findings=()
    )
    calibrated.write(folder / "results" / "drive.yaml")
    assert (folder / "results" / "drive.yaml").read_text() == text.replace("dbc: ", "dbc: ../robot/")
    calibrated.write(path)
    assert path.read_text() == text


@pytest.mark.parametrize("line", ["hardware: board.yaml", "hardware: {platform: ./board.yaml}", "os: {rtos: 'board.yaml'}"])
def test_files_of_the_user_are_told_from_names(folder, line):
    path, target = folder / "robot" / "app.yaml", folder / "results" / "app.yaml"
    assert moved(line, path, target) == line, "there is no such file"
    (folder / "robot" / "board.yaml").touch()
    assert moved(line, path, target) == line.replace("./", "").replace("board.yaml", "../robot/board.yaml")


@pytest.mark.parametrize("line", ["hardware: esp32", "labels: {board.yaml: 4 B}", "name: board.yaml", "file: /dev/null"])
def test_nothing_else_changes(folder, line):
    (folder / "robot" / "board.yaml").touch()
    (folder / "robot" / "esp32").touch()
    assert moved(line, folder / "robot" / "app.yaml", folder / "results" / "app.yaml") == line


def test_a_folder_that_is_a_link_is_where_it_leads_to(folder):
    (folder / "link").symlink_to(folder / "results" / "best")
    text = moved(ROBOT, folder / "robot" / "robot.yaml", folder / "link" / "robot.yaml")
    assert "file: ../../robot/two-controllers-drive.yaml" in text


def test_what_is_printed_stays_as_it_is(folder):
    assert moved(ROBOT, folder / "robot" / "robot.yaml", STANDARD_OUTPUT) == ROBOT
