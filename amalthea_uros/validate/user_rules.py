"""Rules that users make: in a file of their own, or in an installed package with an entry point of the group `amuros.rules`."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import TYPE_CHECKING

from amalthea_uros._internal.entry_points import installed, instances_in, package_of
from amalthea_uros._internal.files import FileError, read_text
from amalthea_uros._internal.limits import RULES_SIZE
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.validate.rule import ModelRule

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "amuros.rules"
#: The list of a module that names its rules.
_LIST = "RULES"

#: Ids are written in lists with commas, also in comments of a line.
_ID = re.compile(r"[A-Za-z][\w./-]*")


def rules_of_file(path: Path) -> list[ModelRule]:
    """The rules that a Python file defines: those of its list `RULES`, or else all of the module. The file is executed.

    Raises
    ------
    ReadError : the file cannot be read or executed, or defines no rule.
    """
    try:
        text = read_text(path, RULES_SIZE)
    except FileError as error:
        raise _refused("RUL001", error.reason, Location(path), error.advice) from None
    module = ModuleType(f"amuros_rules_{path.stem}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module
    try:
        exec(compile(text, str(path), "exec"), module.__dict__)
        return list(instances_in(module, ModelRule, _LIST))
    except (Exception, SystemExit) as error:
        raise _failed(error, path, text) from None


def _failed(error: BaseException, path: Path, text: str) -> ReadError:
    """What to raise when a file of rules cannot be executed."""
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return _broken(f"the rules are not valid Python: {error.msg}", _location(path, text, error.lineno, error.offset))
    lines = [frame.lineno for frame in extract_tb(error.__traceback__) if frame.filename == str(path)]
    place = _location(path, text, lines[-1] if lines else None)
    return _broken(f"the rules cannot be loaded: {type(error).__name__}: {error}", place)


def installed_rules() -> list[ModelRule]:
    """The rules of installed packages.

    Raises
    ------
    ReadError : those of a package cannot be loaded.
    """
    return [rule for entry in installed(GROUP) for rule in _rules_of_package(entry)]


def check_id(rule: ModelRule, taken: Iterable[str]) -> None:
    """Refuse a rule whose id cannot be selected, or differs from one that is taken at most by its case.

    Raises
    ------
    ReadError : the id is not usable.
    """
    if not isinstance(rule.id, str) or _ID.fullmatch(rule.id) is None:
        message = f"{rule.id!r} cannot be the id of a rule"
        raise _refused("RUL002", message, None, "Use letters, digits and any of _ . / -, for example ACME-001.")
    if rule.id.casefold() in map(str.casefold, taken):
        message = f"the id {rule.id!r} is already used by another rule or finding"
        raise _refused("RUL002", message, None, "Give the rule an id of its own, for example with the name of the project.")


def _rules_of_package(entry: EntryPoint) -> Iterable[ModelRule]:
    try:
        return list(instances_in(entry.load(), ModelRule, _LIST))
    except (Exception, SystemExit) as error:
        message = f"the rules of the package {package_of(entry)!r} cannot be loaded: {type(error).__name__}: {error}"
        raise _broken(message, None) from None


def _location(path: Path, text: str, line: int | None, column: int | None = None) -> Location:
    lines = text.split("\n")
    if line is None or not 0 < line <= len(lines):
        return Location(path)
    return Location(path, line, column or 1, lines[line - 1])


def _broken(message: str, location: Location | None) -> ReadError:
    return _refused("RUL001", message, location, "Correct the file; docs/check.md has an example of a rule.")


def _refused(identifier: str, message: str, location: Location | None, advice: str) -> ReadError:
    return ReadError([Finding(identifier, Severity.ERROR, message, location, advice)])
