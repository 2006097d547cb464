"""Missing xmi:id."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea, INamespaceMember, LocalModeLabel
from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ids import has_id, without_namespace


def _check(element: Amalthea, context: Context) -> Iterator[str]:
    without = context.once(_without_id).get(element.document, [])
    label = next((label for label in context.all(LocalModeLabel) if label.document is element.document), None)
    if without and label is not None:
        yield f"the file has local mode labels, e.g. {label.name or ''!r}, and objects without an xmi:id"
    member = next((found for found in without if isinstance(found, INamespaceMember) and found.namespace is not None), None)
    if member is not None:
        yield f"{unique_name(member)!r} has no xmi:id, so references with its namespace cannot be resolved"


def _without_id(context: Context) -> dict[Document | None, list[Element]]:
    """The objects that need an `xmi:id` and have none, by file: targets of references, and local mode labels."""
    found: dict[Document | None, list[Element]] = {}
    labels, members = context.all(LocalModeLabel), context.once(without_namespace)
    if labels or members:
        for element in dict.fromkeys([*labels, *_targets(context)]):
            if not has_id(element):
                found.setdefault(element.document, []).append(element)
    return found


def _targets(context: Context) -> Iterator[Element]:
    for holder in context.all(Element):
        for _, value in references_of(holder):
            yield from value if isinstance(value, list) else (value,)


RULE = ModelRule(
    id="INC-IO-XMIID",
    title="missing xmi:id",
    severity=Severity.ERROR,
    target=Amalthea,
    check=_check,
    rationale="Without an xmi:id am2inc resolves references by name. It then refuses files with local mode labels and does "
    "not find objects in a namespace.",
    remedy="Save the file with APP4MC or amuros fmt, which write an xmi:id for every object.",
    fails="""
<swModel>
  <tasks name="T">
    <localLabels name="l"/>
  </tasks>
</swModel>
""",
    passes="""
<swModel>
  <tasks xmi:id="T?type=Task" name="T">
    <localLabels xmi:id="T/l?type=LocalModeLabel" name="l"/>
  </tasks>
</swModel>
""",
)
