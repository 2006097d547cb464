"""Text between tags is found wherever it stands, although files without any are read without looking at their white space."""

from __future__ import annotations

from pathlib import Path

import pytest

from amalthea_uros import load

_NAMESPACES = 'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmi:version="2.0"'


@pytest.mark.parametrize(("version", "rule"), [("3.3.0", "XMI015"), ("0.7.2", "XMI009")])
@pytest.mark.parametrize(
    "text",
    [
        "<swModel>word</swModel>",
        "<swModel> <labels name='L'/> word</swModel>",
        "<swModel><![CDATA[word]]></swModel>",
        "<swModel>\n  <!-- a comment --> word\n</swModel>",
        "<swModel>&#119;ord</swModel>",
        "<swModel><?tool data?>word</swModel>",
    ],
)
def test_text_is_reported(tmp_path: Path, text: str, version: str, rule: str) -> None:
    path = tmp_path / "m.amxmi"
    path.write_text(f'<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/{version}" {_NAMESPACES}>{text}</am:Amalthea>')
    assert [finding.rule for finding in load(path).findings if finding.rule == rule] == [rule]


def test_a_greater_than_sign_in_a_value_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "m.amxmi"
    model = (
        f'<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0" {_NAMESPACES}>\n  <swModel>\n    <labels name="a>b" '
    )
    path.write_text(f'{model}xmi:id="a%3Eb?type=Label"/>\n  </swModel>\n</am:Amalthea>\n')
    assert not load(path).findings
