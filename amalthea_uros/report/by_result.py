"""Modules that are named by the class of the result that they render: `check_result` for `CheckResult`."""

from __future__ import annotations

import re
from importlib import import_module
from importlib.resources import files
from typing import Any


def rendered_in(folder: str) -> frozenset[str]:
    """The names of the result classes for which a folder has a module."""
    entries = (entry.name for entry in files(__package__).joinpath(folder).iterdir())
    stems = (name.removesuffix(".py") for name in entries if name.endswith(".py") and not name.startswith("_"))
    return frozenset("".join(part.capitalize() for part in stem.split("_")) for stem in stems)


def module_for(result: object, folder: str) -> Any:
    """The module of a folder that renders a result."""
    stem = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", type(result).__name__).lower()
    return import_module(f"{__package__}.{folder}.{stem}")
