"""What one goal costs in another: the designs that meet all limits, and the Pareto front among them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.optimize.problem import DesignEvaluation, Goal
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.axes import nice_steps
from amalthea_uros.report.pictures.page import MARGIN, TOP, WIDTH, Entry, columns, levels, picture_of, turned
from amalthea_uros.report.pictures.svg import Markup, element, number, path_of, text_at, tipped
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.services.optimize import Optimization
from amalthea_uros.units import number_text, time_text

#: Pixels.
_LEFT, _HEIGHT, _AXIS, _GAP = 90, 380, 56, 12
_RADIUS, _SMALL = 5.0, 3.5
_PARTS = 6
#: Goals that are shares of a core.
_SHARES = ("load", "balance")
_NAMES = {
    "latency": "largest latency relative to its limit",
    "load": "largest load of a core",
    "balance": "difference of the loads",
    "jitter": "largest response-time jitter",
    "changes": "number of changed values",
}


@dataclass(frozen=True, slots=True)
class _GoalAxis:
    """Values of the goal at an index from `low` to `high` in pixels; the greatest values first if the pixels fall."""

    goal: Goal
    index: int
    low: Fraction
    high: Fraction
    start: float
    end: float

    @classmethod
    def of(cls, result: Optimization, index: int, designs: Iterable[DesignEvaluation], start: float, end: float) -> _GoalAxis:
        """The axis that has room for all designs."""
        values = [_value(each, index) for each in designs]
        low, high = min(values), max(values)
        margin = (high - low) / 12 or abs(high) / 10 or Fraction(1)
        least = max(low - margin, Fraction(0)) if low >= 0 else low - margin
        return cls(result.goals[index], index, least, high + margin, start, end)

    def place(self, value: Fraction) -> float:
        """The pixel of a value."""
        return self.start + float((value - self.low) / (self.high - self.low)) * (self.end - self.start)

    def of_design(self, design: DesignEvaluation) -> float:
        """The pixel of a design."""
        return self.place(_value(design, self.index))

    def ticks(self) -> Iterator[tuple[float, str]]:
        """The pixels and texts of round values."""
        step = _step((self.high - self.low) / _PARTS)
        for count in range(int(-(-self.low // step)), int(self.high // step) + 1):
            yield self.place(step * count), self.text(step * count)

    def text(self, value: Fraction) -> str:
        """A value with its unit."""
        if self.goal.unit == "ps":
            return time_text(value)
        return load_text(value) if self.goal.name.endswith(_SHARES) else number_text(value)

    @property
    def name(self) -> str:
        """What it is, in words."""
        return _NAMES.get(self.goal.name, self.goal.name)


def draw_pareto(result: Optimization) -> Markup:
    """The first two goals of all designs that meet all limits, the present one and the proposals marked.

    Raises
    ------
    InvalidArgumentError : there are fewer than two goals with known values, or no design meets all limits.
    """
    across, up = _goals(result)
    designs, present = (
        [each for each in found if each.values[across] is not None and each.values[up] is not None]
        for found in (result.search.best, [result.present])
    )
    shown = [*designs, *present]
    if not designs:
        raise InvalidArgumentError("there is no design to draw that meets all limits and has known values of the goals")
    bottom = float(TOP + _HEIGHT)
    x = _GoalAxis.of(result, across, shown, _LEFT, WIDTH - MARGIN - _GAP)
    y = _GoalAxis.of(result, up, shown, bottom, TOP + _GAP)
    front = _front(designs, across, up)
    body = (
        *_grid(x, y, bottom),
        _steps([(x.of_design(each), y.of_design(each)) for each in front]),
        *(_dot(each, result, x, y, each in front) for each in reversed(designs)),
        *(_cross(each, x, y) for each in present),
    )
    entries: list[Entry] = [
        (True, element("circle", class_="c0", r=_RADIUS), "on the front; numbers are those of the proposals"),
        (True, element("circle", class_="t0 empty", r=_SMALL), "another design that meets all limits"),
        (present, path_of("alert", "M-5 -5l10 10m0 -10l-10 10"), "the present design"),
    ]
    subtitle = f"{counted(len(designs), 'design')} that meet all limits, {len(front)} on the front; {result.search.conclusion}"
    return picture_of(f"{x.name} against {y.name}", subtitle, body, bottom + _AXIS, entries)


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


def _front(designs: Iterable[DesignEvaluation], across: int, up: int) -> list[DesignEvaluation]:
    """The designs on the front of two goals, from left to right."""
    found: list[DesignEvaluation] = []
    for each in sorted(designs, key=lambda design: (_value(design, across), _value(design, up))):
        if not found or _value(each, up) < _value(found[-1], up):
            found.append(each)
    return found


def _step(span: Fraction) -> Fraction:
    """The smallest nice number that is not below a span."""
    scale = Fraction(1)
    while span * scale < 1:
        scale *= 10
    return next(Fraction(step) for step in nice_steps() if step >= span * scale) / scale


def _grid(x: _GoalAxis, y: _GoalAxis, bottom: float) -> Iterator[Markup]:
    yield from columns(x.ticks(), TOP, bottom)
    yield from levels(y.ticks(), _LEFT, WIDTH - MARGIN)
    yield path_of("rule", f"M{_LEFT} {TOP}V{number(bottom)}H{WIDTH - MARGIN}")
    yield text_at(x.name, (_LEFT + WIDTH - MARGIN) / 2, bottom + 36, "small muted", anchor="middle")
    yield turned(y.name, TOP, bottom)


def _steps(points: Sequence[tuple[float, float]]) -> Markup:
    """The front as steps: between two designs, nothing is better than the worse one of both."""
    (left, top), *rest = points
    return path_of("bound", f"M{number(left)} {number(top)}" + "".join(f"H{number(x)}V{number(y)}" for x, y in rest))


def _dot(design: DesignEvaluation, result: Optimization, x: _GoalAxis, y: _GoalAxis, is_on_front: bool) -> Markup:
    left, top = x.of_design(design), y.of_design(design)
    look, radius = ("c0", _RADIUS) if is_on_front else ("t0 empty", _SMALL)
    numbers = (
        text_at(str(number), left + 8, top - 7, "small header")
        for number, proposal in enumerate(result.proposals, start=1)
        if proposal.evaluation.candidate == design.candidate and is_on_front
    )
    return tipped(_about(design, x, y), element("circle", cx=left, cy=top, r=radius, class_=look), *numbers)


def _cross(design: DesignEvaluation, x: _GoalAxis, y: _GoalAxis) -> Markup:
    cross = f"M{number(x.of_design(design) - 5)} {number(y.of_design(design) - 5)}l10 10m0 -10l-10 10"
    return tipped(f"now: {_about(design, x, y)}", path_of("alert", cross))


def _about(design: DesignEvaluation, x: _GoalAxis, y: _GoalAxis) -> str:
    values = (f"{axis.goal.name} {axis.text(_value(design, axis.index))}" for axis in (x, y))
    return f"{', '.join(map(str, design.candidate)) or 'no change'}: {', '.join(values)}"
