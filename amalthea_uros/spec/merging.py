"""Sections of an application, completed by those of its platform and its operating system.

Mappings are completed key by key. What can be written as a plain value is one value, so are lists and loops: they are replaced as a
whole. Of keys that exclude each other, such as the wires of a transport, one that the application states replaces them all.
"""

from __future__ import annotations

from collections.abc import Set as AbstractSet
from typing import Any, TypeVar

from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.transports import WIRES, TransportSection

S = TypeVar("S", bound=DescriptionSection)

#: Keys of which a section has one: its executor or executors, the activation of an executor, the wire of a transport.
_ALTERNATIVES: dict[type[DescriptionSection], AbstractSet[str]] = {
    Middleware: {"executor", "executors"},
    ExecutorSection: {"loop", "period"},
    TransportSection: WIRES,
}


def merged(own: S, *bases: S) -> S:
    """A section, completed by others; the first one that states a key counts."""
    for base in bases:
        own = _merged(own, base)
    return own


def merged_middleware(own: Middleware, *bases: Middleware) -> Middleware:
    """The middleware of an application, completed by generic models.

    What these say about the executor holds for each executor that the application lists.
    """
    models = [base.executor for base in bases if base.states("executor")]
    if own.executors and models:
        own = own.model_copy(update={"executors": [merged(executor, *models) for executor in own.executors]})
    return merged(own, *bases)


def _merged(own: S, base: S) -> S:
    added = {key: getattr(base, key) for key in base.model_fields_set - own.model_fields_set - _excluded(own)}
    for key in own.model_fields_set & base.model_fields_set:
        ours, theirs = getattr(own, key), getattr(base, key)
        if has_parts(ours) and has_parts(theirs):
            added[key] = _merged(ours, theirs)
    if not added:
        return own
    found = own.model_copy(update=added)
    found._base = base if own._base is None else merged(own._base, base)
    return found


def _excluded(own: DescriptionSection) -> AbstractSet[str]:
    alternatives = _ALTERNATIVES.get(type(own), frozenset())
    return alternatives if alternatives & own.model_fields_set else frozenset()


def has_parts(value: Any) -> bool:
    """Whether a value is completed, instead of being replaced."""
    return isinstance(value, DescriptionSection) and not isinstance(value, Shorthand)
