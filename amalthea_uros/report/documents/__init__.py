"""Results as documents: what is shown of each, once for all writers."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from amalthea_uros.report.basics.document import Document

#: The modules that make documents of results, and their functions.
DOCUMENTS = {
    "AnalysisResult": ("analysis", "analysis_document"),
    "Comparison": ("comparison", "comparison_document"),
    "Measurement": ("measurement", "measurement_document"),
    "MigrationResult": ("migration", "migration_document"),
    "ReportContent": ("summary", "summary_document"),
    "SimulationResult": ("simulation", "simulation_document"),
}


def document_of(result: object) -> Document:
    """What is shown of a result."""
    module, function = DOCUMENTS[type(result).__name__]
    found: Document = getattr(import_module(f"{__name__}.{module}"), function)(result)
    return found
