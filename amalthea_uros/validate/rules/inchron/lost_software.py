"""Parts of the software that am2inc drops, ignores or changes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ActivityGraphItem,
    Channel,
    ChannelReceive,
    ChannelSend,
    Component,
    CoreAllocationConstraint,
    CustomEntity,
    CustomEventTrigger,
    EnforcedMigration,
    ExecutionNeed,
    Group,
    IAnnotatable,
    IExecutable,
    Label,
    LabelAccess,
    MemoryMappingConstraint,
    ModeCondition,
    ProcessChain,
    ProcessPrototype,
    Runnable,
    Scenario,
    Section,
    System,
    Task,
    TerminateProcess,
)
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel


def _check_local_labels(element: IExecutable, context: Context) -> Iterator[str]:
    if element.local_labels:
        yield f"the local mode labels of {name_of(element)!r} are dropped by am2inc"


def _check_activations(element: Runnable, context: Context) -> Iterator[str]:
    if element.activations:
        yield f"the activations of the runnable {element.name or ''!r} are ignored by am2inc"


def _check_item(element: ActivityGraphItem, context: Context) -> Iterator[str]:
    yield f"the {type(element).__name__} is dropped by am2inc"


def _check_execution_condition(element: Runnable, context: Context) -> Iterator[str]:
    if element.execution_condition is not None:
        yield f"the execution condition of the runnable {element.name or ''!r} is ignored by am2inc"


def _check_group(element: Group, context: Context) -> Iterator[str]:
    if element.ordered is False:
        yield "the unordered group is changed to an ordered one by am2inc"


def _check_execution_need(element: ExecutionNeed, context: Context) -> Iterator[str]:
    yield "the execution need is dropped by am2inc"


def _check_preemption(element: Task, context: Context) -> Iterator[str]:
    if element.preemption == "cooperative":
        yield f"the cooperative task {element.name or ''!r} is changed to non-preemptive by am2inc"


_IGNORED = (
    ProcessChain,
    ProcessPrototype,
    Section,
    CustomEntity,
    Channel,
    Scenario,
    Component,
    System,
    CoreAllocationConstraint,
    MemoryMappingConstraint,
)


def _check_ignored(element: IAnnotatable, context: Context) -> Iterator[str]:
    yield f"the {type(element).__name__} {name_of(element)!r} is ignored by am2inc"


def _check_relation(element: ModeCondition, context: Context) -> Iterator[str]:
    if element.relation != "EQUAL" and metamodel(element) != "1.2.0":
        yield "the relation of the condition is changed to EQUAL by am2inc"


#: Nothing is protected, or another object says so.
_NOT_STATED = (None, "_undefined_", "inherited", "noProtection")


def _check_data_stability(element: Label | LabelAccess, context: Context) -> Iterator[str]:
    if element.data_stability not in _NOT_STATED:
        owner = f"label {element.name or ''!r}" if isinstance(element, Label) else "label access"
        yield f"the data stability {str(element.data_stability)!r} of the {owner} is ignored by am2inc"


RULES = (
    ModelRule(
        id="INC-IO-LOCALLABEL",
        title="local mode label",
        severity=Severity.WARNING,
        target=IExecutable,
        check=_check_local_labels,
        rationale="am2inc drops local mode labels and prints a warning.",
        remedy="Replace them with mode labels of the software model.",
        fails="""
<swModel>
  <tasks name="T">
    <localLabels name="l"/>
  </tasks>
</swModel>
""",
        passes="""
<swModel>
  <tasks name="T"/>
</swModel>
""",
    ),
    ModelRule(
        id="INC-SW-ACTIVATION",
        title="runnable with activations",
        severity=Severity.WARNING,
        target=Runnable,
        check=_check_activations,
        rationale="am2inc silently ignores activations of runnables, which do not activate anything in AMALTHEA either.",
        remedy="Call the runnable from a task that has a stimulus.",
        fails="""
<swModel>
  <activations xsi:type="am:PeriodicActivation" name="A"/>
  <runnables name="R" activations="A?type=PeriodicActivation"/>
