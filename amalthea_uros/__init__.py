"""Timing models of micro-ROS and AMALTHEA (Eclipse APP4MC `.amxmi`): build, read, change, check, analyze.

>>> import amalthea_uros as amuros
>>> print(amuros.analyze("app.yaml"))                                          # doctest: +SKIP
>>> model = amuros.load("app.amxmi")                                           # doctest: +SKIP
>>> model[amuros.am.Task, "Executor_Task"].multiple_task_activation_limit = 2  # doctest: +SKIP
>>> amuros.save(model, "app.amxmi")                                            # doctest: +SKIP

This module is the public interface:

- answers about whatever describes a system (files, the text or content of an `app.yaml`, a model, a system): `analyze`, `simulate`,
  `what_if`; why, and what would be better: `explain`, `improvements`; their results have `to_records()` and
  `to_dataframe()`, and notebooks display them as tables
- synthetic tasks and chains without any file: `taskset`, `task`; random ones: `random_taskset`, `random_tasks`, `uunifast`,
  `uunifast_discard`, `log_uniform_periods`, `automotive_periods`
- analysis methods of your own beside those of the tool: `AnalysisMethod`, `method_bounds`
- pictures of results: `gantt`, `timeline`, `histogram`, `picture`
- files: `load`, `save`, `check_files`, `analyze_files`, `simulate_files`, `simulate_campaign`, `build`, `describe`, `diff`, `migrate`,
  with their results
- the files for the build of the firmware, and a description of code that exists: `generate`, `check_colcon_meta`, `import_code`,
  `import_recording`, with their results
- from measurements to better designs: `measure`, `compare`, `calibrate`, `optimize`, `sweep`, with their results
- reports of all of these as one HTML page: `report`
- events of simulations: `EventTable`; changes of values: `parse_change`, `parse_sweep`
- AMALTHEA models: `Model` (`Model.new()` is an empty one), `check`, `extract`; all AMALTHEA classes are in `amuros.am`
- systems of the generic performance model: `analyze_system`, `sensitivity`, `propose_priorities`, `paths`, `build_model`; their classes
  are in `amuros.perf`
- times with their unit: `Duration`; other quantities as text and numbers: `amuros.units`; exceptions: `amuros.errors`
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from amalthea_uros._internal.shown import Presenter, present_by
from amalthea_uros._version import __version__ as __version__

if TYPE_CHECKING:
    from amalthea_uros import am as am
    from amalthea_uros import errors as errors
    from amalthea_uros import perf as perf
    from amalthea_uros import units as units
    from amalthea_uros.analyze.impact import Effect as Effect
    from amalthea_uros.analyze.impact import Impact as Impact
    from amalthea_uros.analyze.impact import ImpactRow as ImpactRow
    from amalthea_uros.analyze.priorities.assignment import Proposal as Proposal
    from amalthea_uros.analyze.priorities.assignment import propose_priorities as propose_priorities
    from amalthea_uros.analyze.results.analysis import Analysis as Analysis
    from amalthea_uros.analyze.results.chains import ChainResult as ChainResult
    from amalthea_uros.analyze.results.chains import LatencyQuantity as LatencyQuantity
    from amalthea_uros.analyze.results.chains import LatencyValue as LatencyValue
    from amalthea_uros.analyze.results.processes import CallbackResult as CallbackResult
    from amalthea_uros.analyze.results.processes import Metric as Metric
    from amalthea_uros.analyze.results.processes import ProcessorResult as ProcessorResult
    from amalthea_uros.analyze.results.processes import ProcessResult as ProcessResult
    from amalthea_uros.analyze.results.processes import RequirementResult as RequirementResult
    from amalthea_uros.analyze.sensitivity import Sensitivity as Sensitivity
    from amalthea_uros.analyze.sensitivity import sensitivity as sensitivity
    from amalthea_uros.analyze.system import analyze_system as analyze_system
    from amalthea_uros.bridge.build import build_model as build_model
    from amalthea_uros.bridge.extract import Extraction as Extraction
    from amalthea_uros.bridge.extract import extract as extract
    from amalthea_uros.compare.calibration.calibration import Calibration as Calibration
    from amalthea_uros.compare.calibration.values import CalibratedValue as CalibratedValue
    from amalthea_uros.compare.naming import Meaning as Meaning
    from amalthea_uros.compare.naming import Names as Names
    from amalthea_uros.compare.results import Comparison as Comparison
    from amalthea_uros.compare.results import ComparisonRow as ComparisonRow
    from amalthea_uros.compare.results import MeasuredLimit as MeasuredLimit
    from amalthea_uros.design.campaign.run import CampaignRun as CampaignRun
    from amalthea_uros.design.campaign.run import RunOutcome as RunOutcome
    from amalthea_uros.design.campaign.simulations import CampaignResult as CampaignResult
    from amalthea_uros.design.campaign.sweeps import SweepResult as SweepResult
    from amalthea_uros.design.campaign.tables import write_table as write_table
    from amalthea_uros.design.changes.change import Change as Change
    from amalthea_uros.design.changes.change import Sweep as Sweep
    from amalthea_uros.design.changes.change import parse_change as parse_change
    from amalthea_uros.design.changes.change import parse_sweep as parse_sweep
    from amalthea_uros.design.improvements import Improvement as Improvement
    from amalthea_uros.design.improvements import Improvements as Improvements
    from amalthea_uros.design.optimize.problem import Conclusion as Conclusion
    from amalthea_uros.design.optimize.problem import SearchResult as SearchResult
    from amalthea_uros.design.proposals import DesignProposal as DesignProposal
    from amalthea_uros.design.random_tasksets import automotive_periods as automotive_periods
    from amalthea_uros.design.random_tasksets import log_uniform_periods as log_uniform_periods
    from amalthea_uros.design.random_tasksets import random_tasks as random_tasks
    from amalthea_uros.design.random_tasksets import random_taskset as random_taskset
    from amalthea_uros.design.random_tasksets import uunifast as uunifast
    from amalthea_uros.design.random_tasksets import uunifast_discard as uunifast_discard
    from amalthea_uros.design.task_parameters import TaskParameters as TaskParameters
    from amalthea_uros.design.task_parameters import task as task
    from amalthea_uros.design.taskset import taskset as taskset
    from amalthea_uros.diagnostics import Finding as Finding
    from amalthea_uros.diagnostics import Location as Location
    from amalthea_uros.diagnostics import Severity as Severity
    from amalthea_uros.diagnostics import ToolEffect as ToolEffect
    from amalthea_uros.errors import AmurosError as AmurosError
    from amalthea_uros.errors import InvalidArgumentError as InvalidArgumentError
    from amalthea_uros.errors import ReadError as ReadError
    from amalthea_uros.errors import WriteError as WriteError
    from amalthea_uros.executors.results import ExecutorResult as ExecutorResult
    from amalthea_uros.executors.results import HandleResult as HandleResult
    from amalthea_uros.executors.results import Hop as Hop
    from amalthea_uros.executors.results import HopKind as HopKind
    from amalthea_uros.executors.results import Loss as Loss
    from amalthea_uros.judge.summary import Schedulable as Schedulable
    from amalthea_uros.judge.summary import Summary as Summary
    from amalthea_uros.judge.verdict import Verdict as Verdict
    from amalthea_uros.measure.series import Counts as Counts
    from amalthea_uros.measure.series import Measurement as Measurement
    from amalthea_uros.measure.series import Series as Series
    from amalthea_uros.measure.series import Statistics as Statistics
    from amalthea_uros.metamodel.element import Element as Element
    from amalthea_uros.metamodel.model import Document as Document
    from amalthea_uros.metamodel.model import Model as Model
    from amalthea_uros.metamodel.model import Reference as Reference
    from amalthea_uros.perf.activities import Communication as Communication
    from amalthea_uros.perf.system import System as System
    from amalthea_uros.report.library import Report as Report
    from amalthea_uros.report.library import report as report
    from amalthea_uros.report.library_pictures import Picture as Picture
    from amalthea_uros.report.library_pictures import gantt as gantt
    from amalthea_uros.report.library_pictures import histogram as histogram
    from amalthea_uros.report.library_pictures import picture as picture
    from amalthea_uros.report.library_pictures import timeline as timeline
    from amalthea_uros.services.analyze import AnalysisResult as AnalysisResult
    from amalthea_uros.services.analyze import Explanation as Explanation
    from amalthea_uros.services.analyze import analyze as analyze
    from amalthea_uros.services.analyze import analyze_files as analyze_files
    from amalthea_uros.services.build import BuildResult as BuildResult
    from amalthea_uros.services.build import build as build
    from amalthea_uros.services.build import describe as describe
    from amalthea_uros.services.calibrate import calibrate as calibrate
    from amalthea_uros.services.check import CheckResult as CheckResult
    from amalthea_uros.services.check import check as check
    from amalthea_uros.services.check import check_files as check_files
    from amalthea_uros.services.compare import compare as compare
    from amalthea_uros.services.diff import DiffResult as DiffResult
    from amalthea_uros.services.diff import diff as diff
    from amalthea_uros.services.explain import explain as explain
    from amalthea_uros.services.explain import improvements as improvements
    from amalthea_uros.services.generate import GenerateResult as GenerateResult
    from amalthea_uros.services.generate import MetaCheck as MetaCheck
    from amalthea_uros.services.generate import check_colcon_meta as check_colcon_meta
    from amalthea_uros.services.generate import generate as generate
    from amalthea_uros.services.import_code import ImportResult as ImportResult
    from amalthea_uros.services.import_code import import_code as import_code
    from amalthea_uros.services.import_recording import import_recording as import_recording
    from amalthea_uros.services.measure import measure as measure
    from amalthea_uros.services.migrate import MigrationResult as MigrationResult
    from amalthea_uros.services.migrate import migrate as migrate
    from amalthea_uros.services.optimize import Optimization as Optimization
    from amalthea_uros.services.optimize import optimize as optimize
    from amalthea_uros.services.own_methods import AnalysisMethod as AnalysisMethod
    from amalthea_uros.services.own_methods import MethodBounds as MethodBounds
    from amalthea_uros.services.own_methods import method_bounds as method_bounds
    from amalthea_uros.services.simulate import SimulationResult as SimulationResult
    from amalthea_uros.services.simulate import simulate as simulate
    from amalthea_uros.services.simulate import simulate_campaign as simulate_campaign
    from amalthea_uros.services.simulate import simulate_files as simulate_files
    from amalthea_uros.services.sweep import sweep as sweep
    from amalthea_uros.services.what_if import WhatIf as WhatIf
    from amalthea_uros.services.what_if import what_if as what_if
    from amalthea_uros.simulate.options import Mode as Mode
    from amalthea_uros.simulate.options import Options as Options
    from amalthea_uros.simulate.results import Simulation as Simulation
    from amalthea_uros.timing.basics.quantities import JobMetric as JobMetric
    from amalthea_uros.timing.basics.settings import MemoryModel as MemoryModel
    from amalthea_uros.timing.basics.settings import Settings as Settings
    from amalthea_uros.timing.dataflow.paths import paths as paths
    from amalthea_uros.timing.response import Claim as Claim
    from amalthea_uros.timing.response import Response as Response
    from amalthea_uros.trace.table import Entity as Entity
    from amalthea_uros.trace.table import EntityKind as EntityKind
    from amalthea_uros.trace.table import EventKind as EventKind
    from amalthea_uros.trace.table import EventTable as EventTable
    from amalthea_uros.units import Duration as Duration
    from amalthea_uros.units import parse_time as parse_time
    from amalthea_uros.uros.assemble import Assembly as Assembly
    from amalthea_uros.uros.middleware.profile import Profile as Profile
    from amalthea_uros.validate.settings import CheckSettings as CheckSettings
    from amalthea_uros.xmi.load import load as load
    from amalthea_uros.xmi.save import save as save

_NAMES = {
    "analyze.impact": ("Effect", "Impact", "ImpactRow"),
    "analyze.priorities.assignment": ("Proposal", "propose_priorities"),
    "analyze.results.analysis": ("Analysis",),
    "analyze.results.chains": ("ChainResult", "LatencyQuantity", "LatencyValue"),
    "analyze.results.processes": ("CallbackResult", "Metric", "ProcessResult", "ProcessorResult", "RequirementResult"),
    "analyze.sensitivity": ("Sensitivity", "sensitivity"),
    "analyze.system": ("analyze_system",),
    "bridge.build": ("build_model",),
    "bridge.extract": ("Extraction", "extract"),
    "compare.calibration.calibration": ("Calibration",),
    "compare.calibration.values": ("CalibratedValue",),
    "compare.naming": ("Meaning", "Names"),
    "compare.results": ("Comparison", "ComparisonRow", "MeasuredLimit"),
    "design.campaign.run": ("CampaignRun", "RunOutcome"),
    "design.campaign.simulations": ("CampaignResult",),
    "design.campaign.sweeps": ("SweepResult",),
    "design.campaign.tables": ("write_table",),
    "design.changes.change": ("Change", "Sweep", "parse_change", "parse_sweep"),
    "design.improvements": ("Improvement", "Improvements"),
    "design.optimize.problem": ("Conclusion", "SearchResult"),
    "design.proposals": ("DesignProposal",),
    "design.random_tasksets": (
        "automotive_periods",
        "log_uniform_periods",
        "random_tasks",
        "random_taskset",
        "uunifast",
        "uunifast_discard",
    ),
    "design.task_parameters": ("TaskParameters", "task"),
    "design.taskset": ("taskset",),
    "diagnostics": ("Finding", "Location", "Severity", "ToolEffect"),
    "errors": ("AmurosError", "InvalidArgumentError", "ReadError", "WriteError"),
    "executors.results": ("ExecutorResult", "HandleResult", "Hop", "HopKind", "Loss"),
    "judge.summary": ("Schedulable", "Summary"),
    "judge.verdict": ("Verdict",),
    "measure.series": ("Counts", "Measurement", "Series", "Statistics"),
    "metamodel.element": ("Element",),
    "metamodel.model": ("Document", "Model", "Reference"),
    "perf.activities": ("Communication",),
    "perf.system": ("System",),
    "report.library": ("Report", "report"),
    "report.library_pictures": ("Picture", "gantt", "histogram", "picture", "timeline"),
    "services.analyze": ("AnalysisResult", "Explanation", "analyze", "analyze_files"),
    "services.build": ("BuildResult", "build", "describe"),
    "services.calibrate": ("calibrate",),
    "services.check": ("CheckResult", "check", "check_files"),
    "services.compare": ("compare",),
    "services.diff": ("DiffResult", "diff"),
    "services.explain": ("explain", "improvements"),
    "services.generate": ("GenerateResult", "MetaCheck", "check_colcon_meta", "generate"),
    "services.import_code": ("ImportResult", "import_code"),
    "services.import_recording": ("import_recording",),
    "services.measure": ("measure",),
    "services.migrate": ("MigrationResult", "migrate"),
    "services.optimize": ("Optimization", "optimize"),
    "services.own_methods": ("AnalysisMethod", "MethodBounds", "method_bounds"),
    "validate.settings": ("CheckSettings",),
    "services.simulate": ("SimulationResult", "simulate", "simulate_campaign", "simulate_files"),
    "services.sweep": ("sweep",),
    "services.what_if": ("WhatIf", "what_if"),
    "simulate.options": ("Mode", "Options"),
    "simulate.results": ("Simulation",),
    "timing.basics.quantities": ("JobMetric",),
    "timing.basics.settings": ("MemoryModel", "Settings"),
    "timing.dataflow.paths": ("paths",),
    "timing.response": ("Claim", "Response"),
    "trace.table": ("Entity", "EntityKind", "EventKind", "EventTable"),
    "units": ("Duration", "parse_time"),
    "uros.assemble": ("Assembly",),
    "uros.middleware.profile": ("Profile",),
    "xmi.load": ("load",),
    "xmi.save": ("save",),
}
_HOMES = {name: home for home, names in _NAMES.items() for name in names}
_NAMESPACES = ("am", "errors", "perf", "units")

__all__ = sorted([*_HOMES, *_NAMESPACES])


class _Package(ModuleType):
    """Keeps its functions when a room of the same name is imported, which Python would put in their place."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (name in _HOMES and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def _presenter() -> Presenter:
    """What shows results: the rooms that hold them do not know it."""
    from amalthea_uros.report import notebook

    return notebook


present_by(_presenter)


def __getattr__(name: str) -> Any:
    """Import a name when it is used: the command line starts without the four hundred AMALTHEA classes."""
    if name in _NAMESPACES:
        return import_module(f"{__name__}.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{_advice(name)}")
    value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def _advice(name: str) -> str:
    """Where a name may be found instead."""
    if name.startswith("_"):
        return ""
    if name[:1].isupper() and name in import_module(f"{__name__}.am").__all__:
        return f"; the AMALTHEA class is {__name__}.am.{name}"
    from amalthea_uros._internal.similar import did_you_mean

    near = did_you_mean(name, __all__)
    return f"; {near}" if near else ""


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
