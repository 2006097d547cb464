"""What is said once need not be said again: findings of a kind in a row, and causes at the start of a report."""

from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
from hand_made_systems import Proc, ticks
from hand_made_systems import system as built
from support import ROOT

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.findings.catalogue import is_unreadable
from amalthea_uros.perf.events import ProcessEvent, RunnableEvent
from amalthea_uros.report.documents.opening import opening
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.report import compile_report
from amalthea_uros.services.subject import open_system


def finding(line, rule="ANA005", message="the task 'T' has no stimulus", severity=Severity.WARNING):
    return Finding(rule, severity, message.replace("'T'", f"'T{line}'"), Location(Path("m.amxmi"), line, 1))


def written(*findings):
    stream = StringIO()
    Terminal(stream).findings(findings)
    return stream.getvalue().splitlines()


class TestFindingsOfAKind:
    def test_of_many_in_a_row_three_are_written_and_the_others_located(self):
        lines = written(*map(finding, range(1, 16)))
        assert len(lines) == 4
        assert lines[2] == "m.amxmi:3:1: ANA005 warning: the task 'T3' has no stimulus"
        assert lines[3] == "  and 12 more ANA005 of this kind, in lines 4, 5, 6, 7, 8, 9, 10, 11, ..."

    def test_a_single_one_more_is_written(self):
        assert len(written(*map(finding, range(1, 5)))) == 4

    @pytest.mark.parametrize("other", [{"rule": "ANA004"}, {"message": "another message"}, {"severity": Severity.ERROR}])
    def test_others_are_of_another_kind(self, other):
        assert len(written(*map(finding, range(3)), *(finding(line, **other) for line in range(3, 6)))) == 6

    def test_a_long_reason_is_written_once(self):
        reason = "how much later one message is sent than another is not stated"
        one, other = written(*(finding(line, message=f"the pattern of 'T' is unknown: {reason}") for line in (1, 2)))
        assert one.endswith(f"'T1' is unknown: {reason}")
        assert other.endswith("'T2' is unknown: for the same reason")

    def test_a_quoted_value_is_no_reason(self):
        rest = "polling', the processor is busy while a message is on the line"
        lines = written(*(finding(line, message=f"with '{key}: {rest}") for line, key in enumerate(("write", "read"))))
        assert lines[1].endswith(f"with 'read: {rest}")


def test_a_report_begins_with_each_cause_once():
    text = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text()
    # Findings of analysis and simulation, and the limit of the chain, have this one cause.
    content = compile_report(_without_event_types(text), duration=10**9)
    reasons = [reason for _, reason in opening(content).reasons]
    assert sum("no event type" in reason for reason in reasons) == 1, reasons


def test_what_is_not_simulated_for_want_of_a_priority_is_unknown_for_that_already():
    # 6 us of 8 us, and 3 us of 20 us: the first one as the lowest needs 9 us.
    tasks = [Proc("T0", (ticks(6),), 8), Proc("T1", (ticks(3),), 20)]
    reasons = [reason for _, reason in opening(compile_report(built(*tasks), duration=10**9)).reasons]
    assert reasons[0] == "unknown: it has no priority; as the lowest it needs up to 9 us"
    assert [reason for reason in reasons if "not simulated" in reason] == ["'T1' is not simulated: it has no priority"]


def _without_event_types(text):
    system = open_system(text).system
    events = tuple(
        replace(event, change=None) if isinstance(event, ProcessEvent | RunnableEvent) else event
        for event in system.events.events
    )
    return replace(system, events=replace(system.events, events=events))


@pytest.mark.parametrize(
    ("rule", "severity", "is_so"), [("EXE008", "warning", False), ("XMI100", "error", True), ("XMI008", "info", False)]
)
def test_only_errors_make_a_description_unreadable(rule, severity, is_so):
    wrong = finding(1, rule="APP003", severity=Severity.ERROR)
    assert is_unreadable([finding(2, rule=rule, severity=Severity(severity)), wrong]) == is_so
