"""Parts of the software that am2inc drops, ignores or changes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.rules.inchron.importer import metamodel


@model_rule("INC-IO-LOCALLABEL", am.IExecutable)
def _check_local_labels(element: am.IExecutable, context: Context) -> Iterator[str]:
    if element.local_labels:
        yield f"the local mode labels of {name_of(element)!r} are dropped by am2inc"


@model_rule("INC-SW-ACTIVATION", am.Runnable)
def _check_activations(element: am.Runnable, context: Context) -> Iterator[str]:
    if element.activations:
        yield f"the activations of the runnable {element.name or ''!r} are ignored by am2inc"


@model_rule(
    "INC-SW-CHANNEL", am.ChannelSend, am.ChannelReceive, am.EnforcedMigration, am.CustomEventTrigger, am.TerminateProcess
)
def _check_item(element: am.ActivityGraphItem, context: Context) -> Iterator[str]:
    yield f"the {type(element).__name__} is dropped by am2inc"


@model_rule("INC-SW-EXECCOND", am.Runnable)
def _check_execution_condition(element: am.Runnable, context: Context) -> Iterator[str]:
    if element.execution_condition is not None:
        yield f"the execution condition of the runnable {element.name or ''!r} is ignored by am2inc"


@model_rule("INC-SW-GROUP", am.Group)
def _check_group(element: am.Group, context: Context) -> Iterator[str]:
    if element.ordered is False:
        yield "the unordered group is changed to an ordered one by am2inc"


@model_rule("INC-SW-NEED", am.ExecutionNeed)
def _check_execution_need(element: am.ExecutionNeed, context: Context) -> Iterator[str]:
    yield "the execution need is dropped by am2inc"


@model_rule("INC-SW-PREEMPTION", am.Task)
def _check_preemption(element: am.Task, context: Context) -> Iterator[str]:
    if element.preemption == "cooperative":
        yield f"the cooperative task {element.name or ''!r} is changed to non-preemptive by am2inc"


_IGNORED = (
    am.ProcessChain,
    am.ProcessPrototype,
    am.Section,
    am.CustomEntity,
    am.Channel,
    am.Scenario,
    am.Component,
    am.System,
    am.CoreAllocationConstraint,
    am.MemoryMappingConstraint,
)


@model_rule("INC-SW-PROCCHAIN", *_IGNORED)
def _check_ignored(element: am.IAnnotatable, context: Context) -> Iterator[str]:
    yield f"the {type(element).__name__} {name_of(element)!r} is ignored by am2inc"


@model_rule("INC-SW-RELATION", am.ModeCondition)
def _check_relation(element: am.ModeCondition, context: Context) -> Iterator[str]:
    if element.relation != "EQUAL" and metamodel(element) != "1.2.0":
        yield "the relation of the condition is changed to EQUAL by am2inc"


#: Nothing is protected, or another object says so.
_NOT_STATED = (None, "_undefined_", "inherited", "noProtection")


@model_rule("INC-SW-STABILITY", am.Label, am.LabelAccess)
def _check_data_stability(element: am.Label | am.LabelAccess, context: Context) -> Iterator[str]:
    if element.data_stability not in _NOT_STATED:
        owner = f"label {element.name or ''!r}" if isinstance(element, am.Label) else "label access"
        yield f"the data stability {str(element.data_stability)!r} of the {owner} is ignored by am2inc"
