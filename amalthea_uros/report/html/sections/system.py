"""The picture of the system."""

from __future__ import annotations

from amalthea_uros.report.html.blocks import Figure, Section
from amalthea_uros.report.pictures.system_picture import draw_system
from amalthea_uros.services.report import ReportContent


def section(content: ReportContent) -> Section | None:
    """The tasks on their cores, and the flows between them."""
    if not content.system.processes:
        return None
    lead = "Boxes are tasks and interrupts on their cores, the most urgent first; arrows are data and triggers, coloured lines chains."
    return Section("system", "System", lead, [Figure("system", draw_system(content.system, content.analysis))])
