"""Response times as bars: their share of the deadline, and what the worst case is made of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.judge.summary import urgency
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.page import (
    LIMIT,
    MARGIN,
    MARK,
    TOP,
    WIDTH,
    Entry,
    draw_verdict,
    limit_line,
    nothing,
    picture_of,
    swatch,
    unknown,
    verdict_entries,
)
from amalthea_uros.report.pictures.svg import Markup, horizontal, joined, path_of, rect_at, text_at, tipped, tooltip, vertical
from amalthea_uros.simulate.observations import MetricObservation
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

#: More processes are not drawn, those farthest from their deadlines.
MOST_ROWS = 40
#: Pixels: of a row, and of the columns for names, times, shares of deadlines and terms.
_ROW, _BAR, _HEADER, _GAP = 38, 14, 22, 12
_NAME = 190
_TIMES = MARGIN + _NAME + _GAP + MARK
_SHARE, _SHARE_END = _TIMES + 160, _TIMES + 330
_TERMS, _TERMS_END = _SHARE_END + 60, WIDTH - MARGIN
_NARROWEST = 1.0
#: Shares are drawn up to this one; the deadline is at two thirds of the column, so that a miss is seen.
_LONGEST = Fraction(3, 2)
#: The colours of the terms; other terms have the last one.
_COLOURS = {"own": 0, "interference": 1, "blocking": 4}
_OTHER = 3


@dataclass(frozen=True, slots=True)
class _ResponseRow:
    """A process, its observed response times, and its upper edge."""

    process: ProcessResult
    observed: MetricObservation | None
    top: float

    @property
    def worst(self) -> Time | None:
        """The worst-case response time, if there is a bound."""
        return None if self.process.response is None else self.process.response.worst

    @property
    def terms(self) -> list[tuple[str, Time]]:
        """The parts of the worst case that take time."""
        return [] if self.process.response is None else [item for item in self.process.response.terms.items() if item[1] > 0]

    @property
    def earlier(self) -> Time:
        """By how much the parts of the worst case begin before the activation of the worst job."""
        return sum(length for _, length in self.terms) - (self.worst or 0)


def draw_responses(analysis: Analysis, simulation: Simulation | None = None) -> Markup:
    """The response times of the processes, the tightest first.

    The shares of deadlines have the same scale for all. What a worst case is made of fills the width of its column, with the best case
    and the observed response times on the same scale: both are readable for periods of milliseconds beside those of seconds.
    """
    processes = sorted(analysis.processes, key=urgency)
    rows = _rows(processes[:MOST_ROWS], simulation)
    bottom = TOP + _HEADER + _ROW * max(len(rows), 1)
    deadline = _SHARE + float(1 / _LONGEST) * (_SHARE_END - _SHARE)
    body = (
        _headers() if rows else nothing("the model has no processes", TOP + _HEADER + 20),
        *([limit_line(vertical(deadline, TOP + _HEADER - 4, bottom))] if any(row.process.deadline for row in rows) else []),
        *map(_drawn, rows),
    )
    hidden = len(processes) - len(rows)
    notes = [f"{counted(hidden, 'process')} farther from the deadline not shown."] if hidden else []
    return picture_of("Response times", _subtitle(processes, simulation), body, bottom + _GAP, _legend(rows), notes)


def _rows(processes: Sequence[ProcessResult], simulation: Simulation | None) -> list[_ResponseRow]:
    observed = {} if simulation is None else {each.name: each.response_time for each in simulation.processes}
    top = TOP + _HEADER
    return [_ResponseRow(process, observed.get(process.name), top + _ROW * index) for index, process in enumerate(processes)]


def _share(process: ProcessResult) -> Fraction | None:
    if process.response is None or process.response.worst is None or not process.deadline:
        return None
    return Fraction(process.response.worst, process.deadline)


def _headers() -> Markup:
    columns = (
        (MARGIN, "process"),
        (_TIMES, "worst case of deadline"),
        (_SHARE, "share of deadline"),
        (_TERMS, "worst case is made of"),
    )
    return joined(text_at(name, x, TOP + 12, "header small") for x, name in columns)


def _drawn(row: _ResponseRow) -> Markup:
    process = row.process
    base = row.top + 18
    return tipped(
        _description(row),
        rect_at("band", MARGIN, row.top + 1, WIDTH - 2 * MARGIN, _ROW - 2),
        text_at(process.name, MARGIN, base, room=_NAME),
        draw_verdict(process.verdict, _TIMES - MARK, base - 4),
        text_at(_times(row), _TIMES, base, "small", room=_SHARE - _TIMES - _GAP),
        _share_bar(process, row.top + 6),
        _terms(row),
    )


def _times(row: _ResponseRow) -> str:
    if row.worst is None:
        return "unbounded" if row.process.response is not None and row.process.response.is_overload else "unknown"
    worst = rounded_time_text(row.worst, Rounding.UP, row.process.deadline)
    return worst if row.process.deadline is None else f"{worst} of {time_text(row.process.deadline)}"


def _share_bar(process: ProcessResult, top: float) -> Markup:
    share = _share(process)
    if process.deadline is None:
        return Markup("")
    if share is None:
        return unknown(_SHARE, top, _SHARE_END - _SHARE, _BAR)
    width = float(min(share, _LONGEST) / _LONGEST) * (_SHARE_END - _SHARE)
    bar = rect_at("late" if share > 1 else "c0", _SHARE, top, max(width, _NARROWEST), _BAR)
    label = text_at(_percent(share), _SHARE_END + 4, top + 12, "small")
    return joined((bar, label))


def _percent(share: Fraction) -> str:
    """Three significant digits, on the same side of the deadline as the share."""
    return "> 100 %" if 1 < share < Fraction(1005, 1000) else f"{float(100 * share):.3g} %"


def _terms(row: _ResponseRow) -> Markup:
    """The parts of the worst case one after the other; below them the response times that were observed."""
    if row.worst is None:
        reason = row.process.reason or (row.process.response.reason if row.process.response is not None else "")
        return text_at(reason, _TERMS, row.top + 18, "small muted", room=_TERMS_END - _TERMS)
    start = -row.earlier
    end = max(row.worst, 0 if row.observed is None else row.observed.max, start + 1)

    def x(time: Time | Fraction) -> float:
        return _TERMS + float(Fraction(time - start) / Fraction(end - start)) * (_TERMS_END - _TERMS)

    parts, top, now = [], row.top + 6, start
    for term, length in row.terms:
        colour = _COLOURS.get(term, _OTHER)
        tip = tooltip(f"{row.process.name}: {term} {time_text(length)}")
        parts.append(rect_at(f"c{colour}", x(now), top, max(x(now + length) - x(now), _NARROWEST), _BAR, tip))
        now += length
    if row.process.response is not None:
        parts.append(_tick(x(row.process.response.best), top, "line"))
    if start:
        parts.append(_tick(x(0), top, "instant"))
    if row.observed is not None:
        parts.append(_observed(x(row.observed.min), x(row.observed.max), top + _BAR + 7, row.observed))
    return joined(parts)


def _tick(x: float, top: float, style: str) -> Markup:
    return path_of(style, vertical(x, top - 3, top + _BAR + 3))


def _observed(left: float, right: float, y: float, observed: MetricObservation) -> Markup:
    d = vertical(left, y - 3, y + 3) + horizontal(left, right, y) + vertical(right, y - 3, y + 3)
    return tipped(f"observed {_observed_text(observed)}", path_of("mark", d))


def _observed_text(observed: MetricObservation) -> str:
    return f"{rounded_time_text(observed.min, Rounding.DOWN)} to {rounded_time_text(observed.max, Rounding.UP)}"


def _description(row: _ResponseRow) -> str:
    response = row.process.response
    parts = [f"{row.process.name}: {_times(row)}"]
    if response is not None and row.worst is not None:
        parts += [f"best case {time_text(response.best)}", *(f"{term} {time_text(length)}" for term, length in row.terms)]
    if row.observed is not None:
        parts.append(f"observed {_observed_text(row.observed)}")
    if row.process.verdict is not None:
        parts.append(str(row.process.verdict))
    return ", ".join((*parts, *([row.process.reason] if row.process.reason else [])))


def _legend(rows: Sequence[_ResponseRow]) -> Iterator[Entry]:
    drawn = [row for row in rows if row.worst is not None]
    for term in dict.fromkeys(term for row in drawn for term, _ in row.terms):
        yield True, swatch(f"c{_COLOURS.get(term, _OTHER)}"), "own execution" if term == "own" else term
    yield drawn, path_of("line", "M0 -8V8"), "best case"
    yield any(row.earlier for row in drawn), path_of("instant", "M0 -8V8"), "activation in the busy window"
    yield any(row.observed for row in drawn), path_of("mark", "M-9 -3v6M-9 0H9M9 -3v6"), "observed"
    yield any(row.process.deadline for row in rows), LIMIT, "deadline"
    yield any(row.process.deadline and row.worst is None for row in rows), unknown(-9, -6, 18, 12), "no bound"
    yield from verdict_entries({row.process.verdict for row in rows})


def _subtitle(processes: Sequence[ProcessResult], simulation: Simulation | None) -> str:
    verdicts = [process.verdict for process in processes if process.verdict is not None]
    found = (f"{verdicts.count(verdict)} {verdict}" for verdict in Verdict if verdict in verdicts)
    run = () if simulation is None else (f"observed in {time_text(simulation.duration)}",)
    return ", ".join((counted(len(processes), "process"), *found, *run))
