"""Reading BTF of all versions, and what is found in files with mistakes."""

import gzip
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_btf_writer import ENTITIES, LINES, PREEMPTION, in_nanoseconds
from traces import chunks, decoded, other_btf, random_trace, said, table

from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.trace.btf_format import escape, unescape
from amalthea_uros.trace.readers import open_trace
from amalthea_uros.trace.sinks import open_sink
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

HEADER = "#version 2.3.0\n#timescale ns\n"


@pytest.fixture
def read(tmp_path):
    return partial(decoded, tmp_path / "run.btf")


def test_a_preemption_also_with_blanks_and_line_ends_of_other_systems(read):
    for text in (HEADER + LINES, "\ufeff" + HEADER + "\r\n" + LINES.replace(",", ", ").replace("\n", " \r\n")):
        assert read(text) == (said(table(ENTITIES, in_nanoseconds(PREEMPTION))), ())


def test_numbers_of_types_and_entities(read):
    header = """\
#version 2.2.0
#timescale us
# a comment, with, many, commas, in, it, and, more
#typeMapping 0 C
#typeMapping 7 T
#entityMapping 12 Core_1
#entityMapping 40 Task A
#entityTypeMapping 0 12
#entityTypeMapping 7 40
#somethingNew 1 2 3
"""
    rows, findings = read(header + "3,12,0,7,40,5,start\n")
    core, task = Entity(EntityKind.CORE, "Core_1"), Entity(EntityKind.TASK, "Task A")
    assert [row[:6] for row in rows] == [(3_000_000, EventKind.START, core, 0, task, 5)]
    assert findings == ()


def test_the_tables_of_version_2_1(read):
    header = """\
#version 2.1.5
#creator Somebody's tool
#inputFile model.amxmi
#timeScale ns
#typeTable
#-0 T
#-1 STI
#-2 I
#entityTable
#-0 Task_1
#-1 Isr_1
#-5 Timer
#entityTypeTable
#-T Task_1
#-2 Isr_1
#-STI Timer
"""
    lines = """\
0,Core_1,-1,SIM,SIM,-1,tag,CORE_INIT
1,SIM,-1,1,5,0,trigger
1,5,0,0,0,0,activate
2,Core_1,,0,0,0,start
2,0,0,SIG,Speed,-1,write,3.5
3,0,0,SIG,Speed,-1,write,4
4,Sched,-1,SCHED,Sched,-1,schedule
5,Core_1,-1,0,0,0,boundedmigration
"""
    rows, findings = read(header + lines)
    task, timer, core = (
        Entity(EntityKind.TASK, "Task_1"),
        Entity(EntityKind.STIMULUS, "Timer"),
        Entity(EntityKind.CORE, "Core_1"),
    )
    speed, scheduler = Entity(EntityKind.LABEL, "Speed"), Entity(EntityKind.SCHEDULER, "Sched")
    assert [row[:6] for row in rows] == [
        (1000, EventKind.TRIGGER, timer, 0, timer, 0),
        (1000, EventKind.ACTIVATE, timer, 0, task, 0),
        (2000, EventKind.START, core, 0, task, 0),
        (2000, EventKind.WRITE, task, 0, speed, 0),
        (3000, EventKind.WRITE, task, 0, speed, 0),
        (4000, EventKind.SCHEDULE, scheduler, 0, scheduler, 0),
    ]
    assert rows[4][6] == 4
    assert findings == ()


def test_without_a_header_times_are_nanoseconds_and_that_is_said(read):
    rows, findings = read("5,Core_1,0,T,Task_A,0,start\n6,Core_1,0,T,Task_A,0,terminate\n")
    assert [row[0] for row in rows] == [5000, 6000]
    assert [(finding.rule, finding.severity, finding.location.line) for finding in findings] == [
        ("TRC005", Severity.WARNING, 1),
        ("TRC005", Severity.WARNING, 1),
    ]


def test_the_type_of_a_source_is_that_under_which_it_appears_later(read):
    rows, _ = read(HEADER + "1,X,0,R,Run,0,terminate\n2,Core_1,0,I,X,0,terminate\n")
    assert {row[2] for row in rows} == {Entity(EntityKind.ISR, "X"), Entity(EntityKind.CORE, "Core_1")}


