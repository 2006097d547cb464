"""What a rule is."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context


class Profile(StrEnum):
    """A set of rules for a purpose; the folder in which they are has its name, those of users are elsewhere."""

    SCHEMA = "schema"
    EMF = "emf"
    APP4MC = "app4mc"
    TA = "ta"
    INCHRON = "inchron"
    TIMING = "timing"
    MICRO_ROS = "micro-ros"
    USER = "user"


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule(FindingKind):
    """A kind of finding that `amuros check` can be asked for; what finds it is elsewhere: the XML schema, or the building of a system.

    The ids of APP4MC's own rules are APP4MC's.

    Attributes
    ----------
    fails, passes : content of a model, or of a description, in which the rule fires, or does not
    """

    fails: str
    passes: str


class Milder(NamedTuple):
    """A sentence about something that matters less than what a rule else finds."""

    message: str
    severity: Severity = Severity.WARNING


#: What is wrong with an object, one sentence for each thing.
Check = Callable[[Any, Context], Iterator[str | Milder]]

#: Repairs an object of which something is wrong, and says whether it did: it does so only where there is one way to.
Fix = Callable[[Any, Context], bool]


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelRule(Rule):
    """A rule about the objects of a class.

    Attributes
    ----------
    target : the class, or classes, whose objects, and those of their subclasses, are looked at
    check : what is wrong with one of them
    among : the objects that come into question, where it is known of which; None: all
    concerns : whether anything can be wrong with objects of a class in an AMALTHEA version; the others are passed over
    fix : repairs one of them
    in_canonical_form : nothing is wrong any more where the file is written as EMF writes it
    example_version : AMALTHEA version of the failing example
    beside : content of a second file, of AMALTHEA 3.3.0, that makes a model with each of the examples
    since, until : AMALTHEA versions for which it is meant; None: any
    is_about_files : it tells of what reading found odd in a file, such as unknown elements
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
