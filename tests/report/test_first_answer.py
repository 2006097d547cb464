"""What an analysis says first: the limit that decides, its largest part, and a change that helps; figures by hand."""

import re

import pytest
from support import ROOT

from amalthea_uros.editor.hover import hover_text
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.documents.analysis import analysis_document
from amalthea_uros.report.wording.answer import answer_lines
from amalthea_uros.services.analyze import analyze, analyze_files
from amalthea_uros.services.first_answer import first_answer
from amalthea_uros.units import MILLISECOND as MS

HEAD = "amuros: 1\nname: app\nhardware: {platform: single-core, frequency: 100 MHz}\ntasks:\n"
TWO = (
    "  - {name: H, period: 20 ms, execution_time: 6 ms, priority: 2}\n"
    "  - {name: U, period: %s, execution_time: %s, priority: 1, activation_limit: 2}\n"
)
PAGE = (ROOT / "docs" / "ten-tasks.md").read_text()
DRIVE = re.search(r'title="drive.yaml"\n(.*?)^```', PAGE, re.DOTALL | re.MULTILINE)[1]


def result_of(tmp_path, text):
    path = tmp_path / "app.yaml"
    path.write_text(text)
    return analyze_files(path)


@pytest.mark.parametrize(
    ("period", "execution", "first", "second"),
    [
        # 15 ms and two jobs of 6 ms, exactly.
        ("25 ms", "15 ms", "U, response time: at most 27 ms, limit 25 ms: missed by 2 ms", "15 ms (55.6%), own"),
        ("40 ms", "15 ms", "U, response time: at most 27 ms, limit 40 ms: met, 13 ms left", "15 ms (55.6%), own"),
        # 6 of 20 and 20 of 25 ms.
        ("25 ms", "20 ms", "Core: overloaded, at least 110 % of its time is needed", "U 80 %, H 30 %"),
    ],
)
def test_the_deadline_that_decides(period, execution, first, second, tmp_path):
    lines = list(answer_lines(first_answer(result_of(tmp_path, HEAD + TWO % (period, execution)))))
    assert lines[0].replace("Core_0", "Core") == first
    assert lines[1].endswith(second)


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    return result_of(tmp_path_factory.mktemp("drive"), DRIVE)


@pytest.fixture(scope="module")
def answer(drive):
    return first_answer(drive)


def test_the_recommended_change_is_enough_and_holds_in_the_edited_file(answer, drive, tmp_path):
    assert drive.analysis.chains["command-to-motor"].worst > 50 * MS
    assert answer.best.change.options == ("--set", "uros_task.sleep=1ms")
    edited = result_of(tmp_path, DRIVE.replace("sleep: 10 ms", "sleep: 1 ms"))
    assert answer.best.after == edited.analysis.chains["command-to-motor"].worst <= 50 * MS
    # An iteration of at most 595 us in each 0 to 1 ms of sleep, which is much of a core.
    assert any(each.name == "load of Core_0" for each in answer.best.drawbacks)


def test_what_people_change_is_tried_and_each_value_is_that_of_the_edited_file(answer):
    after = {each.change.text: each for each in answer.improvements.found}
    edits = {
        "driver.write dma -> blocking": ("write: dma", "write: blocking"),
        "serial.baud_rate 460800 -> 921600": ("baud_rate: 460800", "baud_rate: 921600"),
        "slow_status.message_size 312 B -> 156 B": ("message_size: 312 B", "message_size: 156 B"),
    }
    for text, (old, new) in edits.items():
        edited = analyze(DRIVE.replace(old, new))
        verdicts = [each.verdict for each in edited.requirements if each.object == "command-to-motor"]
        assert after[text].after == edited.chains["command-to-motor"].worst
        assert after[text].is_enough is all(verdict is Verdict.MET for verdict in verdicts)
    assert {each.is_enough for each in after.values()} == {True, False}


def test_a_wire_is_no_core(drive):
    titles = {section.title: section for section in analysis_document(drive).sections}
    names = [[row[0] for row in titles[title].blocks[0].rows] for title in ("Load", "Utilisation of wires")]
    assert names == [["Core_0"], ["Serial_to_controller", "Serial_to_agent"]]


def test_the_hover_over_a_chain_begins_with_the_answer(drive, answer):
    assert hover_text(drive, "command-to-motor").splitlines()[1] == next(answer_lines(answer))


def test_every_screen_of_the_page_fits_80_columns():
    screens = re.findall(r"^```console\n\$ [^\n]*\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    assert len(screens) >= 9
    assert max(len(line) for screen in screens for line in screen.splitlines()) <= 80


def test_the_page_counts_the_commands_that_it_shows():
    table = re.findall(r"^\| \[\d+\. [^|]*\| (\d+)[^|]*\| (\d+) \|", PAGE, re.MULTILINE)
    tasks = re.split(r"^## \d+\. ", PAGE, flags=re.MULTILINE)[1:]
    shown = [re.findall(r"^\$ (.*)", task, re.MULTILINE) for task in tasks]
    assert [int(commands) for commands, _ in table] == [sum(line.count("amuros ") for line in lines) for lines in shown]
    # Nothing but the commands: no file is edited between two of them.
    assert {edits for _, edits in table} == {"0"}
