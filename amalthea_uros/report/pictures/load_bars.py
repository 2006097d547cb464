"""The loads of cores as bars: best, mean and worst case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import ProcessorResult
from amalthea_uros.report.pictures.axes import multiples, nice_step
from amalthea_uros.report.pictures.svg import (
    MARGIN,
    TEXT_SIZE,
    TOP,
    UNKNOWN,
    WIDTH,
    LegendEntry,
    Markup,
    document,
    draw_legend,
    element,
    elided,
    joined,
    number,
    text,
    text_width,
    tooltip,
)
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.units import Rounding

#: More cores are not drawn, those with the lowest loads.
MOST_CORES = 40
#: Pixels.
_ROW, _BAR, _GAP, _AXIS, _NARROWEST, _WIDEST, _TEXT = 34, 16, 10, 44, 60, 200, 290
#: The axis ends at least here and at most there, in percent.
_SHORTEST, _LONGEST, _PARTS = 100, 200, 10
_LOWEST = 1.0


@dataclass(frozen=True, slots=True)
class _Scale:
    """Loads from 0 to `end` percent in the pixels from `left` to `right`."""

    end: int
    left: float
    right: float

    def x(self, load: Fraction | int) -> float:
        """The pixel of a load; that of the end for a greater one."""
        return self.left + min(float(100 * load) / self.end, 1) * (self.right - self.left)


def draw_loads(analysis: Analysis) -> Markup:
    """The loads of all cores; if there are more than can be drawn, those with the highest ones."""
    cores = _shown(analysis.processors)
    if not cores:
        nothing = element("text", text("the model has no core"), class_="muted", x=MARGIN, y=TOP + 20)
        return document("Load of the cores", "no cores", (nothing,), TOP + 40)
    scale = _scale(cores)
    bottom = TOP + _ROW * len(cores)
    rows = [_row(core, TOP + _ROW * index, scale) for index, core in enumerate(cores)]
    legend, height = draw_legend(_legend(cores), _notes(analysis.processors), bottom + _AXIS + _GAP)
    body = (_grid(scale, bottom), *rows, _full(scale, bottom), legend)
    return document("Load of the cores", _subtitle(analysis.processors), body, height + MARGIN)


def _shown(cores: Sequence[ProcessorResult]) -> list[ProcessorResult]:
    kept = {core.name for core in sorted(cores, key=lambda core: core.at_least, reverse=True)[:MOST_CORES]}
    return [core for core in cores if core.name in kept]


def _scale(cores: Sequence[ProcessorResult]) -> _Scale:
    highest = max((float(100 * core.at_least) for core in cores), default=0)
    step = nice_step(_SHORTEST, _PARTS)
    end = min(max(_SHORTEST, -(-round(highest + 1) // step) * step), _LONGEST)
    widest = max((text_width(core.name, TEXT_SIZE) for core in cores), default=0)
    return _Scale(end, MARGIN + min(max(widest, _NARROWEST), _WIDEST) + _GAP, WIDTH - MARGIN - _TEXT)


def _row(core: ProcessorResult, top: float, scale: _Scale) -> Markup:
    name = element("text", text(elided(core.name, TEXT_SIZE, scale.left - MARGIN - _GAP)), x=MARGIN, y=top + 21)
    values = element("text", text(_values(core)), class_="small", x=scale.right + _GAP, y=top + 21)
    return element("g", tooltip(f"{core.name}: {_values(core)}"), name, _bars(core, top + (_ROW - _BAR) / 2, scale), values)


def _bars(core: ProcessorResult, top: float, scale: _Scale) -> Markup:
    """The worst case pale, the best case full, a line at the mean, and what is unknown hatched."""
    end = scale.x(core.at_least)
    look = "late" if core.is_overloaded else "c0"
    parts = [_bar(scale.left, end, top, class_=look, fill_opacity=0.3)] if core.at_least else []
    if core.best:
        parts.append(_bar(scale.left, scale.x(core.best), top + _BAR / 4, _BAR / 2, class_="c0"))
    if core.mean is not None and core.mean:
        parts.append(element("path", class_="line", d=f"M{number(scale.x(core.mean))} {number(top)}v{_BAR}"))
    if core.worst is None:
        parts.append(_bar(end, scale.right, top, fill=UNKNOWN))
    return joined(parts)


def _bar(left: float, right: float, top: float, height: float = _BAR, **look: str | float) -> Markup:
    return element("rect", x=left, y=top, width=max(right - left, _LOWEST), height=height, **look)


def _values(core: ProcessorResult) -> str:
    known = (("worst", core.worst, Rounding.UP), ("mean", core.mean, Rounding.NEAREST), ("best", core.best, Rounding.DOWN))
    texts = [f"{name} {load_text(load, rounding)}" for name, load, rounding in known if load is not None]
    return ", ".join(texts if core.worst is not None else (f"at least {load_text(core.at_least, Rounding.DOWN)}", *texts))


def _grid(scale: _Scale, bottom: float) -> Markup:
    parts: list[Markup] = []
    for percent in multiples(nice_step(scale.end, _PARTS), 0, scale.end):
        x = scale.x(Fraction(percent, 100))
        parts.append(element("path", class_="grid", d=f"M{number(x)} {TOP}V{number(bottom)}"))
        parts.append(element("text", text(f"{percent}"), class_="small", x=x, y=bottom + 17, text_anchor="middle"))
    middle = (scale.left + scale.right) / 2
    caption = element("text", text("load in %"), class_="small muted", x=middle, y=bottom + 34, text_anchor="middle")
    return joined((*parts, element("path", class_="rule", d=f"M{number(scale.left)} {bottom}H{number(scale.right)}"), caption))


def _full(scale: _Scale, bottom: float) -> Markup:
    return element("path", class_="alert", stroke_dasharray="6 3", d=f"M{number(scale.x(1))} {TOP - 4}V{number(bottom)}")


def _legend(cores: Sequence[ProcessorResult]) -> list[LegendEntry]:
    entries = [
        (any(core.at_least for core in cores), _key(-6, 12, class_="c0", fill_opacity=0.3), "worst case"),
        (any(core.best for core in cores), _key(-3, 6, class_="c0"), "best case"),
        (any(core.mean for core in cores), element("path", class_="line", d="M0 -7V7"), "mean"),
        (any(core.worst is None for core in cores), _key(-6, 12, fill=UNKNOWN), "unknown part of the worst case"),
        (any(core.is_overloaded for core in cores), _key(-6, 12, class_="late"), "overload"),
        (True, element("path", class_="alert", stroke_dasharray="6 3", d="M-9 0H9"), "100 %"),
    ]
    return [LegendEntry(key, meaning) for is_shown, key, meaning in entries if is_shown]


def _key(top: float, height: float, **look: str | float) -> Markup:
    return element("rect", x=-9, y=top, width=18, height=height, **look)


def _notes(cores: Sequence[ProcessorResult]) -> list[str]:
    notes = []
    if len(cores) > MOST_CORES:
        notes.append(f"{counted(len(cores) - MOST_CORES, 'core')} with lower loads not shown.")
    if any(100 * core.at_least > _LONGEST for core in cores):
        notes.append(f"Bars end at {_LONGEST} %; the numbers are complete.")
    return notes


def _subtitle(cores: Sequence[ProcessorResult]) -> str:
    highest = max(cores, key=lambda core: core.at_least)
    return f"{counted(len(cores), 'core')}, the highest load is that of {highest.name}: {_values(highest)}"
