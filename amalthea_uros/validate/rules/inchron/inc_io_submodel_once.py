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
            other = repr(document.path.name) if document is not None and document.path else "another file"
            yield f"the {type(part).__name__} replaces the one in {other}"


def _holders(context: Context) -> dict[type[Element], Element]:
    """The root of the first file that has a sub-model, by class of sub-model."""
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
    rationale="am2inc does not merge sub-models: the one in a later file silently replaces the one in an earlier file. "
    "It then crashes with a segmentation fault or writes an incomplete model.",
    remedy="Move the content of each sub-model into one file.",
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
