"""Missing or non-standard xmi:id."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Amalthea, context: Context) -> Iterator[str]:
    document = element.document
    if document is None or document.source is None or document.migrated_from is not None:
        return
    source = document.source
    stated = len(re.findall(rf"\s{re.escape(source.prefixes.xmi_id)}\s*=", source.text))
    referable = sum(part.is_referable for part in source.elements)
    if stated < referable:
        yield f"the file has no xmi:id for {referable - stated} of {counted(referable, 'referable object')}"
    odd = sum(name == "xmi:id" for _, name in document.spellings)
    if odd:
        yield f"the xmi:id does not match the name of {counted(odd, 'object')}"


RULE = ModelRule(
    id="EMF-ID",
    title="missing or non-standard xmi:id",
    severity=Severity.INFO,
    target=Amalthea,
    check=_check,
    rationale="EMF writes an xmi:id for every referable object; importers that rely on it cannot find the other objects.",
    remedy="Rewrite the file with amuros check --fix, amuros fmt or APP4MC.",
    fails="""
<swModel>
  <labels name="L"/>
</swModel>
""",
    edits={'<labels name="L"': '<labels xmi:id="L?type=Label" name="L"'},
    in_canonical_form=True,
)
