"""Ids of the objects of a file."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Amalthea, context: Context) -> Iterator[str]:
    document = element.document
    if document is None or document.source is None:
        return
    source = document.source
    stated = len(re.findall(rf"\s{re.escape(source.prefixes.xmi_id)}\s*=", source.text))
    referable = sum(part.is_referable for part in source.elements)
    if stated < referable:
        yield f"{referable - stated} of {referable} objects to which others may refer have no xmi:id"
    odd = sum(name == "xmi:id" for _, name in document.spellings)
    if odd:
        yield f"{odd} objects have an xmi:id that is not their name"


RULE = ModelRule(
    id="EMF-ID",
    title="xmi:id that is missing, or is not the name of its object",
    severity=Severity.INFO,
    target=Amalthea,
    check=_check,
    rationale="EMF gives every object the id by which references find it; importers that look for it do not find the others.",
    remedy="Let amuros check --fix, amuros fmt or APP4MC write the file.",
    fails="""
<swModel>
  <labels name="L"/>
</swModel>
""",
    passes="""
<swModel>
  <labels xmi:id="L?type=Label" name="L"/>
</swModel>
""",
    in_canonical_form=True,
)
