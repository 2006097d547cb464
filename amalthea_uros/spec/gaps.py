"""Values that are still to be filled in: `TODO` in place of a value, as `amuros import` writes it."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.spec.nodes import MappingNode, Node, ScalarNode, SequenceNode, SourceText
from amalthea_uros.spec.section import EXTENSION

GAP = "TODO"
#: What to write for the keys that source code does not tell.
_ADVICE = {
    "execution_time": "Measure it, or write bounds such as {min: 10 us, max: 60 us}.",
    "base": "Measure an iteration without messages, or write bounds such as {min: 10 us, max: 60 us}.",
    "per_message": "Measure how long it takes to take a message, e.g. 30 us.",
    "rate": "Write how often messages arrive at most, e.g. 20 Hz.",
    "message_size": "Write the longest message, e.g. 64 B.",
    "frequency": "Write the clock of the controller, e.g. 160 MHz.",
    "bitrate": "Write the bit rate of the link, e.g. 20 Mbit/s.",
    "baud_rate": "Write the rate of the line, as the agent has it, e.g. 115200.",
    "transport": "Write the transport to the agent, e.g. {serial: {baud_rate: 115200}}.",
    "sleep": "Write how long the thread sleeps in its loop, e.g. 10 ms.",
    "trigger": "Write the sets of callbacks that it waits for, e.g. {custom: [[A, B], [C]]}.",
}


def is_gap(node: Node) -> bool:
    """Whether a value is to be filled in."""
    return isinstance(node, ScalarNode) and node.value == GAP


def gaps(node: Node, source: SourceText) -> Iterator[Finding]:
    """A finding for each value that is to be filled in; also for names, which `TODO` could be."""
    for key, value in _values(node, ""):
        if is_gap(value):
            what = f"{key!r} has no value yet (TODO)" if key else "a value is still to be filled in (TODO)"
            advice = _ADVICE.get(key, "Replace TODO by a value.")
            yield Finding("IMP001", Severity.ERROR, what, source.location(value.place), advice)


def _values(node: Node, key: str) -> Iterator[tuple[str, Node]]:
    match node:
        case MappingNode():
            for name, item in node.items.items():
                if not name.startswith(EXTENSION):
                    yield from _values(item, name)
        case SequenceNode():
            for item in node.items:
                yield from _values(item, key)
        case _:
            yield key, node
