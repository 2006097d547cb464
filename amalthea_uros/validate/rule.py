"""The definition of a rule.

The ids of APP4MC's own rules are APP4MC's. What `amuros check` can also be asked for, but finds without a rule, is in the catalogue
of findings: violations of the XML schema, and problems of building a system.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf.named import Located
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.system_context import SystemContext


class RuleProfile(StrEnum):
    """A set of rules for a purpose; the folder in which they are has its name, those of users are elsewhere."""

    SCHEMA = "schema"
    EMF = "emf"
    APP4MC = "app4mc"
    TA = "ta"
    INCHRON = "inchron"
    TIMING = "timing"
    MICRO_ROS = "micro-ros"
    USER = "user"


class Downgraded(NamedTuple):
    """A message with a lower severity than that of its rule."""

    message: str
    severity: Severity = Severity.WARNING


#: Yields one message for each problem of an object.
Check = Callable[[Any, Context], Iterator[str | Downgraded]]

#: Repairs an object with a finding if there is exactly one way to do so; returns whether it did.
Fix = Callable[[Any, Context], bool]


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelRule(FindingKind):
    """A rule about the objects of a class.

    Attributes
    ----------
    target : the class or classes whose objects are checked, including those of subclasses
    check : yields the messages for one object
    among : a preselection of the objects to check; None: all objects of the target
    concerns : whether objects of a class can have findings in an AMALTHEA version; other classes are skipped
    fix : repairs one object
    in_canonical_form : writing the file in EMF's form removes the findings
    example_version : AMALTHEA version of the failing example
    beside : content of a second file, of AMALTHEA 3.3.0, that is loaded together with each example
    since, until : the first and the last AMALTHEA version to which the rule applies; None: no limit
    is_about_files : the rule reports problems found while reading a file, such as unknown elements
    """

    target: type[Element] | tuple[type[Element], ...]
    check: Check
    among: Callable[[Context], Iterable[Element]] | None = None
    concerns: Callable[[type[Element], str], object] | None = None
    fix: Fix | None = None
    example_version: str = "3.3.0"
    beside: str | None = None
    since: str | None = None
    until: str | None = None
    is_about_files: bool = False
    in_canonical_form: bool = False


class SystemProblem(NamedTuple):
    """What is wrong with an object of a system."""

    item: Located
    message: str
    object: str = ""
    severity: Severity | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemRule(FindingKind):
    """A rule about what a system means in time, whether it comes from a model or from a description.

    Attributes
    ----------
    check : finds the problems of a system
    """

    check: Callable[[SystemContext], Iterator[SystemProblem]]
