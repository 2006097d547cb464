"""Results as documents: what is shown of each, once for all writers."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from amalthea_uros.report.basics.document import ResultDocument

#: Classes of results, and the modules with the functions that make documents of them.
DOCUMENTS = {
    "Analysis": "analysis.analysis_alone",
    "AnalysisResult": "analysis.analysis_document",
    "BuildResult": "descriptions.build_document",
    "Calibration": "measurement.calibration_document",
    "CampaignResult": "simulation.campaign_document",
    "Catalogue": "descriptions.catalogue_document",
    "ChainDetail": "explanation.chain_document",
    "CheckResult": "findings.check_document",
    "CheckStatistics": "findings.statistics_document",
    "Comparison": "comparison.comparison_document",
    "DiffResult": "models.diff_document",
    "Explanation": "explanation.explanation_document",
    "FilesDiff": "findings.patch_document",
    "FixResult": "findings.fix_document",
    "FormatResult": "findings.format_document",
    "GenerateResult": "descriptions.generate_document",
    "ImportResult": "descriptions.import_document",
    "InfoResult": "models.info_document",
    "InitResult": "descriptions.init_document",
    "MethodBounds": "own_methods.methods_document",
    "Measurement": "measurement.measurement_document",
    "MetaCheck": "findings.meta_document",
    "MigrationResult": "migration.migration_document",
    "Optimization": "search.optimization_document",
    "PathsResult": "explanation.paths_document",
    "ReportContent": "summary.summary_document",
    "Proposal": "changes.proposal_document",
    "RulesResult": "findings.rules_document",
    "Simulation": "simulation.simulation_alone",
    "SimulationResult": "simulation.simulation_document",
    "SweepResult": "search.sweep_document",
    "WhatIf": "changes.what_if_document",
}


def document_of(result: object) -> ResultDocument:
    """What is shown of a result."""
    module, _, function = DOCUMENTS[type(result).__name__].partition(".")
    found: ResultDocument = getattr(import_module(f"{__name__}.{module}"), function)(result)
    return found
