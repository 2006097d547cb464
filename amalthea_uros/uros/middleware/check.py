"""What the middleware cannot do for an application, or only with delays."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros.uros.application.callbacks import Callback, Message
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.blocking import check_blocking
from amalthea_uros.uros.middleware.histories import check_histories
from amalthea_uros.uros.middleware.kinds import LONGEST, message_kind, stated_bytes
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.middleware.streams import check_streams


def check_middleware(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report what an application asks too much of its middleware."""
    _check_message_sizes(callbacks, profile, notes)
    check_streams(callbacks, profile, notes)
    check_blocking(callbacks, profile, notes)
    check_histories(callbacks, profile, notes)
    _check_threads(profile, notes)


def _check_threads(profile: Profile, notes: Notes) -> None:
    """Report threads whose priority is not known."""
    for thread in profile.threads:
        if thread.priority is None:
            text = f"the priority of the thread {thread.name!r} of {profile.name} is not specified: it {thread.does}"
            advice = f"Set it under 'middleware': tasks: [{{name: {thread.name}, priority: ...}}]."
            notes.error("APP003", text, profile.middleware.location("tasks"), advice)


def _check_message_sizes(callbacks: Iterable[Callback], profile: Profile, notes: Notes) -> None:
    """Report messages that cannot be sent or received."""
    for message, incoming in _messages(callbacks):
        kind, content = message_kind(message, incoming=incoming), stated_bytes(message)
        largest = profile.largest_content(kind, reliable=message.reliable)
        limit = LONGEST if largest is None else min(LONGEST, largest)
        if content <= limit:
            continue
        verb = "received" if incoming else "sent"
        how = "reliably" if message.reliable else "best effort"
        text = f"a message of {message.topic!r} has {content} B, but at most {limit} B can be {verb} {how}"
        notes.error("UR121", text, message.origin, _advice(message, profile))


def _advice(message: Message, profile: Profile) -> str:
    ways = ["reduce the size of the message"]
    options = profile.limiting_options(reliable=message.reliable)
    if options:
        ways.append(f"increase {' or '.join(options)} in the build and under 'limits'")
    if not message.reliable:
        ways.append("send it reliably, in fragments")
    text = ", or ".join(ways)
    return f"{text[0].upper()}{text[1:]}."


def _messages(callbacks: Iterable[Callback]) -> Iterator[tuple[Message, bool]]:
    """Each message with whether it arrives."""
    for callback in callbacks:
        if callback.incoming is not None:
            yield callback.incoming, True
        yield from ((message, False) for message in callback.outgoing)
