"""The structure of hardware."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Cache, HwStructure, ProcessingUnit
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check_cache(element: Cache, context: Context) -> Iterator[str]:
    holder = element.container
    modules = holder.modules if isinstance(holder, HwStructure) else []
    if not isinstance(holder, ProcessingUnit) and not any(isinstance(module, ProcessingUnit) for module in modules):
        yield f"the cache {element.name or ''!r} is neither inside a processing unit nor in the same structure as one"


def _check_systems(element: HwStructure, context: Context) -> Iterator[str]:
    last = context.once(_systems)[-1:]
    if element.structure_type == "System" and element not in last:
        yield f"the imported project is named after {last[0].name!r}, not after {element.name or ''!r}"


def _systems(context: Context) -> list[HwStructure]:
    return [structure for structure in context.all(HwStructure) if structure.structure_type == "System"]


def _check_grouping(element: HwStructure, context: Context) -> Iterator[str]:
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


RULES = (
    ModelRule(
        id="INC-HW-CACHE-PLACE",
        title="cache without a processing unit",
        severity=Severity.ERROR,
        target=Cache,
        check=_check_cache,
        rationale="am2inc crashes with a segmentation fault.",
        remedy="Move the cache into a processing unit or into the structure of one.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:Cache" name="L2"/>
  </structures>
</hwModel>
""",
        edits={
            'xsi:type="am:Cache" name="L2"/>': """xsi:type="am:ProcessingUnit" name="core"/>
    <modules xsi:type="am:Cache" name="L2"/>""",
        },
    ),
    ModelRule(
        id="INC-HW-ONE-SYSTEM",
        title="several structures of type System",
        severity=Severity.INFO,
        target=HwStructure,
        check=_check_systems,
        rationale="am2inc names the project after the last structure of type System.",
        remedy="Set the type System for one structure only.",
        fails="""
<hwModel>
  <structures name="A" structureType="System"/>
  <structures name="B" structureType="System"/>
</hwModel>
""",
        edits={'name="B" structureType="System"': 'name="B" structureType="ECU"'},
    ),
    ModelRule(
        id="INC-HW-PU-STRUCT",
        title="nested CPUs",
        severity=Severity.WARNING,
        target=HwStructure,
        check=_check_grouping,
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
    ),
)
