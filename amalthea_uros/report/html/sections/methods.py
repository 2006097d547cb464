"""Assumptions, methods and their sources."""

from __future__ import annotations

from amalthea_uros.report.html.blocks import Block, Heading, Section, Sentences
from amalthea_uros.report.html.provenance import methods
from amalthea_uros.services.report import ReportContent


def section(content: ReportContent) -> Section | None:
    """What the numbers rest on."""
    simulated = content.simulation.simulation.assumptions if content.simulation is not None else ()
    lists = {
        "Assumptions of the analysis": content.analysis.assumptions,
        "Assumptions of the simulation": tuple(each for each in simulated if each not in content.analysis.assumptions),
        "Methods and sources": methods(content.analysis),
    }
    blocks: list[Block] = []
    for title, sentences in lists.items():
        if sentences:
            blocks += (Heading(title), Sentences(list(sentences)))
    lead = "Each number holds under these assumptions, and was computed by a published method."
    return Section("methods", "Assumptions and methods", lead, blocks) if blocks else None
