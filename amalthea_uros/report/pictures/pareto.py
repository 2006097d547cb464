"""What one goal costs in another: the designs that meet all limits, and the Pareto front among them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.optimize.problem import DesignEvaluation, Goal
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.axes import nice_steps
from amalthea_uros.report.pictures.svg import (
    MARGIN,
    TOP,
    WIDTH,
    LegendEntry,
    Markup,
    document,
    draw_legend,
    element,
    joined,
    number,
    text,
    tooltip,
)
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.services.optimize import Optimization
from amalthea_uros.units import number_text, time_text

#: Pixels.
_LEFT, _HEIGHT, _AXIS, _GAP = 90, 380, 56, 12
_RADIUS, _SMALL = 5.0, 3.5
_PARTS = 6
#: Goals that are shares of a core.
_SHARES = ("load", "balance")


@dataclass(frozen=True, slots=True)
class _Axis:
    """Values of a goal from `low` to `high` in pixels; the greatest values first if the pixels fall."""

    goal: Goal
    low: Fraction
    high: Fraction
    start: float
    end: float

    def place(self, value: Fraction) -> float:
        """The pixel of a value."""
        return self.start + float((value - self.low) / (self.high - self.low)) * (self.end - self.start)

    def ticks(self) -> list[Fraction]:
        """Round values."""
        step = _step((self.high - self.low) / _PARTS)
        first = -(-self.low // step)
        return [step * count for count in range(int(first), int(self.high // step) + 1)]

    def text(self, value: Fraction) -> str:
        """A value with its unit."""
        if self.goal.unit == "ps":
            return time_text(value)
        return load_text(value) if self.goal.name.endswith(_SHARES) else number_text(value)


def draw_pareto(result: Optimization) -> Markup:
    """The first two goals of all designs that meet all limits, the present one and the proposals marked.

    Raises
    ------
    InvalidArgumentError : there are fewer than two goals with known values, or no design meets all limits.
    """
    across, up = _goals(result)
    designs = [each for each in result.search.best if each.values[across] is not None and each.values[up] is not None]
    if not designs:
        raise InvalidArgumentError("there is no design to draw that meets all limits and has known values of the goals")
    shown = [*designs, *([result.present] if None not in (result.present.values[across], result.present.values[up]) else [])]
    bottom = float(TOP + _HEIGHT)
    x = _axis(result.goals[across], [_value(each, across) for each in shown], _LEFT, WIDTH - MARGIN - _GAP)
    y = _axis(result.goals[up], [_value(each, up) for each in shown], bottom, TOP + _GAP)
    front = _front(designs, across, up)
    body = [
        _grid(x, y, bottom),
        _steps([(x.place(_value(each, across)), y.place(_value(each, up))) for each in front]),
        *(_dot(each, result, (across, up), (x, y), each in front) for each in reversed(designs)),
        *([_present(result, (across, up), (x, y))] if len(shown) > len(designs) else []),
    ]
    legend, height = draw_legend(_legend(len(shown) > len(designs)), (), bottom + _AXIS)
    subtitle = f"{counted(len(designs), 'design')} that meet all limits, {len(front)} on the front; {result.search.conclusion}"
    return document(f"{_name(x.goal)} against {_name(y.goal)}", subtitle, (*body, legend), height + MARGIN)


def _goals(result: Optimization) -> tuple[int, int]:
    """The two goals that are drawn: of more than two, the number of changes is the last choice."""
    order = sorted(range(len(result.goals)), key=lambda index: result.goals[index].name == "changes")
    if len(order) < 2:
        raise InvalidArgumentError("a Pareto front needs two goals, e.g. --goal latency --goal load")
    return order[0], order[1]


def _value(design: DesignEvaluation, index: int) -> Fraction:
    value = design.values[index]
    assert value is not None
    return value


def _front(designs: Sequence[DesignEvaluation], across: int, up: int) -> list[DesignEvaluation]:
    """The designs on the front of two goals, from left to right."""
    found: list[DesignEvaluation] = []
    for each in sorted(designs, key=lambda design: (_value(design, across), _value(design, up))):
        if not found or _value(each, up) < _value(found[-1], up):
            found.append(each)
    return found


def _axis(goal: Goal, values: Sequence[Fraction], start: float, end: float) -> _Axis:
    low, high = min(values), max(values)
    margin = (high - low) / 12 or abs(high) / 10 or Fraction(1)
    return _Axis(goal, max(low - margin, Fraction(0)) if low >= 0 else low - margin, high + margin, start, end)


def _step(span: Fraction) -> Fraction:
    """The smallest nice number that is not below a span."""
    scale = Fraction(1)
    while span * scale < 1:
        scale *= 10
    return next(Fraction(step) for step in nice_steps() if step >= span * scale) / scale


def _grid(x: _Axis, y: _Axis, bottom: float) -> Markup:
    parts: list[Markup] = []
    for tick in x.ticks():
        place = x.place(tick)
        parts.append(element("path", class_="grid", d=f"M{number(place)} {TOP}V{number(bottom)}"))
        parts.append(element("text", text(x.text(tick)), class_="small", x=place, y=bottom + 17, text_anchor="middle"))
    for tick in y.ticks():
        place = y.place(tick)
        parts.append(element("path", class_="grid", d=f"M{_LEFT} {number(place)}H{WIDTH - MARGIN}"))
        parts.append(element("text", text(y.text(tick)), class_="small", x=_LEFT - 8, y=place + 4, text_anchor="end"))
    parts.append(element("path", class_="rule", d=f"M{_LEFT} {TOP}V{number(bottom)}H{WIDTH - MARGIN}"))
    middle = (_LEFT + WIDTH - MARGIN) / 2
    parts.append(element("text", text(_name(x.goal)), class_="small muted", x=middle, y=bottom + 36, text_anchor="middle"))
    turned = f"rotate(-90 {MARGIN + 6} {number((TOP + bottom) / 2)})"
    name = element(
        "text",
        text(_name(y.goal)),
        class_="small muted",
        x=MARGIN + 6,
        y=(TOP + bottom) / 2,
        text_anchor="middle",
        transform=turned,
    )
    return joined((*parts, name))


def _steps(points: Sequence[tuple[float, float]]) -> Markup:
    """The front as steps: between two designs, nothing is better than the worse one of both."""
    (left, top), *rest = points
    line = f"M{number(left)} {number(top)}" + "".join(f"H{number(x)}V{number(y)}" for x, y in rest)
    return element("path", class_="bound", d=line)


def _dot(
    design: DesignEvaluation, result: Optimization, goals: tuple[int, int], axes: tuple[_Axis, _Axis], is_on_front: bool
) -> Markup:
    x, y = (axis.place(_value(design, goal)) for axis, goal in zip(axes, goals, strict=True))
    look: dict[str, str] = {"class_": "c0"} if is_on_front else {"class_": "t0 empty"}
    parts = [tooltip(_about(design, goals, axes)), element("circle", cx=x, cy=y, r=_RADIUS if is_on_front else _SMALL, **look)]
    for index, proposal in enumerate(result.proposals, start=1):
        if proposal.evaluation.candidate == design.candidate and is_on_front:
            parts.append(element("text", text(str(index)), class_="small header", x=x + 8, y=y - 7))
    return element("g", *parts)


def _present(result: Optimization, goals: tuple[int, int], axes: tuple[_Axis, _Axis]) -> Markup:
    x, y = (axis.place(_value(result.present, goal)) for axis, goal in zip(axes, goals, strict=True))
    cross = f"M{number(x - 5)} {number(y - 5)}l10 10m0 -10l-10 10"
    about = f"now: {_about(result.present, goals, axes)}"
    return element("g", tooltip(about), element("path", class_="alert", d=cross))


def _about(design: DesignEvaluation, goals: tuple[int, int], axes: tuple[_Axis, _Axis]) -> str:
    values = (f"{axis.goal.name} {axis.text(_value(design, goal))}" for axis, goal in zip(axes, goals, strict=True))
    return f"{', '.join(map(str, design.candidate)) or 'no change'}: {', '.join(values)}"


def _name(goal: Goal) -> str:
    return {
        "latency": "largest latency relative to its limit",
        "load": "largest load of a core",
        "balance": "difference of the loads",
        "jitter": "largest response-time jitter",
        "changes": "number of changed values",
    }.get(goal.name, goal.name)


def _legend(has_present: bool) -> list[LegendEntry]:
    entries = [
        LegendEntry(element("circle", class_="c0", r=_RADIUS), "on the front; numbers are those of the proposals"),
        LegendEntry(element("circle", class_="t0 empty", r=_SMALL), "another design that meets all limits"),
    ]
    if has_present:
        entries.append(LegendEntry(element("path", class_="alert", d="M-5 -5l10 10m0 -10l-10 10"), "the present design"))
    return entries