</swModel>
""",
        passes="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
    ),
    ModelRule(
        id="INC-SW-CHANNEL",
        title="unsupported activity item",
        severity=Severity.WARNING,
        target=(ChannelSend, ChannelReceive, EnforcedMigration, CustomEventTrigger, TerminateProcess),
        check=_check_item,
        rationale="am2inc drops channel accesses, enforced migrations, custom event triggers and process terminations, and prints "
        "one warning per class.",
        remedy="Replace the item, e.g. a channel access with label accesses, or do not rely on it after the import.",
        fails=runnable_with('<items xsi:type="am:TerminateProcess"/>'),
        edits={
            """<activityGraph>
      <items xsi:type="am:TerminateProcess"/>
    </activityGraph>""": "<activityGraph/>",
        },
    ),
    ModelRule(
        id="INC-SW-EXECCOND",
        title="runnable with an execution condition",
        severity=Severity.WARNING,
        target=Runnable,
        check=_check_execution_condition,
        rationale="am2inc silently leaves the condition unattached, so the runnable is always executed.",
        remedy="Put the call of the runnable into a switch with this condition.",
        fails="""
<swModel>
  <runnables name="R">
    <executionCondition/>
  </runnables>
</swModel>
""",
        passes="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
    ),
    ModelRule(
        id="INC-SW-GROUP",
        title="unordered group",
        severity=Severity.WARNING,
        target=Group,
        check=_check_group,
        rationale="am2inc executes the items of every group in the listed order. It prints a warning for unordered groups.",
        remedy="Make the group ordered, or expect its items to be executed always in the listed order.",
        fails=runnable_with('<items xsi:type="am:Group" ordered="false"/>'),
        edits={'ordered="false"': 'ordered="true"'},
    ),
    ModelRule(
        id="INC-SW-NEED",
        title="execution need",
        severity=Severity.WARNING,
        target=ExecutionNeed,
        check=_check_execution_need,
        rationale="am2inc drops execution needs and prints a warning, so the runnable takes no time.",
        remedy="Specify the execution time as Ticks.",
        fails=runnable_with('<items xsi:type="am:ExecutionNeed"/>'),
        edits={
            'xsi:type="am:ExecutionNeed"/>': """xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </items>""",
        },
    ),
    ModelRule(
        id="INC-SW-PREEMPTION",
        title="cooperative task",
        severity=Severity.WARNING,
        target=Task,
        check=_check_preemption,
        rationale="am2inc silently makes cooperative tasks non-preemptive, which can increase the blocking of other tasks.",
        remedy="Make the task preemptive, or expect longer blocking times after the import.",
        fails="""
<swModel>
  <tasks name="T" preemption="cooperative"/>
</swModel>
""",
        edits={'preemption="cooperative"': 'preemption="preemptive"'},
    ),
    ModelRule(
        id="INC-SW-PROCCHAIN",
        title="unsupported object",
        severity=Severity.WARNING,
        target=_IGNORED,
        check=_check_ignored,
        rationale="am2inc silently ignores process chains, process prototypes, sections, custom entities, channels, scenarios, "
        "components, component systems and property constraints.",
        remedy="Remove the object, or do not rely on it after the import.",
        fails="""
<swModel>
  <processChains name="C"/>
</swModel>
""",
        passes="""
<swModel/>
""",
    ),
    ModelRule(
        id="INC-SW-RELATION",
        title="relation other than EQUAL",
        severity=Severity.WARNING,
        target=ModeCondition,
        check=_check_relation,
        rationale="am2inc silently changes every relation to EQUAL in models of AMALTHEA 2.0 and newer.",
        remedy="Rewrite the condition with EQUAL only.",
        fails=runnable_with("""
<items xsi:type="am:Switch">
  <entries name="e">
    <condition>
      <entries xsi:type="am:ModeValueCondition" relation="LESS_THAN" value="1"/>
    </condition>
  </entries>
</items>
"""),
        edits={'relation="LESS_THAN"': 'relation="EQUAL"'},
    ),
    ModelRule(
        id="INC-SW-STABILITY",
        title="label or label access with data stability",
        severity=Severity.WARNING,
        target=(Label, LabelAccess),
        check=_check_data_stability,
        rationale="am2inc silently ignores the data stability, so values can change between two accesses of a job.",
        remedy="Model the protection, e.g. with semaphores or copies of the label, or do not rely on it after the import.",
        fails="""
<swModel>
  <labels name="L" dataStability="automaticProtection"/>
</swModel>
""",
        edits={'dataStability="automaticProtection"': 'dataStability="noProtection"'},
    ),
)
