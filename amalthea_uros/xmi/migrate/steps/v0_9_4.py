"""0.9.3 -> 0.9.4: modes as text, deadlines of runnables as requirements, aliases of data types."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Kind, Notes
from amalthea_uros.xmi.migrate.postponed import Postponed
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.later import BEYOND_CONVERTERS
from amalthea_uros.xmi.migrate.steps.v0_9_4_modes import Modes


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 0.9.3."""
    for node in models.parts("swModel", "runnables"):
        _move_deadlines(node, models, notes)
    for node in models.nodes("dataMapping"):
        _convert_mapping(node, notes)
    for node in models.nodes("ports"):
        if node.get("portInterface") == "ABH":
            node.attributes["portInterface"] = "AHB"
            notes.renamed(node, "the port interface ABH is spelt AHB now", attribute="portInterface")
    modes = Modes(models, notes)
    modes.convert()
    modes.convert_stimuli()


def _move_deadlines(runnable: Node, models: ModelSet, notes: Notes) -> None:
    """Make requirements of the deadlines of a runnable."""
    for deadline in runnable.all("deadline"):
        constraints = runnable.root.child_or_new("constraintsModel")
        requirement = constraints.add("requirements", "RunnableRequirement", like=deadline, name="deadline")
        requirement.refer("runnable", runnable)
        limit = requirement.add("limit", "TimeRequirementLimit", like=deadline, limitType="UpperLimit", metric="ResponseTime")
        deadline.tag = "limitValue"
        limit.insert(deadline)
        notes.moved(deadline, "the deadline of a runnable is a requirement now", deadline.get("value") + deadline.get("unit"))
        if "value" not in deadline.attributes:
            # It would be one for a response time of 0.
            drop, message = requirement.remove, "a deadline without value is no requirement"
            models.postponed.append(Postponed(BEYOND_CONVERTERS, drop, Kind.CONVERTED, deadline, message, is_kept=True))


def _convert_mapping(node: Node, notes: Notes) -> None:
    node.tag = "aliases"
    node.rename("platformName", "target")
    node.rename("platformType", "alias")
    notes.renamed(node, "the mapping of a data type to a platform is an alias now", node.get("alias"))


STEP = Step(
    "0.9.3",
    "0.9.4",
    change,
    frozenset(
        {
            *("ModeValue", "ModeValueConjunction", "ModeValueDisjunction"),
            *("dataMapping", "enablingModeValueList", "disablingModeValueList", "deadline"),
        }
    ),
)
