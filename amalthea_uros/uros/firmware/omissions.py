"""What a description states and the code that is written for it does not have, although there could be code for it."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.section import DescriptionSection

#: Keys of entities: rclc sets the depth and the history of the profiles that its functions name.
_OF_ENTITIES = ("depth", "history")
#: Keys of executors: threads are made without a core, and `rclc_executor_init` gets as many handles as there are.
_OF_EXECUTORS = ("core", "max_handles")


def omissions(description: Description) -> Iterator[Finding]:
    """A finding for each stated key of entities and executors that is not in the code."""
    for node in description.application.nodes:
        for entity in (*node.subscriptions, *node.services, *node.clients):
            yield from _stated(entity.name, entity, _OF_ENTITIES)
    for executor in description.middleware.stated_executors:
        yield from _stated(executor.name, executor, _OF_EXECUTORS)


def _stated(name: str, section: DescriptionSection, keys: tuple[str, ...]) -> Iterator[Finding]:
    for key in keys:
        if section.states(key):
            message = f"{key!r} of {name!r} is not in the code"
            yield Finding("GEN011", Severity.WARNING, message, section.location(key), "Add it to the code by hand.")
