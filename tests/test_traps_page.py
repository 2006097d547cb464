"""docs/micro-ros-traps.md: every example has the findings of its rows, and every finding about micro-ROS is on the page."""

import re
from functools import cache

import pytest
from support import ROOT

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.errors import ReadError
from amalthea_uros.findings import catalogue
from amalthea_uros.uros.described import describe_text
from amalthea_uros.validate import registry

TEXT = (ROOT / "docs" / "micro-ros-traps.md").read_text()
EXAMPLES = dict(re.findall(r'^```yaml title="(.+?)"\n(.*?)^```', TEXT, re.DOTALL | re.MULTILINE))
ROWS = [tuple(cell.strip() for cell in line.strip("|").split("|")) for line in TEXT.splitlines() if line.startswith("| ")]
TRAPS = [row for row in ROWS if row[0] != "trap"]
ID = re.compile(r"\b[A-Z]{2,3}\d{3}\b")
#: Findings about descriptions that are no traps of micro-ROS: the execution mapping of the thesis, links of chains.
ELSEWHERE = {"UR101", "UR102", "UR103", "UR104", "UR105", "UR107", "UR130"}


@cache
def results(example):
    """The ids of the findings of an example, and its assumptions."""
    try:
        described = describe_text(EXAMPLES[example]).assembly
    except ReadError as error:
        return {finding.rule for finding in error.findings}, ""
    analysis = analyze_system(described.system)
    return {finding.rule for finding in (*described.findings, *analysis.findings)}, "\n".join(analysis.assumptions)


@pytest.mark.parametrize("row", TRAPS, ids=lambda row: row[0][:40])
def test_the_examples_of_a_trap_show_it(row):
    _, shown, examples, source = row
    assert source
    names = re.findall(r"`([\w-]+\.yaml)`", examples)
    found = [results(name) for name in names]
    assert set(ID.findall(shown)) <= set().union(*(ids for ids, _ in found))
    assert all(any(quote in text for _, text in found) for quote in re.findall(r'"(.+?)"', shown))
    assert ID.search(shown) or '"' in shown


def test_every_example_belongs_to_a_trap():
    assert {name for row in TRAPS for name in re.findall(r"`([\w-]+\.yaml)`", row[2])} == EXAMPLES.keys()


def test_every_finding_about_micro_ros_is_on_the_page():
    kinds = {kind.id for kind in catalogue.kinds("EXE")} | {name for name in registry.ids() if name.startswith("UR")}
    assert kinds - ELSEWHERE == {name for row in TRAPS for name in ID.findall(row[1])}
