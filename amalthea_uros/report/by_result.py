"""Modules that are named by the class of the result that they render: `check_result` for `CheckResult`."""

from __future__ import annotations

import re
from importlib import import_module
from pkgutil import iter_modules
from typing import Any


def rendered_in(folder: str) -> frozenset[str]:
    """The names of the result classes for which a folder has a module."""
    modules = iter_modules(import_module(f"{__package__}.{folder}").__path__)
    return frozenset("".join(part.capitalize() for part in module.name.split("_")) for module in modules)


def module_for(result: object, folder: str) -> Any:
    """The module of a folder that renders a result."""
    stem = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", type(result).__name__).lower()
    return import_module(f"{__package__}.{folder}.{stem}")
