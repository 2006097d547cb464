"""The load of the cores."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.analyze.results.processes import ProcessorResult
from amalthea_uros.report.html.blocks import Badge, Cell, Figure, Section, Tone, table
from amalthea_uros.report.html.times import UNKNOWN
from amalthea_uros.report.load_text import load_text
from amalthea_uros.report.pictures.load_bars import draw_loads
from amalthea_uros.services.report import ReportContent
from amalthea_uros.units import Rounding, frequency_text


def section(content: ReportContent) -> Section | None:
    """The best, mean and worst load of each core that executes something."""
    used = [core for core in content.analysis.processors if core.worst != 0]
    if not used:
        return None
    titles = ("core", ">clock", ">best", ">mean", ">worst", ">observed", "")
    rows = [_row(core, content) for core in used]
    lead = "The part of its time that a core needs for what is activated; above 100 % work piles up without end."
    return Section(
        "load",
        "Load of the cores",
        lead,
        [Figure("loads", draw_loads(content.analysis)), table("Load of each core", titles, rows)],
    )


def _row(core: ProcessorResult, content: ReportContent) -> tuple[Cell, ...]:
    worst = _load(core.worst, Rounding.UP)
    if core.worst is None and core.at_least:
        worst = f"at least {load_text(core.at_least, Rounding.DOWN)}"
    simulation = content.simulation.simulation if content.simulation is not None else None
    observed = simulation.cores[core.name].load if simulation is not None else None
    return (
        core.name,
        frequency_text(core.frequency) if core.frequency else UNKNOWN,
        _load(core.best, Rounding.DOWN),
        _load(core.mean),
        worst,
        "-" if observed is None else load_text(observed),
        _remark(core),
    )


def _load(load: Fraction | None, rounding: Rounding = Rounding.NEAREST) -> str:
    return UNKNOWN if load is None else load_text(load, rounding)


def _remark(core: ProcessorResult) -> Cell:
    if core.is_overloaded:
        return Badge("overload", Tone.BAD)
    return "" if core.worst is not None else Badge("partly unknown", Tone.UNKNOWN)
