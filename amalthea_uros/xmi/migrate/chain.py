"""From version to version: which steps, in which order, for which files of a set."""

from __future__ import annotations

from amalthea_uros.xmi.emf.versions import position
from amalthea_uros.xmi.migrate.steps import DOWN, UP
from amalthea_uros.xmi.tree.model_set import ModelSet, Step, Tree
from amalthea_uros.xmi.tree.node import all_below
from amalthea_uros.xmi.tree.notes import StepNotes, report_postponed, restore_postponed

_UP = {step.source: step for step in UP}
_DOWN = {step.source: step for step in DOWN}

#: How many versions back the content of a file may be: its namespace was raised when the work on a version began.
_BEHIND = 2


def migrate(models: ModelSet, target: str, notes: StepNotes) -> None:
    """Take all files of a set to a version; each joins the others at its own.

    Raises
    ------
    KeyError : there is no such version.
    """
    for tree in models.trees:
        tree.version = version_of_content(tree, target)
    goal = position(target)
    lowest = min(models.trees, key=lambda tree: position(tree.version)).version
    while position(lowest) < goal:
        lowest = _take(models, _UP[lowest], notes)
    highest = max(models.trees, key=lambda tree: position(tree.version)).version
    while position(highest) > goal:
        highest = _take(models, _DOWN[highest], notes)
    report_postponed(models.postponed, notes)
    for (node, name), targets in models.set_aside.items():
        lost = ", ".join(repr(target.name) for target in targets)
        notes.lost(node, f"reference {name!r}: this version has no place for it", lost, name)
    drop_dangling(models, notes)


def _take(models: ModelSet, step: Step, notes: StepNotes) -> str:
    if step.change is not None:
        models.begin_step(step.source)
        notes.version = step.target
        restore_postponed(models.postponed, step.target, notes)
        step.change(models, notes)
    for tree in models.trees:
        if tree.version == step.source:
            tree.version = step.target
    return step.target


def version_of_content(tree: Tree, target: str) -> str:
    """The version to begin with: the declared one, or one shortly before if the content is still that of it."""
    found, version = tree.version, tree.version
    if position(target) < position(version):
        return version
    for _ in range(_BEHIND):
        before = next((step for step in _UP.values() if step.target == version), None)
        if before is None:
            break
        version = before.source
        if not tree.names.isdisjoint(before.leftovers):
            found = version
    return found


def drop_dangling(models: ModelSet, notes: StepNotes) -> None:
    """Remove references to objects that a step removed."""
    nodes = all_below([tree.root for tree in models.trees])
    attached = set(nodes)
    for node in nodes:
        if not node.references:
            continue
        for name, targets in list(node.references.items()):
            if attached.issuperset(targets):
                continue
            kept = [target for target in targets if target in attached or target.is_proxy]
            if len(kept) == len(targets):
                continue
            lost = ", ".join(repr(target.name) for target in targets if target not in kept)
            notes.lost(node, f"reference {name!r}: its target is lost", lost, name)
            if kept:
                node.references[name] = kept
            else:
                del node.references[name]
