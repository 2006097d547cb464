"""Frequency domain without a frequency."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import FrequencyDomain, HwStructure, ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._importer import amount


def _check(element: FrequencyDomain, context: Context) -> Iterator[str | Downgraded]:
    cores = context.once(_cores).get(element, [])
    if not cores or amount(element.default_value) > 0:
        return
    message = f"the frequency domain {element.name or ''!r} has no positive frequency with a unit"
    is_compared = any(_has_others(core) for core in cores)
    yield message if element.default_value is None and is_compared else Downgraded(message)


def _cores(context: Context) -> dict[FrequencyDomain, list[ProcessingUnit]]:
    found: dict[FrequencyDomain, list[ProcessingUnit]] = {}
    for core in context.all(ProcessingUnit):
        if core.frequency_domain is not None:
            found.setdefault(core.frequency_domain, []).append(core)
    return found


def _has_others(core: ProcessingUnit) -> bool:
    """Whether the same structure has other processing units, whose clocks am2inc compares with this one."""
    holder = core.container
    modules = holder.modules if isinstance(holder, HwStructure) else []
    return sum(isinstance(module, ProcessingUnit) for module in modules) > 1


RULE = ModelRule(
    id="INC-HW-FREQ-VALUE",
    title="frequency domain without a frequency",
    severity=Severity.ERROR,
    target=FrequencyDomain,
    check=_check,
    rationale="If the default value is missing and a structure has several processing units, am2inc crashes with a "
    "segmentation fault. Otherwise it silently uses 1000 MHz, or 0 MHz if the value is 0.",
    remedy="Set a default value greater than 0 with a unit, e.g. 300 MHz.",
    fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock"/>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core_0" frequencyDomain="clock?type=FrequencyDomain"/>
    <modules xsi:type="am:ProcessingUnit" name="core_1" frequencyDomain="clock?type=FrequencyDomain"/>
  </structures>
</hwModel>
""",
    edits={
        'name="clock"/>': """name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>""",
    },
)
