"""The definition of a rule.

The ids of APP4MC's own rules are APP4MC's. What `amuros check` can also be asked for, but finds without a rule, is in the catalogue
of findings: violations of the XML schema, and problems of building a system.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from enum import StrEnum
from typing import Any, NamedTuple

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Severity, ToolEffect
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
    """A message with a lower severity than that of its rule, or with another effect."""

    message: str
    severity: Severity = Severity.WARNING
    effect: ToolEffect | None = None


def drops(message: str) -> Downgraded:
    """A warning about something that a tool drops, of a rule about what it changes."""
    return Downgraded(message, effect=ToolEffect.DROPS)


def changes(message: str, severity: Severity = Severity.WARNING) -> Downgraded:
    """A message about something that a tool changes, of a rule about what it drops or fails at."""
    return Downgraded(message, severity, ToolEffect.CHANGES)


class SystemProblem(NamedTuple):
    """What is wrong with an object of a system."""

    item: Located
    message: str
    object: str = ""
    severity: Severity | None = None


#: Yields one message for each problem of an object.
Check = Callable[[Any, Context], Iterator[str | Downgraded]]

#: Finds the problems of a system.
CheckOfSystem = Callable[[SystemContext], Iterator[SystemProblem]]

#: Repairs an object with a finding if there is exactly one way to do so; returns whether it did.
Fix = Callable[[Any, Context], bool]


@dataclass(frozen=True, kw_only=True)
class ModelCheck:
    """What a rule demands of the objects of a class.

    Attributes
    ----------
    id : the id of the rule
    target : the class or classes whose objects are checked, including those of subclasses
    check : yields the messages for one object
    among : a preselection of the objects to check; None: all objects of the target
    concerns : whether objects of a class can have findings in an AMALTHEA version; other classes are skipped
    fix : repairs one object
    in_canonical_form : writing the file in EMF's form removes the findings
    since, until : the first and the last AMALTHEA version to which the rule applies; None: no limit
    is_about_files : the rule reports problems found while reading a file, such as unknown elements
    """

    id: str
    target: type[Element] | tuple[type[Element], ...]
    check: Check
    among: Callable[[Context], Iterable[Element]] | None = None
    concerns: Callable[[type[Element], str], object] | None = None
    fix: Fix | None = None
    since: str | None = None
    until: str | None = None
    is_about_files: bool = False
    in_canonical_form: bool = False


@dataclass(frozen=True, kw_only=True)
class SystemCheck:
    """What a rule demands of a system in time, whether it comes from a model or from a description.

    Attributes
    ----------
    id : the id of the rule
    check : finds the problems of a system
    """

    id: str
    check: CheckOfSystem


@dataclass(frozen=True, kw_only=True)
class ModelRule(FindingKind, ModelCheck):
    """A rule of a user: a check together with its texts. Those of this package have their texts in a file beside the check."""


#: The checks of the modules that were imported, by the ids of their rules.
CHECKS: dict[str, ModelCheck | SystemCheck] = {}


def model_rule(identifier: str, *target: type[Element], **options: Any) -> Callable[[Check], Check]:
    """Make a function the check of a rule about objects; the options are attributes of `ModelCheck`."""

    def register(check: Check) -> Check:
        CHECKS[identifier] = ModelCheck(id=identifier, target=target, check=check, **options)
        return check

    return register


def repair_of(identifier: str) -> Callable[[Fix], Fix]:
    """Make a function the repair of a rule whose check is defined above it."""

    def register(fix: Fix) -> Fix:
        check = CHECKS[identifier]
        assert isinstance(check, ModelCheck)
        CHECKS[identifier] = replace(check, fix=fix)
        return fix

    return register


def system_rule(identifier: str) -> Callable[[CheckOfSystem], CheckOfSystem]:
    """Make a function the check of a rule about systems."""

    def register(check: CheckOfSystem) -> CheckOfSystem:
        CHECKS[identifier] = SystemCheck(id=identifier, check=check)
        return check

    return register
