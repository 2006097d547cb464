"""The loads of cores as bars: best, mean and worst case."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import ProcessorResult
from amalthea_uros.report.pictures.axes import multiples, nice_step
from amalthea_uros.report.pictures.page import (
    LIMIT,
    MARGIN,
    TOP,
    WIDTH,
    Entry,
    columns,
    limit_line,
    nothing,
    picture_of,
    swatch,
    unknown,
)
from amalthea_uros.report.pictures.svg import (
    TEXT_SIZE,
    Markup,
    horizontal,
    joined,
    path_of,
    rect_at,
    text_at,
    text_width,
    tipped,
    vertical,
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
class _LoadScale:
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
        return picture_of("Load of the cores", "no cores", [nothing("the model has no core")], TOP + 24)
    scale = _scale(cores)
    bottom = TOP + _ROW * len(cores)
    rows = [_row(core, TOP + _ROW * index, scale) for index, core in enumerate(cores)]
    body = (*_grid(scale, bottom), *rows, limit_line(vertical(scale.x(1), TOP - 4, bottom)))
    wires = analysis.solution.context.system.network.wire_cores
    subtitle, notes = _subtitle(analysis.processors, wires), _notes(analysis.processors)
    return picture_of(
        "Load of the cores and wires" if wires else "Load of the cores",
        subtitle,
        body,
        bottom + _AXIS + _GAP,
        _legend(cores),
        notes,
    )


def _shown(cores: Sequence[ProcessorResult]) -> list[ProcessorResult]:
    kept = {core.name for core in sorted(cores, key=_greatest, reverse=True)[:MOST_CORES]}
    return [core for core in cores if core.name in kept]


def _scale(cores: Sequence[ProcessorResult]) -> _LoadScale:
    highest = max((float(100 * _greatest(core)) for core in cores), default=0)
    step = nice_step(_SHORTEST, _PARTS)
    end = min(max(_SHORTEST, -(-round(highest + 1) // step) * step), _LONGEST)
    widest = max((text_width(core.name, TEXT_SIZE) for core in cores), default=0)
    return _LoadScale(end, MARGIN + min(max(widest, _NARROWEST), _WIDEST) + _GAP, WIDTH - MARGIN - _TEXT)


def _row(core: ProcessorResult, top: float, scale: _LoadScale) -> Markup:
    name = text_at(core.name, MARGIN, top + 21, room=scale.left - MARGIN - _GAP)
    values = text_at(_values(core), scale.right + _GAP, top + 21, "small")
    return tipped(f"{core.name}: {_values(core)}", name, _bars(core, top + (_ROW - _BAR) / 2, scale), values)


def _bars(core: ProcessorResult, top: float, scale: _LoadScale) -> Markup:
    """The worst case pale, the best case full, a line at the mean, and what is unknown hatched."""
    end = scale.x(_greatest(core))
    parts = []
    if _greatest(core):
        look = "late" if core.is_overloaded else "c0"
        parts.append(rect_at(look, scale.left, top, max(end - scale.left, _LOWEST), _BAR, fill_opacity=0.3))
    if core.best:
        width = max(scale.x(core.best) - scale.left, _LOWEST)
        parts.append(rect_at("c0", scale.left, top + _BAR / 4, width, _BAR / 2))
    if core.mean:
        parts.append(path_of("line", vertical(scale.x(core.mean), top, top + _BAR)))
    if core.worst is None:
        parts.append(unknown(end, top, max(scale.right - end, _LOWEST), _BAR))
    return joined(parts)


def _values(core: ProcessorResult) -> str:
    known = (("worst", core.worst, Rounding.UP), ("mean", core.mean, Rounding.NEAREST), ("best", core.best, Rounding.DOWN))
    texts = [f"{name} {load_text(load, rounding)}" for name, load, rounding in known if load is not None]
    return ", ".join(texts if core.worst is not None else (f"at least {load_text(core.at_least, Rounding.DOWN)}", *texts))


def _grid(scale: _LoadScale, bottom: float) -> Iterator[Markup]:
    percents = multiples(nice_step(scale.end, _PARTS), 0, scale.end)
    yield from columns(((scale.x(Fraction(percent, 100)), f"{percent}") for percent in percents), TOP, bottom)
    yield path_of("rule", horizontal(scale.left, scale.right, bottom))
    yield text_at("load in %", (scale.left + scale.right) / 2, bottom + 34, "small muted", anchor="middle")


def _legend(cores: Sequence[ProcessorResult]) -> list[Entry]:
    return [
        (any(_greatest(core) for core in cores), swatch("c0", fill_opacity=0.3), "worst case"),
        (any(core.best for core in cores), swatch("c0", 6), "best case"),
        (any(core.mean for core in cores), path_of("line", "M0 -7V7"), "mean"),
        (any(core.worst is None for core in cores), unknown(-9, -6, 18, 12), "unknown part of the worst case"),
        (any(core.is_overloaded for core in cores), swatch("late"), "overload"),
        (True, LIMIT, "100 %"),
    ]


def _notes(cores: Sequence[ProcessorResult]) -> list[str]:
    notes = []
    if len(cores) > MOST_CORES:
        notes.append(f"{counted(len(cores) - MOST_CORES, 'core')} with lower loads not shown.")
    if any(100 * _greatest(core) > _LONGEST for core in cores):
        notes.append(f"Bars end at {_LONGEST} %; the numbers are complete.")
    return notes


def _subtitle(cores: Sequence[ProcessorResult], wires: frozenset[str]) -> str:
    highest = max(cores, key=_greatest)
    sent = sum(core.name in wires for core in cores)
    kinds = ((len(cores) - sent, "core"), (sent, "wire direction"))
    which = " and ".join(counted(number, noun) for number, noun in kinds if number)
    return f"{which}, the highest load is that of {highest.name}: {_values(highest)}"


def _greatest(core: ProcessorResult) -> Fraction:
    """The worst-case load, or the part of it that is certain if the rest is unknown."""
    return core.at_least if core.worst is None else core.worst
