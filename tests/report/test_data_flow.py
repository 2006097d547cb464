"""Data flow for Mermaid and Graphviz: names cannot become syntax, and nothing is left out."""

import html
import re
import shutil
import subprocess

import pytest
from hand_made_systems import read, write
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros import analyze_files
from amalthea_uros.perf.software import Label, Software, Task
from amalthea_uros.perf.system import System
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.writers.graphs import dot, mermaid

NASTY = ["end", 'a"]b', "x;y|z", "li\nne", "ü→日", "&amp;#35;", "\\N \\", "<b>t</b>", "`md` **b**", "%%x", "--> q", "subgraph"]


def ring(*names):
    """Each task writes the label of its own name, which the next one reads."""
    before = (*names[-1:], *names[:-1])
    tasks = tuple(Task(name=name, activities=(write(name), read(other))) for name, other in zip(names, before, strict=True))
    return System(software=Software(tasks=tasks, labels=tuple(Label(name=name) for name in names)))


def test_a_sample_for_mermaid():
    text = mermaid(analyze_files(ROOT / "samples" / "bodas-test-advanced.yaml").system)
    assert text == (
        "flowchart LR\n"
        '  subgraph core0["Core_0"]\n'
        '    process0["Executor_Task<br/>every 1 ms"]\n'
        '    process2["Control_Function<br/>every 1 ms"]\n'
        '    process1["Message_Factor<br/>every 20 ms"]\n'
        "  end\n"
        '  process0 -->|"memory_1"| process1\n'
        '  process1 -->|"memory_2"| process2\n'
    )


def test_every_link_of_a_sample_is_an_arrow():
    system = analyze_files(ROOT / "samples" / "drive-and-lift.yaml").system
    # Twelve links between two processes each, and four stimuli that are not periodic.
    assert len(re.findall(r"-->|-\.->", mermaid(system))) == len(re.findall("->", dot(system))) == 12 + 4


NAMES = st.lists(st.text(min_size=1, max_size=12), min_size=2, max_size=5, unique_by=visible)
MERMAID_LINE = re.compile(
    r'flowchart LR|  subgraph core\d+\["[^"]*"\]|    process\d+\["[^"]*"\]|  end|  process\d+ -->\|"[^"]*"\| process\d+'
)


@given(NAMES)
def test_names_are_texts_for_mermaid(names):
    lines = mermaid(ring(*names)).splitlines()
    assert all(MERMAID_LINE.fullmatch(line) for line in lines)
    labels = [re.search(r'"([^"]*)<br/>', line)[1] for line in lines if line.startswith("    process")]
    assert all(re.fullmatch(r"(?:[A-Za-z0-9 ,.:_]|#\d+;)*", label) for label in labels)
    assert [re.sub(r"#(\d+);", lambda code: chr(int(code[1])), label) for label in labels] == list(map(visible, names))


@given(NAMES)
def test_names_are_texts_for_graphviz(names):
    # A quoted string ends at the first quote that has no backslash before it.
    found = re.findall(r'^    process\d+ \[label="((?:\\.|[^"\\])*)"\];$', dot(ring(*names)), re.MULTILINE)
    texts = [html.unescape(re.sub(r"\\(.)", r"\1", text.rpartition("\\n")[0])) for text in found]
    assert texts == list(map(visible, names))


@pytest.mark.skipif(shutil.which("dot") is None, reason="needs Graphviz")
def test_graphviz_draws_all_names():
    drawn = subprocess.run(["dot", "-Tsvg"], input=dot(ring(*NASTY)), text=True, capture_output=True, check=True, timeout=60)
    assert drawn.stderr == ""
    texts = {html.unescape(text) for text in re.findall(r"<text[^>]*>(.*?)</text>", drawn.stdout)}
    assert set(map(visible, NASTY)) <= {text.replace("\xa0", " ") for text in texts}
