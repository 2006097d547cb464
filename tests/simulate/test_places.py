"""Machine code finds the numbers of the kernel by their address: no place may be outside of the memory, or count from its end."""

import pytest
from support import ROOT

from amalthea_uros import simulate
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.runs import driver


class Guarded:
    """The memory of the kernel, which has no other places than its own."""

    def __init__(self, numbers):
        self.numbers = numbers

    def __getitem__(self, place):
        assert place >= 0
        return self.numbers[place]

    def __setitem__(self, place, number):
        assert place >= 0
        self.numbers[place] = number


@pytest.mark.parametrize("path", sorted((ROOT / "samples").glob("*.yaml")), ids=lambda path: path.stem)
def test_the_kernel_stays_in_its_memory(path, monkeypatch):
    play, windows = driver.run_kernel, []
    monkeypatch.setattr(machine_code, "is_worth_it", lambda *_: False)
    monkeypatch.setattr(driver, "run_kernel", lambda memory: windows.append(1) or play(Guarded(memory)))
    simulate(path, duration="30 ms")
    assert windows
