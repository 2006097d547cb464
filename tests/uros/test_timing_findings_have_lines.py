"""Findings about time in a description lead to the line that causes them."""

import re

import pytest
from support import ROOT

import amalthea_uros as amuros

SAMPLES = ROOT / "samples"
#: Sample, what is replaced in it, and the rule that finds something then, with a text of the line.
CASES = [
    ("bodas-test-advanced.yaml", r"reads: \[[^\]]*\]", "reads: []", "TIM-CHAIN-CARRIED", "path:"),
    ("drive-and-lift.yaml", r"reads: \[[^\]]*\]", "reads: []", "TIM-CHAIN-CARRIED", "p"),
    ("esp32-serial.yaml", r"period: [^,}\n]+", "period: 7 ms", "TIM-OVERLOAD", "serial:"),
    ("stm32-usb-cdc.yaml", r"period: [^,}\n]+", "period: 7 ms", "TIM-OVERLOAD", "usb_cdc:"),
]


@pytest.mark.parametrize(("sample", "old", "new", "rule", "text"), CASES)
def test_each_finding_has_a_line(tmp_path, sample, old, new, rule, text):
    path = tmp_path / "app.yaml"
    path.write_text(re.sub(old, new, (SAMPLES / sample).read_text(encoding="utf-8")), encoding="utf-8")
    found = [each for each in amuros.check_files(path, amuros.CheckSettings(select=("TIM-*",))).findings if each.rule == rule]
    assert found
    assert all(each.location.line and text in each.location.text for each in found)
