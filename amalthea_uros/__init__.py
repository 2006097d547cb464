"""AMALTHEA models (Eclipse APP4MC `.amxmi`) in Python.

>>> import amalthea_uros as amuros
>>> model = amuros.load("app.amxmi")                                        # doctest: +SKIP
>>> model[amuros.Task, "Executor_Task"].multiple_task_activation_limit = 2  # doctest: +SKIP
>>> amuros.save(model, "app.amxmi")                                         # doctest: +SKIP

The names of this module are the public interface: `load` and `save`, the model and its documents, findings and errors, every
AMALTHEA class and enumeration; `build` and `describe` for an `app.yaml`, `extract` and `build_model` between AMALTHEA models and
systems of the generic performance model, `analyze_system` for response times; `check` for rules.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from amalthea_uros.analyze.results import Analysis as Analysis
    from amalthea_uros.analyze.system import analyze_system as analyze_system
    from amalthea_uros.bridge.build import build_model as build_model
    from amalthea_uros.bridge.extract import Extraction as Extraction
    from amalthea_uros.bridge.extract import extract as extract
    from amalthea_uros.checking import check as check
    from amalthea_uros.diagnostics import Finding as Finding
    from amalthea_uros.diagnostics import Location as Location
    from amalthea_uros.errors import AmurosError as AmurosError
    from amalthea_uros.errors import ReadError as ReadError
    from amalthea_uros.errors import WriteError as WriteError
    from amalthea_uros.metamodel.classes import *  # noqa: F403
    from amalthea_uros.metamodel.element import Element as Element
    from amalthea_uros.metamodel.model import Document as Document
    from amalthea_uros.metamodel.model import Model as Model
    from amalthea_uros.metamodel.model import Reference as Reference
    from amalthea_uros.pipeline import Built as Built
    from amalthea_uros.pipeline import build as build
    from amalthea_uros.pipeline import describe as describe
    from amalthea_uros.timing.settings import Settings as Settings
    from amalthea_uros.uros.assemble import Assembly as Assembly
    from amalthea_uros.xmi.load import load as load
    from amalthea_uros.xmi.save import save as save

__version__ = "0.1.0"

_HOMES = {
    "Finding": "diagnostics",
    "Location": "diagnostics",
    "AmurosError": "errors",
    "ReadError": "errors",
    "WriteError": "errors",
    "Element": "metamodel.element",
    "Document": "metamodel.model",
    "Model": "metamodel.model",
    "Reference": "metamodel.model",
    "load": "xmi.load",
    "save": "xmi.save",
    "Analysis": "analyze.results",
    "Assembly": "uros.assemble",
    "Built": "pipeline",
    "Extraction": "bridge.extract",
    "Settings": "timing.settings",
    "analyze_system": "analyze.system",
    "build": "pipeline",
    "check": "checking",
    "build_model": "bridge.build",
    "describe": "pipeline",
    "extract": "bridge.extract",
}


def __getattr__(name: str) -> Any:
    """Import what is asked for: the command line starts without the four hundred classes."""
    if name in _HOMES:
        value = getattr(import_module(f"amalthea_uros.{_HOMES[name]}"), name)
    elif name == "__all__":
        classes = import_module("amalthea_uros.metamodel.classes")
        value = sorted({*_HOMES, *classes.__all__})
    elif name.startswith("_"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    else:
        classes = import_module("amalthea_uros.metamodel.classes")
        if name not in classes.__all__:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(classes, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__getattr__("__all__"), "__version__"]
