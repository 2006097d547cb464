import subprocess
import sys

import pytest
from support import ROOT

import amalthea_uros


def test_types_are_those_that_users_rely_on():
    command = [sys.executable, "-m", "mypy", "--strict", "--warn-unused-ignores", "tests/typing_baseline.py"]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert run.returncode == 0, run.stdout


@pytest.mark.parametrize("name", sorted(set(amalthea_uros.__all__)))
def test_every_public_name_is_there_and_told(name):
    assert getattr(amalthea_uros, name).__doc__


def test_no_other_name():
    with pytest.raises(AttributeError, match="has no attribute 'Tsk'"):
        amalthea_uros.Tsk  # noqa: B018
