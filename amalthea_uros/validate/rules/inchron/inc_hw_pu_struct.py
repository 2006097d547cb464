"""Nested CPUs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwStructure, ProcessingUnit
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwStructure, context: Context) -> Iterator[str]:
    cpus = context.once(_cpus)
    inner = context.once(_cpus_within)[element]
    # A structure around all CPUs groups nothing.
    if inner > 1 and (element in cpus or inner < len(cpus)):
        yield f"the grouping of {inner} CPUs in the structure {element.name or ''!r} is dropped by am2inc"


def _cpus(context: Context) -> set[Element]:
    """The structures that become CPUs: those that directly contain processing units."""
    return {core.container for core in context.all(ProcessingUnit) if core.container is not None}


def _cpus_within(context: Context) -> Counter[Element]:
    """The number of CPUs in each structure, including itself."""
    found: Counter[Element] = Counter()
    for cpu in context.once(_cpus):
        holder: Element | None = cpu
        while isinstance(holder, HwStructure):
            found[holder] += 1
            holder = holder.container
    return found


RULE = ModelRule(
    id="INC-HW-PU-STRUCT",
    title="nested CPUs",
    severity=Severity.WARNING,
    target=HwStructure,
    check=_check,
    rationale="am2inc turns every structure that directly contains processing units into a CPU, and lists all CPUs on one "
    "level. It silently drops the structures around them.",
    remedy="Move all CPUs to one level, or do not rely on the grouping after the import.",
    fails="""
<hwModel>
  <structures name="ECU">
    <structures name="Host">
      <modules xsi:type="am:ProcessingUnit" name="A"/>
    </structures>
    <structures name="Companion">
      <modules xsi:type="am:ProcessingUnit" name="B"/>
    </structures>
  </structures>
  <structures name="Gateway">
    <modules xsi:type="am:ProcessingUnit" name="C"/>
  </structures>
</hwModel>
""",
    passes="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="A"/>
    <modules xsi:type="am:ProcessingUnit" name="B"/>
  </structures>
  <structures name="Gateway">
    <modules xsi:type="am:ProcessingUnit" name="C"/>
  </structures>
</hwModel>
""",
)
