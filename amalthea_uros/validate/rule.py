"""What a rule is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context


class Profile(StrEnum):
    """A set of rules for a purpose; the folder in which they are has its name."""

    APP4MC = "app4mc"
    INCHRON = "inchron"
    TIMING = "timing"


#: What is wrong with an object, one sentence for each thing.
Check = Callable[[Any, Context], Iterator[str]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """A rule about the objects of a class.

    Attributes
    ----------
    id : unique; those of APP4MC's own rules are APP4MC's
    title : what is wrong where the rule fires, in a few words
    target : the class whose objects, and those of its subclasses, are looked at
    rationale : why that matters
    remedy : what to do about it
    fails, passes : what stands in a model in which the rule fires, or does not
    example_version : AMALTHEA version of the failing example
    since, until : AMALTHEA versions for which it is meant; None: any
    """

    id: str
    title: str
    severity: Severity
    target: type[Element]
    rationale: str
    remedy: str
    check: Check
    fails: str
    passes: str
    example_version: str = "3.3.0"
    since: str | None = None
    until: str | None = None

    @property
    def profile(self) -> Profile:
        """The profile, which is the folder of the file in which the check is."""
        return Profile(self.check.__module__.split(".")[-2])
