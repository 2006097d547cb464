"""Findings about recorded behaviour that a description cannot have."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.compare.recorded.host import RecordedHost
from amalthea_uros.diagnostics import Finding, Severity

_ADVICE = "Describe what it does by hand, or change the application; results are those without it."


def findings_of_recording(host: RecordedHost) -> Iterator[Finding]:
    """The findings, in the order of the executors."""
    for message, name in _messages(host):
        yield Finding("IMP027", Severity.WARNING, message, help=_ADVICE, object=name)


def _messages(host: RecordedHost) -> Iterator[tuple[str, str]]:
    for executor in host.executors:
        for other in executor.others:
            calls = counted(other.callback.threads.total(), "call")
            yield (
                f"{executor.name!r} calls {other.name!r} ({calls}), which is no timer and no subscription of a known node",
                other.name,
            )
    for each in (each for of in host.callbacks.values() for each in of):
        if each.callback.is_within_process:
            yield (
                f"{each.name!r} takes messages within its process, for which executors call it after all other kinds",
                each.name,
            )
        for topic, most in each.callback.published.items():
            if most > 1:
                yield (
                    f"{each.name!r} publishes up to {most} messages of {topic!r} in one call; a description has one",
                    each.name,
                )
    for topic in sorted(host.outside):
        yield f"{topic!r} is published outside callbacks, which a description does not have", topic
    if host.unnamed:
        messages = counted(host.unnamed, "message")
        yield f"publishers that are older than the recording sent {messages}; their topics are not known", ""