@pytest.mark.parametrize(
    ("line", "rule", "column", "said_of_it"),
    [
        ("7,Core_1,0,T,Task_A,start", "TRC002", 1, "7 fields"),
        ("seven,Core_1,0,T,Task_A,0,start", "TRC002", 1, "time"),
        ("7,Core_1,x,T,Task_A,0,start", "TRC002", 10, "source instance"),
        ("7,Core_1,0,T,Task_A,0.5,start", "TRC002", 21, "target instance"),
        ("-7,Core_1,0,T,Task_A,0,start", "TRC002", 1, "negative or too large"),
        (f"{10**17},Core_1,0,T,Task_A,0,start", "TRC002", 1, "negative or too large"),
        (f"7,Core_1,0,T,Task_A,{2**63},start", "TRC002", 1, "negative or too large"),
        ("4,Core_1,0,T,Task_A,0,start", "TRC004", 1, "less than"),
        ("7,Core_1,0,T,Task_A,0,begin", "TRC003", None, "'begin' is not an event of entities of type 'T'"),
        ("7,Core_1,0,X,Task_A,0,start", "TRC003", None, "type 'X'"),
    ],
)
def test_a_wrong_line_is_reported_and_the_others_are_read(read, line, rule, column, said_of_it):
    good = "5,Core_1,0,T,Task_A,0,start\n", "9,Core_1,0,T,Task_A,0,terminate\n"
    rows, [finding] = read(HEADER + good[0] + line + "\n" + good[1])
    # Nobody knows which event the line was, so there is a gap; other tools may have events of their own.
    gaps = [(5000, EventKind.GAP)] * (rule != "TRC003")
    assert [row[:2] for row in rows] == [(5000, EventKind.START), *gaps, (9000, EventKind.TERMINATE)]
    assert (finding.rule, finding.location.line, finding.location.column) == (rule, 4, column)
    assert finding.location.text == line
    assert said_of_it in finding.message


def test_the_same_mistake_in_many_lines_is_one_finding(read):
    _, [finding] = read(HEADER + "nonsense\n" * 1000)
    assert finding.location.line == 3
    assert "(1000 times, this is the first)" in finding.message


@pytest.mark.parametrize(
    ("before", "between", "lines"),
    [("#version 2.3.0\n#timescale minutes\n", "", [2]), ("#version 2.3.0\n", "#timescale s\n", [2, 3])],
    ids=["does not exist", "comes too late"],
)
def test_a_timescale_that_is_not_taken(read, before, between, lines):
    rows, findings = read(f"{before}5,Core_1,0,T,Task_A,0,start\n{between}6,Core_1,0,T,Task_A,0,terminate\n")
    assert [row[0] for row in rows] == [5000, 6000]
    assert [(finding.rule, finding.location.line) for finding in findings] == [("TRC005", line) for line in lines]


def test_a_damaged_packed_file_is_read_up_to_the_damage(tmp_path):
    path = tmp_path / "run.btf.gz"
    path.write_bytes(gzip.compress((HEADER + LINES).encode())[:-10])
    reader = open_trace(path)
    list(reader)
    assert [finding.rule for finding in reader.findings] == ["TRC006"]


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(ReadError, match="file not found"):
        list(open_trace(tmp_path / "none.btf"))
    (tmp_path / "folder.btf").mkdir()
    with pytest.raises(ReadError, match="cannot be read"):
        list(open_trace(tmp_path / "folder.btf"))
    with pytest.raises(InvalidArgumentError, match=r"one of \.btf, \.csv"):
        open_trace(tmp_path / "run.txt")


# Characters that other programs take for the ends of lines are ordinary here; surrogates are no text.
names = st.text(st.characters(exclude_categories=["Cs"]), min_size=1)


@given(names)
def test_any_name_can_be_written(name):
    written = escape(name)
    assert unescape(written) == name
    assert written.strip(" ") == written
    assert not {",", "\n", "\r"} & set(written)


@given(names)
def test_an_ordinary_name_is_written_as_it_is(name):
    if name.isidentifier():
        assert escape(name) == name


@given(
    random=st.randoms(use_true_random=False),
    names=st.lists(names, min_size=12, max_size=12, unique=True),
    numeric=st.booleans(),
    is_in_nanoseconds=st.booleans(),
    size=st.integers(1, 40),
    suffix=st.sampled_from([".btf", ".btf.gz"]),
)
def test_what_is_written_is_read_again(tmp_path_factory, random, names, numeric, is_in_nanoseconds, size, suffix):
    trace = random_trace(random, names=names, unit=1000 if is_in_nanoseconds else 1)
    path = tmp_path_factory.mktemp("traces") / f"run{suffix}"
    with open_sink(path, trace.entities) as sink:
        for part in chunks(trace, size):
            sink.write(part)
    if suffix == ".btf":
        path.write_bytes(
            other_btf(path.read_bytes().decode(), is_numeric=numeric, is_in_nanoseconds=is_in_nanoseconds).encode()
        )
    reader = open_trace(path)
    assert (said(list(reader)), reader.findings, list(reader.entities)) == (said(trace), (), trace.entities)
