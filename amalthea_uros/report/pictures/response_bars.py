"""Response times as bars: their share of the deadline, and what the worst case is made of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.judge.summary import urgency
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.svg import (
    MARGIN,
    MARK,
    SMALL_SIZE,
    TEXT_SIZE,
    TOP,
    UNKNOWN,
    WIDTH,
    LegendEntry,
    Markup,
    document,
    draw_legend,
    draw_verdict,
    element,
    elided,
    joined,
    number,
    text,
    tooltip,
    verdict_entries,
)
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
class _Row:
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
    nothing = element("text", text("the model has no processes"), class_="muted", x=MARGIN, y=TOP + _HEADER + 20)
    legend, height = draw_legend(_legend(rows), _notes(len(processes), rows), bottom + _GAP)
    body = (
        _headers() if rows else nothing,
        _deadline_line(bottom) if any(row.process.deadline for row in rows) else Markup(""),
        *(_drawn(row) for row in rows),
        legend,
    )
    return document("Response times", _subtitle(processes, simulation), body, height + MARGIN)


def _rows(processes: Sequence[ProcessResult], simulation: Simulation | None) -> list[_Row]:
    observed = {} if simulation is None else {each.name: each.response_time for each in simulation.processes}
    top = TOP + _HEADER
    return [_Row(process, observed.get(process.name), top + _ROW * index) for index, process in enumerate(processes)]


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
    return joined(element("text", text(name), class_="header small", x=x, y=TOP + 12) for x, name in columns)


def _deadline_x() -> float:
    return _SHARE + float(1 / _LONGEST) * (_SHARE_END - _SHARE)


def _deadline_line(bottom: float) -> Markup:
    d = f"M{number(_deadline_x())} {TOP + _HEADER - 4}V{number(bottom)}"
    return element("path", class_="alert", stroke_dasharray="6 3", d=d)


def _drawn(row: _Row) -> Markup:
    process = row.process
    shown = elided(process.name, TEXT_SIZE, _NAME)
    base = row.top + 18
    return element(
        "g",
        tooltip(_description(row)),
        element("rect", class_="band", x=MARGIN, y=row.top + 1, width=WIDTH - 2 * MARGIN, height=_ROW - 2),
        element("text", text(shown), x=MARGIN, y=base),
        draw_verdict(process.verdict, _TIMES - MARK, base - 4),
        element("text", text(elided(_times(row), SMALL_SIZE, _SHARE - _TIMES - _GAP)), class_="small", x=_TIMES, y=base),
        _share_bar(process, row.top + 6),
        _terms(row),
    )


def _times(row: _Row) -> str:
    if row.worst is None:
        return "unbounded" if row.process.response is not None and row.process.response.is_overload else "unknown"
    worst = rounded_time_text(row.worst, Rounding.UP, row.process.deadline)
    return worst if row.process.deadline is None else f"{worst} of {time_text(row.process.deadline)}"


def _share_bar(process: ProcessResult, top: float) -> Markup:
    share = _share(process)
    if process.deadline is None:
        return Markup("")
    if share is None:
        return element("rect", x=_SHARE, y=top, width=_SHARE_END - _SHARE, height=_BAR, fill=UNKNOWN)
    width = float(min(share, _LONGEST) / _LONGEST) * (_SHARE_END - _SHARE)
    bar = element("rect", class_="late" if share > 1 else "c0", x=_SHARE, y=top, width=max(width, _NARROWEST), height=_BAR)
    label = element("text", text(_percent(share)), class_="small", x=_SHARE_END + 4, y=top + 12)
    return joined((bar, label))


def _percent(share: Fraction) -> str:
    """Three significant digits, on the same side of the deadline as the share."""
    return "> 100 %" if 1 < share < Fraction(1005, 1000) else f"{float(100 * share):.3g} %"


def _terms(row: _Row) -> Markup:
    """The parts of the worst case one after the other; below them the response times that were observed."""
    if row.worst is None:
        reason = row.process.reason or (row.process.response.reason if row.process.response is not None else "")
        shown = elided(reason, SMALL_SIZE, _TERMS_END - _TERMS)
        return element("text", text(shown), class_="small muted", x=_TERMS, y=row.top + 18)
    start = -row.earlier
    end = max(row.worst, 0 if row.observed is None else row.observed.max, start + 1)

    def x(time: Time | Fraction) -> float:
        return _TERMS + float(Fraction(time - start) / Fraction(end - start)) * (_TERMS_END - _TERMS)

    parts, top, now = [], row.top + 6, start
    for term, length in row.terms:
        colour = _COLOURS.get(term, _OTHER)
        tip = tooltip(f"{row.process.name}: {term} {time_text(length)}")
        parts.append(
            element(
                "rect", tip, class_=f"c{colour}", x=x(now), y=top, width=max(x(now + length) - x(now), _NARROWEST), height=_BAR
            )
        )
        now += length
    if row.process.response is not None:
        parts.append(_tick(x(row.process.response.best), top, "line"))
    if start:
        parts.append(_tick(x(0), top, "instant"))
    if row.observed is not None:
        parts.append(_observed(x(row.observed.min), x(row.observed.max), top + _BAR + 7, row.observed))
    return joined(parts)


def _tick(x: float, top: float, style: str) -> Markup:
    return element("path", class_=style, d=f"M{number(x)} {number(top - 3)}v{_BAR + 6}")


def _observed(left: float, right: float, y: float, observed: MetricObservation) -> Markup:
    tip = tooltip(f"observed {_observed_text(observed)}")
    d = f"M{number(left)} {number(y - 3)}v6M{number(left)} {number(y)}H{number(right)}M{number(right)} {number(y - 3)}v6"
    return element("g", tip, element("path", class_="mark", d=d))


def _observed_text(observed: MetricObservation) -> str:
    return f"{rounded_time_text(observed.min, Rounding.DOWN)} to {rounded_time_text(observed.max, Rounding.UP)}"


def _description(row: _Row) -> str:
    response = row.process.response
    parts = [f"{row.process.name}: {_times(row)}"]
    if response is not None and row.worst is not None:
        parts += [f"best case {time_text(response.best)}", *(f"{term} {time_text(length)}" for term, length in row.terms)]
    if row.observed is not None:
        parts.append(f"observed {_observed_text(row.observed)}")
    if row.process.verdict is not None:
        parts.append(str(row.process.verdict))
    return ", ".join((*parts, *([row.process.reason] if row.process.reason else [])))


def _legend(rows: Sequence[_Row]) -> list[LegendEntry]:
    drawn = [row for row in rows if row.worst is not None]
    terms = dict.fromkeys(term for row in drawn for term, _ in row.terms)
    entries = [LegendEntry(_key(class_=f"c{_COLOURS.get(term, _OTHER)}"), _meaning(term)) for term in terms]
    marks: Iterable[tuple[bool, Markup, str]] = (
        (bool(drawn), element("path", class_="line", d="M0 -8V8"), "best case"),
        (any(row.earlier for row in drawn), element("path", class_="instant", d="M0 -8V8"), "activation in the busy window"),
        (any(row.observed for row in drawn), element("path", class_="mark", d="M-9 -3v6M-9 0H9M9 -3v6"), "observed"),
        (
            any(row.process.deadline for row in rows),
            element("path", class_="alert", stroke_dasharray="6 3", d="M-9 0H9"),
            "deadline",
        ),
        (any(row.process.deadline and row.worst is None for row in rows), _key(fill=UNKNOWN), "no bound"),
    )
    entries += [LegendEntry(key, meaning) for is_shown, key, meaning in marks if is_shown]
    return entries + verdict_entries({row.process.verdict for row in rows})


def _meaning(term: str) -> str:
    return "own execution" if term == "own" else term


def _key(**look: str) -> Markup:
    return element("rect", x=-9, y=-6, width=18, height=12, **look)


def _notes(number_of_processes: int, rows: Sequence[_Row]) -> list[str]:
    hidden = number_of_processes - len(rows)
    return [f"{counted(hidden, 'process')} farther from the deadline not shown."] if hidden else []


def _subtitle(processes: Sequence[ProcessResult], simulation: Simulation | None) -> str:
    verdicts = [process.verdict for process in processes if process.verdict is not None]
    found = (f"{verdicts.count(verdict)} {verdict}" for verdict in Verdict if verdict in verdicts)
    run = () if simulation is None else (f"observed in {time_text(simulation.duration)}",)
    return ", ".join((counted(len(processes), "process"), *found, *run))
