"""Values that am2inc replaces by a default if they are missing."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ISR,
    Cache,
    DataSize,
    FixedPeriodic,
    Frequency,
    HwModule,
    HwPort,
    Label,
    Memory,
    Runnable,
    Stimulus,
    Task,
    Time,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import amount, has_unit, metamodel


def _check_bit_width(element: HwPort, context: Context) -> Iterator[str]:
    if isinstance(element.container, HwModule) and not (element.bit_width or 0) > 0:
        yield f"the port {element.name or ''!r} of {element.container.name or ''!r} has no positive bit width"


def _check_memory_size(element: Memory | Cache, context: Context) -> Iterator[str]:
    size = element.definition.size if element.definition is not None else None
    if size is None or not has_unit(size):
        yield f"the memory {element.name or ''!r} has no definition with a size and a unit"


def _check_stimulus(element: Task | ISR, context: Context) -> Iterator[str]:
    if not element.stimuli:
        yield f"{element.name or ''!r} has no stimulus"


def _check_recurrence(element: Stimulus, context: Context) -> Iterator[str]:
    if isinstance(element, FixedPeriodic) and not amount(element.recurrence) > 0:
        yield f"the stimulus {element.name or ''!r} has no positive recurrence with a unit"


def _check_unit(element: Time | Frequency | DataSize, context: Context) -> Iterator[str]:
    if not has_unit(element):
        yield f"the {type(element).__name__} value {element.value} has no unit"


def _check_activity_graph(element: Runnable, context: Context) -> Iterator[str]:
    if element.activity_graph is None and metamodel(element) >= "3":
        yield f"the runnable {element.name or ''!r} has no activity graph"


def _check_label_size(element: Label, context: Context) -> Iterator[str]:
    if element.size is None:
        yield f"the label {element.name or ''!r} has no size"


RULES = (
    ModelRule(
        id="INC-HW-BITWIDTH",
        title="port without a bit width",
        severity=Severity.WARNING,
        target=HwPort,
        check=_check_bit_width,
        rationale="am2inc takes the width of the core, memory or interconnect from its ports.",
        remedy="Set a bit width greater than 0.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="p"/>
    </modules>
  </structures>
</hwModel>
""",
        edits={'name="p"': 'name="p" bitWidth="32"'},
    ),
    ModelRule(
        id="INC-HW-MEM-SIZE",
        title="memory without a size",
        severity=Severity.WARNING,
        target=(Memory, Cache),
        check=_check_memory_size,
        rationale="am2inc silently uses 1 KiB.",
        remedy="Assign a definition with a size and a unit, e.g. 512 KiB.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM"/>
  </structures>
</hwModel>
""",
        edits={
            '<domains xsi:type="am:FrequencyDomain" name="clock"': '<definitions xsi:type="am:MemoryDefinition" name="type"',
            '<defaultValue value="300" unit="MHz"': '<size value="1" unit="MB"',
            "</domains": "</definitions",
            'name="RAM"': 'name="RAM" definition="type?type=MemoryDefinition"',
        },
    ),
    ModelRule(
        id="INC-ST-NONE",
        title="process without a stimulus",
        severity=Severity.WARNING,
        target=(Task, ISR),
        check=_check_stimulus,
        rationale="am2inc converts the process without a warning, but it is never activated.",
        remedy="Assign a stimulus to the process.",
        fails="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
        passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
<swModel>
  <tasks name="T" stimuli="S?type=PeriodicStimulus"/>
</swModel>
""",
    ),
    ModelRule(
        id="INC-ST-PERIOD",
        title="periodic stimulus without a period",
        severity=Severity.WARNING,
        target=Stimulus,
        check=_check_recurrence,
        rationale="am2inc silently uses a period of 0.",
        remedy="Set a recurrence greater than 0 with a unit, e.g. 10 ms.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
""",
        edits={
            'name="S"/>': """name="S">
    <recurrence value="1" unit="ms"/>
  </stimuli>""",
        },
    ),
    ModelRule(
        id="INC-ST-UNIT",
        title="quantity without a unit",
        severity=Severity.WARNING,
        target=(Time, Frequency, DataSize),
        check=_check_unit,
        rationale="am2inc silently uses 0 ps for a time, 1000 MHz for a frequency and 1 KiB for a data size.",
        remedy="Set the unit, e.g. ms, MHz or KiB.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="1"/>
  </stimuli>
</stimuliModel>
""",
        edits={'value="1"': 'value="1" unit="ms"'},
    ),
    ModelRule(
        id="INC-SW-GRAPH",
        title="runnable without an activity graph",
        severity=Severity.WARNING,
        target=Runnable,
        check=_check_activity_graph,
        rationale="am2inc converts the runnable to an empty function and prints a warning.",
        remedy="Add an activity graph, even if it is empty.",
        fails="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
        edits={
            'name="R"/>': """name="R">
    <activityGraph/>
  </runnables>""",
        },
    ),
    ModelRule(
        id="INC-SW-LABELSIZE",
        title="label without a size",
        severity=Severity.WARNING,
        target=Label,
        check=_check_label_size,
        rationale="am2inc silently uses 1 KiB.",
        remedy="Set the size of the label, e.g. 32 bit.",
        fails="""
<swModel>
  <labels name="L"/>
</swModel>
""",
        edits={
            'name="L"/>': """name="L">
    <size value="4" unit="B"/>
  </labels>""",
        },
    ),
)
