"""Overloaded cores: the share of each process, and by how much the load has to decrease at least."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import ProcessorResult, ProcessResult
from amalthea_uros.report.basics.document import Cell, Section, Sentences, section, table
from amalthea_uros.report.wording.cells import at_least, at_most, load_text, priority_text, relief
from amalthea_uros.units import Rounding


def overload_sections(analysis: Analysis) -> Iterator[Section]:
    """The shares of the processes of each core that needs more than all of its time, the largest first."""
    for core in analysis.processors:
        load = core.at_least if core.is_overloaded or core.worst is None else core.worst
        here = [process for process in analysis.processes if process.processor == core.name and process.share is not None]
        if load > 1:
            columns = ("process", ">priority", ">WCET", ">at most every", ">load")
            rows = map(_row, sorted(here, key=lambda process: process.share or Fraction(0), reverse=True))
            yield section(f"Load of {core.name}", table("", columns, rows), Sentences([_remedy(core, load)]))


def _row(process: ProcessResult) -> tuple[Cell, ...]:
    return (
        process.name,
        priority_text(process.priority, process.is_isr),
        at_most(process.wcet),
        at_least(process.min_interarrival),
        load_text(process.share, Rounding.UP),
    )


def _remedy(core: ProcessorResult, load: Fraction) -> str:
    """By how much execution times have to be shorter, or the clock faster; what else there is to meet can need more."""
    if not core.is_overloaded:
        return f"The processes need up to {load_text(load, Rounding.UP)} of the core, unless modes exclude a part of it."
    return f"The processes need at least {load_text(load, Rounding.DOWN)} of the core: it takes {relief(core)}."


_REPEATED = r"overload: tasks at this priority or higher need [\d.,]+ % of the core\b"


def brief(reason: str, analysis: Analysis) -> str:
    """A reason without what the shares of an overloaded core show in more detail."""
    return re.sub(_REPEATED, "overload", reason) if any(core.is_overloaded for core in analysis.processors) else reason
