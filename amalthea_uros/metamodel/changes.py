"""The modifications of a document since it was read: only they must be serialised again."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.metamodel.classes.sw import CallArgument, RunnableCall
from amalthea_uros.metamodel.containment import path_of
from amalthea_uros.metamodel.element import Element, references_of


class Changes:
    """The modifications of a document since it was read; the rest can be copied from the source.

    Attributes
    ----------
    modified : modified objects and all their containers
    renamed : objects whose unique names may have changed, or which were added or removed
    """

    def __init__(self) -> None:
        self.modified: set[Element] = set()
        self.renamed: set[Element] = set()

    def note(self, path: list[Element], renames: bool) -> None:
        """Note the change of an object, given with its containers."""
        self.modified.update(path)
        if renames:
            self.renamed.add(path[0])


def propagate_renames(documents: Iterable[tuple[Element, Changes]]) -> None:
    """Mark as modified, in all documents (root and changes) of a model, everything in which the name of a renamed object occurs.

    These are its parts, whose own names may be derived from it, and the holders of references to it and to them.
    """
    documents = tuple(documents)
    renamed = {element for _, changes in documents for element in changes.renamed}
    affected: set[Element] = set()
    while renamed - affected:
        affected |= {part for element in renamed for part in element.walk()}
        for root, changes in documents:
            for holder in root.walk():
                if holder in affected and holder.is_referable:
                    changes.modified.update(path_of(holder))
                for name, value in references_of(holder):
                    if not _refers_to_any(value, affected):
                        continue
                    changes.modified.update(path_of(holder))
                    # The names of namespace members and of call arguments are derived from those of their references.
                    if name == "namespace" or isinstance(holder, RunnableCall | CallArgument):
                        renamed.add(holder)


def _refers_to_any(value: Element | list[Element], affected: set[Element]) -> bool:
    return not affected.isdisjoint(value) if isinstance(value, list) else value in affected
