"""Labels: those defined in the description, the buffers of messages, and those that are only accessed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import AccessKind, LabelAccess, walk
from amalthea_uros.perf.mapping import Placement
from amalthea_uros.perf.software import Label, Runnable
from amalthea_uros.spec.description import Description
from amalthea_uros.units import DataSize
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assembly.hardware import Controller

#: Size of a label that is only accessed: a 32-bit word.
DEFAULT_SIZE: DataSize = 32


def labels_of(description: Description, callbacks: Iterable[Callback], runnables: Mapping[str, Runnable]) -> tuple[Label, ...]:
    """All labels that are defined or accessed."""
    sizes = {name: (label.size, label.location()) for name, label in description.labels.items()}
    for callback in callbacks:
        if callback.buffer is not None and callback.incoming is not None:
            sizes.setdefault(callback.buffer, (callback.incoming.size, callback.origin))
    for runnable in runnables.values():
        for access in _accesses(runnable):
            sizes.setdefault(access.label, (DEFAULT_SIZE, runnable.origin))
    return tuple(Label(name=name, size=size, origin=origin) for name, (size, origin) in sizes.items())


def _accesses(runnable: Runnable) -> list[LabelAccess]:
    return [activity for activity in walk(runnable.activities) if isinstance(activity, LabelAccess)]


def placements(labels: Iterable[Label], description: Description, controller: Controller, notes: Notes) -> list[Placement]:
    """The memory of each label."""
    found = []
    for label in labels:
        section = description.labels.get(label.name)
        memory = section.memory if section and section.memory else controller.label_memory
        if section and section.memory and section.memory not in controller.memories:
            notes.undefined("memory", section.memory, controller.memories, section.location("memory"))
        elif memory is not None:
            found.append(Placement(element=label.name, memory=memory))
    return found


def check_misspelled_labels(description: Description, runnables: Mapping[str, Runnable], notes: Notes) -> None:
    """Report labels that are only read and whose name is similar to one that is only written: probably a typing error."""
    readers: dict[str, Location | None] = {}
    written = set()
    for runnable in runnables.values():
        for access in _accesses(runnable):
            if access.kind is AccessKind.READ:
                readers.setdefault(access.label, runnable.origin)
            else:
                written.add(access.label)
    suggestions = Suggestions()
    unread = written - readers.keys() - description.labels.keys()
    for name, origin in readers.items():
        if name in written or name in description.labels:
            continue
        near = suggestions.nearest(name, unread, cutoff=0.8)
        if near:
            message = f"label {name!r} is read but never written, and {near!r} is written but never read"
            notes.warning("APP008", message, origin, f"Did you mean {near!r}? If not, define both under 'labels'.")
