"""Values that am2inc replaces by a default if they are missing, or by others if it cannot hold them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.rules.inchron.importer import amount, has_unit, metamodel


@model_rule("INC-HW-BITWIDTH", am.HwPort)
def _check_bit_width(element: am.HwPort, context: Context) -> Iterator[str]:
    if isinstance(element.container, am.HwModule) and not (element.bit_width or 0) > 0:
        yield f"the port {element.name or ''!r} of {element.container.name or ''!r} has no positive bit width"


@model_rule("INC-HW-MEM-SIZE", am.Memory, am.Cache)
def _check_memory_size(element: am.Memory | am.Cache, context: Context) -> Iterator[str]:
    size = element.definition.size if element.definition is not None else None
    if size is None or not has_unit(size):
        yield f"the memory {element.name or ''!r} has no definition with a size and a unit"


#: Bits of the numbers that am2inc reads, by the class and the feature that hold them; larger ones are cut to the largest.
_BITS: Mapping[type[Element], tuple[int, tuple[str, ...]]] = {
    am.Task: (32, ("multiple_task_activation_limit",)),
    am.IntegerObject: (32, ("value",)),
    am.PeriodicBurstStimulus: (32, ("occurrence_count",)),
    am.Semaphore: (32, ("initial_value", "max_value")),
    am.Time: (64, ("value",)),
    am.DataSize: (64, ("value",)),
    am.DiscreteValueConstant: (64, ("value",)),
    am.DiscreteValueInterval: (64, ("lower_bound", "upper_bound")),
}


@model_rule("INC-IO-RANGE", *_BITS)
def _check_range(element: Element, context: Context) -> Iterator[str]:
    bits, names = next(entry for cls, entry in _BITS.items() if isinstance(element, cls))
    for value in (getattr(element, name) for name in names):
        if value is not None and not -(2 ** (bits - 1)) <= value < 2 ** (bits - 1):
            yield f"the value {value} of the {type(element).__name__} does not fit into {bits} bits and is changed by am2inc"


@model_rule("INC-SW-LIMIT", am.Task)
def _check_limit(element: am.Task, context: Context) -> Iterator[str]:
    limit = element.multiple_task_activation_limit
    if limit is not None and limit < 0:
        yield f"the activation limit {limit} of the task {element.name or ''!r} is changed to 1 by am2inc"


@model_rule("INC-ST-NONE", am.Task, am.ISR)
def _check_stimulus(element: am.Task | am.ISR, context: Context) -> Iterator[str]:
    if not element.stimuli:
        yield f"{element.name or ''!r} has no stimulus"


@model_rule("INC-ST-PERIOD", am.Stimulus)
def _check_recurrence(element: am.Stimulus, context: Context) -> Iterator[str]:
    if isinstance(element, am.FixedPeriodic) and not amount(element.recurrence) > 0:
        yield f"the stimulus {element.name or ''!r} has no positive recurrence with a unit"


@model_rule("INC-ST-UNIT", am.Time, am.Frequency, am.DataSize)
def _check_unit(element: am.Time | am.Frequency | am.DataSize, context: Context) -> Iterator[str]:
    if not has_unit(element):
        yield f"the {type(element).__name__} value {element.value} has no unit"


@model_rule("INC-SW-GRAPH", am.Runnable)
def _check_activity_graph(element: am.Runnable, context: Context) -> Iterator[str]:
    if element.activity_graph is None and metamodel(element) >= "3":
        yield f"the runnable {element.name or ''!r} has no activity graph"


@model_rule("INC-SW-LABELSIZE", am.Label)
def _check_label_size(element: am.Label, context: Context) -> Iterator[str]:
    if element.size is None:
        yield f"the label {element.name or ''!r} has no size"
