"""1.2.0 -> 2.0.0: scheduling algorithms and their parameters are data, and conditions are more than those about modes."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.steps.kept import restore_2_0_0
from amalthea_uros.xmi.migrate.steps.scheduling import (
    AddedDefinitions,
    convert_algorithms,
    convert_parameters,
    convert_properties,
)
from amalthea_uros.xmi.migrate.steps.v0_9_7 import conditions_below
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 1.2.0."""
    definitions = AddedDefinitions(models)
    convert_algorithms(models, definitions, notes)
    convert_parameters(models, definitions, notes)
    convert_properties(models, definitions, notes)
    definitions.insert(notes)
    _convert_conditions(models, notes)
    restore_2_0_0(models, notes)


def _convert_conditions(models: ModelSet, notes: StepNotes) -> None:
    loops = [condition for loop in models.nodes("items") if loop.type == "WhileLoop" for condition in loop.all("condition")]
    # The conditions of mode switches keep their classes until 3.0.0.
    for holder in (*models.nodes("executionCondition"), *loops):
        _rename(holder, "ModeConditionDisjunction", "ConditionDisjunction", notes)
        for condition in conditions_below(holder):
            _rename(condition, "ModeConditionConjunction", "ConditionConjunction", notes)


def _rename(node: Node, old: str, new: str, notes: StepNotes) -> None:
    if node.type == old:
        node.type = new
        notes.renamed(node, f"class is now {new}")


STEP = Step("1.2.0", "2.0.0", change, frozenset({"schedulingAlgorithm", "parameterExtensions"}))
