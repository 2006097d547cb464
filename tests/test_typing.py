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


MIXES = """
from amalthea_uros.timing.basics.time_base import max_time, min_time
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.units import MILLISECOND

MultiframeDemand.constant(MILLISECOND)
max_time(MILLISECOND, 3)
min_time(MILLISECOND, 3)
"""


def test_a_time_is_no_demand(tmp_path):
    (tmp_path / "mixes.py").write_text(MIXES)
    command = [sys.executable, "-m", "mypy", "--strict", str(tmp_path / "mixes.py")]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert run.stdout.count('has incompatible type "int"; expected "Ticks"') == 3, run.stdout
