"""Timing, affinity and sequencing constraints in 0.7.1."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.v0_7_tools import content_of, names_of, remove_and_keep

#: Old class -> new class.
RENAMED_CONSTRAINTS = {
    "AgeConstraint": "EventChainLatencyConstraint",
    "ReactionConstraint": "EventChainLatencyConstraint",
    "SynchronisationConstraint": "EventSynchronizationConstraint",
}

#: Classes without successor.
REMOVED_CONSTRAINTS = frozenset({"OrderConstraint", "SchedulerPairingConstraint", "SchedulerSeparationConstraint"})

_LATENCY_TYPES = {"AgeConstraint": "Age", "ReactionConstraint": "Reaction"}


def change_constraints(models: ModelSet, notes: Notes) -> None:
    """Change everything below constraintsModel."""
    _rename(models, notes)
    _remove(models, notes)
    for constraint in models.nodes("runnableSequencingConstraints"):
        _change_groups(constraint, notes)


def _rename(models: ModelSet, notes: Notes) -> None:
    for constraint in models.nodes("timingConstraints"):
        if constraint.type in _LATENCY_TYPES:
            constraint.attributes["type"] = _LATENCY_TYPES[constraint.type]
        elif constraint.type == "DelayConstraint" and "mappingType" not in constraint.attributes:
            constraint.attributes["mappingType"] = "Reaction"
            notes.defaulted(
                constraint, "mappingType of a delay constraint: Reaction is what 0.7.0 meant", attribute="mappingType"
            )
        if constraint.type in RENAMED_CONSTRAINTS:
            notes.renamed(constraint, f"{constraint.type} -> {RENAMED_CONSTRAINTS[constraint.type]}")
    models.rename_classes(RENAMED_CONSTRAINTS)


def _remove(models: ModelSet, notes: Notes) -> None:
    removed = [node for node in models.nodes("timingConstraints", "affinityConstraints") if node.type in REMOVED_CONSTRAINTS]
    for constraint in removed:
        message = f"{constraint.type}: there is no successor"
        notes.kept(constraint, message, constraint.name)
    remove_and_keep(removed, "0.7.1")


def _change_groups(constraint: Node, notes: Notes) -> None:
    entries = []
    for group in constraint.all("runnableGroups"):
        grouping = group.attributes.pop("groupingType", "")
        if grouping == "atLeastOneOfThem":
            notes.lost(
                group,
                "grouping of a runnable sequencing constraint: all of the runnables are meant now",
                grouping,
                "groupingType",
            )
        of_group = group.all("entries")
        entries += of_group
        # The same runnable once.
        runnables = dict.fromkeys(target for entry in of_group for target in entry.references.pop("runnable", ()))
        if runnables:
            group.refer("runnables", *runnables)
            notes.converted(group, "entries of a group of runnables -> references", names_of(runnables))
    remove_all(entries)
    _move_scope(constraint, entries, notes)


def _move_scope(constraint: Node, entries: list[Node], notes: Notes) -> None:
    """The scope of all entries can be that of the constraint; scopes that differ have no place any more."""
    scopes = {tuple(entry.references.pop("processScope", ())) for entry in entries}
    if len(scopes) == 1 and "processScope" not in constraint.references and (scope := next(iter(scopes))):
        constraint.refer("processScope", *scope)
        notes.moved(
            constraint, "processScope of all entries -> processScope of the constraint", names_of(scope), "processScope"
        )
    elif any(scopes):
        detail = names_of(dict.fromkeys(target for scope in scopes for target in scope))
        notes.lost(constraint, "scopes of single runnables in a sequencing constraint", detail, "processScope")
    for entry in entries:
        if rest := content_of(entry):
            notes.lost(constraint, "content of an entry of a group of runnables", rest)
