"""What the evaluation of chains assumes."""

import pytest
from support import ROOT

from amalthea_uros import Communication, Settings, analyze_system, describe


@pytest.mark.parametrize("communication", Communication)
def test_what_equal_instants_mean_is_an_assumption_of_explicit_reads_only(communication):
    system = describe(ROOT / "samples" / "bodas-test-advanced.yaml").system
    found = analyze_system(system, Settings(communication=communication)).assumptions
    assert ("an explicit read sees what is written at the same instant" in found) is (communication is Communication.EXPLICIT)
