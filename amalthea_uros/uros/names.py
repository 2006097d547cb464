"""Names that have to be unique."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.software import Channel, Label
from amalthea_uros.spec.description import Description
from amalthea_uros.uros.application.callbacks import sections_of
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.application.serving import stated_executors
from amalthea_uros.uros.transports.line import receive_interrupt


def check_unique_names(description: Description, notes: Notes) -> None:
    """Report processes, callbacks and nodes that share a name."""
    nodes = description.application.nodes
    _check("node", ((node.name, node.location("name")) for node in nodes), notes)
    _check("process", _processes(description), notes)


def check_unique_data(labels: Iterable[Label], channels: Iterable[Channel], notes: Notes) -> None:
    """Report labels that have the name of a channel, so that one could be taken for the other."""
    named = ((item.name, item.origin) for items in (labels, channels) for item in items)
    _check("label or channel", named, notes)


def _processes(description: Description) -> Iterable[tuple[str, Location | None]]:
    nodes = description.application.nodes
    if nodes:
        for executor in stated_executors(description.middleware):
            yield executor.name, executor.location("name")
        interrupt = receive_interrupt(description.middleware.transport)
        if interrupt is not None:
            yield interrupt.name, interrupt.location("name")
    for process in (*description.tasks, *description.isrs):
        yield process.name, process.location("name")
    for node in nodes:
        for _, callback in sections_of(node):
            yield callback.name, callback.location("name")


def _check(kind: str, names: Iterable[tuple[str, Location | None]], notes: Notes) -> None:
    first: dict[str, Location | None] = {}
    for name, location in sorted(names, key=lambda item: _line(item[1])):
        if name in first:
            notes.duplicate(kind, name, location, first[name])
        first.setdefault(name, location)


def _line(location: Location | None) -> tuple[int, int]:
    return (location.line or 0, location.column or 0) if location else (0, 0)
