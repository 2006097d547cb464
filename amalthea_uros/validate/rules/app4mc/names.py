"""Ambiguous names and keys."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule


@model_rule("AM-EMF-SCOPE", am.IReferable, among=lambda context: context.namesakes)
def _check_emf_scope(element: am.IReferable, context: Context) -> Iterator[str]:
    same = context.namesakes.get(element)
    if element.name and same is not None:
        yield f"{unique_name(element)!r} identifies {len(same)} objects"


@model_rule("AM-Basic-CustomProperty-Key", am.IAnnotatable)
def _check_customproperty_key(element: am.IAnnotatable, context: Context) -> Iterator[str]:
    properties = element.__dict__.get("custom_properties", ())
    if len(properties) < 2:
        return
    for key, times in Counter(entry.key for entry in properties).items():
        if times > 1:
            yield f"custom property {key!r} is defined {times} times"
