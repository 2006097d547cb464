"""Nesting of CPUs that is lost."""

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
    # Around all CPUs there is always something: it says nothing.
    if inner > 1 and (element in cpus or inner < len(cpus)):
        yield f"that the {inner} CPUs in {element.name!r} belong together is lost"


def _cpus(context: Context) -> set[Element]:
    """The structures that become CPUs: those that hold processing units themselves."""
    return {core.container for core in context.all(ProcessingUnit) if core.container is not None}


def _cpus_within(context: Context) -> Counter[Element]:
    """How many CPUs there are in each structure, itself included."""
    found: Counter[Element] = Counter()
    for cpu in context.once(_cpus):
        holder: Element | None = cpu
        while isinstance(holder, HwStructure):
            found[holder] += 1
            holder = holder.container
    return found


RULE = ModelRule(
    id="INC-HW-PU-STRUCT",
    title="nesting of CPUs that is lost",
    severity=Severity.WARNING,
    target=HwStructure,
    check=_check,
    rationale="Each structure that holds processing units becomes a CPU of one flat list, without a word about those around it.",
    remedy="Do not rely on the structures above the CPUs after the import.",
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
