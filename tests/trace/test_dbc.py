"""DBC files: identifiers, exact values of signals, and what they say about time."""

import subprocess
import sys
from fractions import Fraction

import pytest
from can_frames import EXTENDED, MS

from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.trace.can.dbc import read_dbc

pytest.importorskip("cantools")

TEXT = """VERSION ""
NS_ :
BS_:
BU_: ECU Tool
BO_ 2550136833 Times: 8 ECU
 SG_ Executor : 0|16@1+ (0.1,0) [0|6553.5] "us" Tool
 SG_ Signed : 16|16@1- (1,-5) [0|0] "" Vector__XXX
BO_ 291 Slow: 2 Vector__XXX
 SG_ Value : 7|16@0+ (0.001,1.5) [0|0] "ms" Tool
BO_ 292 Chosen: 3 ECU
 SG_ Which M : 0|8@1+ (1,0) [0|0] "" Tool
 SG_ First m0 : 8|8@1+ (1,0) [0|0] "" Tool
 SG_ Second m1 : 8|16@1+ (1,0) [0|0] "" Tool
BO_ 293 Real: 4 ECU
 SG_ Number : 0|32@1- (1,0) [0|0] "" Tool
SIG_VALTYPE_ 293 Number : 1;
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_ "GenMsgCycleTime" 100;
BA_ "GenMsgCycleTime" BO_ 2550136833 20;
BA_ "GenMsgCycleTime" BO_ 292 0;
"""


@pytest.fixture
def database(tmp_path):
    path = tmp_path / "bus.dbc"
    path.write_text(TEXT)
    return read_dbc(path)


def test_messages(database):
    times, slow = database.messages["Times"], database.messages["Slow"]
    assert (times.identifier, times.length) == (0x18000001 | EXTENDED, 8)
    assert slow.identifier == 0x123


def test_two_messages_of_one_name_are_refused_in_our_words_alone(tmp_path):
    path = tmp_path / "bus.dbc"
    path.write_text(TEXT.replace("SIG_VALTYPE_", "BO_ 9 Slow: 4 ECU\n\nSIG_VALTYPE_"))
    with pytest.raises(ReadError, match="2 messages have the name 'Slow'"):
        read_dbc(path)
    # Messages of a library reach standard error only where nothing else takes them, and pytest does.
    code = f"from pathlib import Path; from amalthea_uros.trace.can.dbc import read_dbc; read_dbc(Path({str(path)!r}))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "ReadError" in run.stderr
    assert "Overwriting" not in run.stderr


@pytest.mark.parametrize(
    ("line", "message", "line_number", "column"),
    [
        # Of a gigabyte each, if they were believed.
        ("BO_ 9 Long: 4294967295 ECU", "the message 'Long' has 4294967295 bytes; at most 1,785 are possible", 16, 13),
        (
            'BO_ 9 M: 4 ECU\n SG_ S : 0|2147483648@1+ (1,0) [0|0] "" X',
            "'S' has 2147483648 bits, but the message 'M' has 4 bytes",
            17,
            12,
        ),
        (
            'BO_ 9 M: 4 ECU\n SG_ S m1 : 32|8@1+ (1,0) [0|0] "" X',
            "'S' begins at bit 32, but the message 'M' has 4 bytes",
            17,
            13,
        ),
        ("SG_MUL_VAL_ 292 First Which 0-1, 5-99999999;", "more than 65,536 values of their multiplexers", 16, 29),
        (f"BO_ 9 Long: {'9' * 5000} ECU", "has 999999999999999999 bytes; at most", 16, 13),
    ],
    ids=["message", "signal", "place", "multiplexer", "digits"],
)
def test_sizes_that_cannot_be_are_refused_before_they_take_memory(tmp_path, line, message, line_number, column):
    path = tmp_path / "bus.dbc"
    path.write_text(TEXT.replace("SIG_VALTYPE_", f"{line}\nSIG_VALTYPE_"))
    with pytest.raises(ReadError) as caught:
        read_dbc(path)
    (finding,) = caught.value.findings
    assert message in finding.message
    assert (finding.rule, finding.location.line, finding.location.column) == ("CAN012", line_number, column)


def test_a_cycle_time_is_only_what_is_stated_for_the_message_itself(database):
    cycles = {name: message.cycle_time for name, message in database.messages.items()}
    assert cycles == {"Times": 20 * MS, "Slow": None, "Chosen": None, "Real": None}


@pytest.mark.parametrize(
    ("signal", "data", "value"),
    [
        ("Times.Executor", "2A01000000000000", Fraction(298, 10)),  # 0x012A = 298
        ("Times.Signed", "0000FFFF00000000", -6),  # -1 - 5
        ("Slow.Value", "0102", Fraction(258, 1000) + Fraction(3, 2)),  # the most significant byte first
        ("Times.Executor", "2A01", None),  # too short
        ("Chosen.First", "000700", 7),
        ("Chosen.First", "010700", None),  # the other signal is in its place
        ("Chosen.Second", "010701", 263),
        ("Chosen.Second", "090701", None),
        ("Real.Number", "0000C03F", Fraction(3, 2)),
        ("Real.Number", "0000C07F", None),  # not a number
    ],
)
def test_values_are_exact(database, signal, data, value):
    _, found = database.find(signal)
    assert found.value(bytes.fromhex(data)) == value


def test_the_raw_value(database):
    _, found = database.find("Times.Executor")
    assert (found.raw(bytes.fromhex("2A01000000000000")), found.bits) == (298, 16)


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("Timse.Executor", "has no message 'Timse'; did you mean 'Times'"),
        ("Times.Executer", "has no signal 'Executer'; did you mean 'Executor'"),
        ("Times", "has no signal ''; known: Executor, Signed"),
    ],
)
def test_unknown_names(database, text, answer):
    with pytest.raises(InvalidArgumentError, match=answer):
        database.find(text)


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (b'VERSION ""\nBO_ x\n', 2),
        (b"\x00\xff\x13", 1),
        (TEXT.replace("16|16@1-", "60|16@1-").encode(), None),  # outside of the message
        (TEXT.replace("BO_ 2550136833 20;", 'BO_ 2550136833 "x";').encode(), None),
    ],
)
def test_wrong_files_are_findings(tmp_path, content, line):
    path = tmp_path / "bus.dbc"
    path.write_bytes(content)
    with pytest.raises(ReadError) as error:
        read_dbc(path)
    [finding] = error.value.findings
    assert (finding.rule, finding.location.line) == ("CAN012", line)


def test_a_missing_file(tmp_path):
    with pytest.raises(ReadError, match="CAN012 error: file not found"):
        read_dbc(tmp_path / "missing.dbc")


def test_what_to_install_is_told(tmp_path, monkeypatch):
    for name in [name for name in __import__("sys").modules if name.startswith("cantools")]:
        monkeypatch.setitem(__import__("sys").modules, name, None)
    with pytest.raises(InvalidArgumentError, match=r"pip install amuros\[can\]"):
        read_dbc(tmp_path / "bus.dbc")
