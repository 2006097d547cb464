"""Sub-model in several files."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea, CustomProperty
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Amalthea, context: Context) -> Iterator[str]:
    holders = context.once(_holders)
    for part in element.contents():
        first = holders.get(type(part), element)
        if first is not element:
            document = first.document
            other = document.path.name if document is not None and document.path else "another file"
            yield f"the {type(part).__name__} replaces that of {other}"


def _holders(context: Context) -> dict[type[Element], Element]:
    """By class of sub-model, the root of the first file that has one."""
    found: dict[type[Element], Element] = {}
    for document in context.model.documents:
        for part in document.root.contents():
            if not isinstance(part, CustomProperty):
                found.setdefault(type(part), document.root)
    return found


RULE = ModelRule(
    id="INC-IO-SUBMODEL-ONCE",
    title="sub-model in several files",
    severity=Severity.ERROR,
    target=Amalthea,
    check=_check,
    rationale="am2inc does not merge them: that of the later file replaces the other one without a word.",
    remedy="Keep each sub-model in one file.",
    fails="""
<!-- beside a file that has an swModel, too -->
<swModel>
  <tasks name="T"/>
</swModel>
""",
    passes="""
<!-- beside a file that has an swModel -->
<hwModel/>
""",
    beside="<swModel/>",
)
