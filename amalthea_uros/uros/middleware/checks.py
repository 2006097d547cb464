"""What the middleware cannot do for an application, or only with delays: sizes, streams, waiting senders, histories, threads.

Until they are acknowledged, reliable messages keep buffers, and with most middlewares also the callback that sends them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros._internal.ports import ACTION_SERVICES, ACTION_TOPICS, LIFECYCLE_SERVICES, parameter_services
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.spec.application import Application, CallbackSection, MessageCallback, Subscription
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.callbacks import Callback, sections_of
from amalthea_uros.uros.application.messages import LONGEST, Message
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.profile import Profile


def check_middleware(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report what an application asks too much of its middleware."""
    _check_message_sizes(callbacks, profile, notes)
    _check_streams(callbacks, profile, notes)
    _check_blocking(callbacks, profile, notes)
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
    for message in (message for callback in callbacks for message in (*filter(None, [callback.incoming]), *callback.outgoing)):
        content, largest = message.stated_bytes, profile.largest_content(message.kind, reliable=message.reliable)
        limit = LONGEST if largest is None else min(LONGEST, largest)
        if content <= limit:
            continue
        verb = "received" if message.is_incoming else "sent"
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


def _check_streams(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report reliable messages whose acknowledgement time is not known, or that need more buffers than there are."""
    buffers = profile.buffers
    if buffers is None:
        return
    sent = [message for callback in callbacks for message in callback.outgoing if message.reliable]
    acknowledgement = profile.middleware.transport.acknowledgement
    if acknowledgement is None and profile.middleware.agent.acknowledgement is None:
        _report_unknown_time(sent, profile, notes)
    if profile.sending.waits:
        _check_steps(sent, buffers, profile, notes)
    elif acknowledgement is not None:
        _check_buffers(sent, buffers, acknowledgement, profile, notes)


def _report_unknown_time(sent: Iterable[Message], profile: Profile, notes: Notes) -> None:
    how = profile.sending
    for message in sent:
        blocks = f": it blocks {message.callback!r} for up to {time_text(how.timeout)}" if how.waits else ""
        text = f"{message.topic!r} is sent reliably, but the acknowledgement time is not specified{blocks}"
        ways = ["Set 'acknowledgement' under 'transport'", "use 'reliability: best-effort'"]
        if how.waits:
            ways.append("set 'reliable: {waits: false}' if this port does not wait")
        notes.warning("UR122", text, message.origin, f"{', or '.join(ways)}.")


def _check_steps(sent: Iterable[Message], buffers: int, profile: Profile, notes: Notes) -> None:
    """Report messages of more fragments than there are buffers: only one message waits for its acknowledgement at a time."""
    for message in sent:
        fragments = _fragments(message, profile)
        if fragments > buffers:
            steps = -(-fragments // buffers)
            text = (
                f"a message of {message.topic!r} has {fragments} fragments, but the reliable stream has only {buffers} buffers"
            )
            blocks = f"it is sent in {steps} steps, and {message.callback!r} waits for the acknowledgement of each"
            advice = f"Set RMW_UXRCE_STREAM_HISTORY to {_power_of_two(fragments)}, or send less data."
            notes.warning("UR123", f"{text}: {blocks}", message.origin, advice)


def _check_buffers(sent: Iterable[Message], history: int, acknowledgement: Time, profile: Profile, notes: Notes) -> None:
    """Report if the messages within an acknowledgement time need more buffers than there are."""
    often = ((each, -(-acknowledgement // each.interval) if each.interval else history + 1) for each in sent)
    buffers = sum(_fragments(message, profile) * times for message, times in often)
    if buffers > history:
        text = f"up to {buffers} buffers wait for acknowledgement at the same time, but the reliable stream has only {history}"
        size, time = _power_of_two(buffers), time_text(acknowledgement)
        advice = f"Set RMW_UXRCE_STREAM_HISTORY to {size} or more, or send less data per {time}."
        notes.warning("UR123", text, profile.middleware.transport.location("acknowledgement"), advice)


def _fragments(message: Message, profile: Profile) -> int:
    return len(profile.parts(message.kind, message.content_bytes, reliable=True))


def _power_of_two(number: int) -> int:
    """The least power of two that is not less; the build accepts no other history."""
    return 1 << (number - 1).bit_length()


def _check_blocking(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report waiting that execution times and response times do not contain."""
    senders = [callback for callback in callbacks if callback.outgoing]
    loops = {executor.name: executor for executor in profile.middleware.stated_executors if executor.loop is not None}
    outside = [callback for callback in senders if not (callback.in_executor and callback.executor in loops)]
    _check_waiting_outside(outside, profile, notes)
    _check_recovery(callbacks, profile, notes)
    if loops and (outside or profile.middleware.thread_count > 1):
        _check_sessions(senders, tuple(loops.values()), profile, notes)


def _check_waiting_outside(senders: Iterable[Callback], profile: Profile, notes: Notes) -> None:
    """Report callbacks that wait for acknowledgements of a known time in tasks that are modelled without waiting."""
    how, acknowledgement = profile.sending, profile.middleware.transport.acknowledgement
    if not how.waits or acknowledgement is None:
        return
    for callback in senders:
        topics = [message.topic for message in callback.outgoing if message.reliable]
        if topics:
            longest = time_text(min(acknowledgement, how.timeout) * len(topics))
            text = f"{callback.name!r} waits up to {longest} for acknowledgements, so that its response time is unknown"
            advice = (
                "Describe the 'loop' of the executor that runs it, set 'reliable: {waits: false}' if this port does not wait, "
                "or use 'reliability: best-effort'."
            )
            notes.warning("UR124", text, callback.origin, advice)


def _check_recovery(callbacks: Sequence[Callback], profile: Profile, notes: Notes) -> None:
    """Report incoming traffic that postpones the repetition of lost messages.

    The time without input begins anew with each message that arrives: `uxr_update_output_stream_heartbeat_timestamp` in
    src/c/core/session/stream/output_reliable_stream.c of eProsima/Micro-XRCE-DDS-Client.
    """
    how = profile.sending
    if not (profile.middleware.transport.is_lossy and how.waits) or how.resends_after is None:
        return
    incoming = [callback.incoming for callback in callbacks if callback.incoming is not None]
    dense = min(incoming, key=lambda message: message.interval, default=None)
    if dense is None or dense.interval >= how.resends_after:
        return
    for callback in callbacks:
        for message in callback.outgoing:
            if message.reliable:
                text = (
                    f"if a message of {message.topic!r} is lost, {callback.name!r} waits up to {time_text(how.timeout)}: it is sent "
                    f"again after {time_text(how.resends_after)} without input, but {dense.topic!r} can arrive every "
                    f"{time_text(dense.interval)}"
                )
                advice = "Use 'reliability: best-effort', or a shorter timeout: RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT."
                notes.warning("UR124", text, message.origin, advice)


def _check_sessions(senders: Iterable[Callback], loops: Sequence[ExecutorSection], profile: Profile, notes: Notes) -> None:
    """Report threads that keep others from sending; that nothing protects the session is reported with the executors."""
    how = profile.sending
    if how.holds_session_while_waiting:
        default = profile.waiting.default_timeout
        timeout = time_text(max(_timeout(executor, default) for executor in loops))
        text = f"a thread that waits for messages keeps the session for up to {timeout}; others that send wait for it:"
        names = ", ".join(repr(callback.name) for callback in senders)
        if names:
            notes.warning(
                "UR124", f"{text} {names}", profile.middleware.location("multithread"), "Use short timeouts of the loops."
            )


def _timeout(executor: ExecutorSection, default: Time) -> Time:
    loop = executor.loop
    if loop is None:
        return 0
    times = (loop.spin_some, loop.spin, loop.timeout)
    return next((time for time in times if time is not None), default)


#: Depths of the profiles `rmw_qos_profile_default` and `rmw_qos_profile_sensor_data` in ros2/rmw rmw/include/rmw/qos_profiles.h.
_RELIABLE, _BEST_EFFORT = 10, 5


def depth_of(section: CallbackSection) -> int | None:
    """The depth of the history of a callback's messages; None if it has none."""
    if not isinstance(section, MessageCallback):
        return None
    is_best_effort = isinstance(section, Subscription) and section.reliability == "best-effort"
    return section.depth or (_BEST_EFFORT if is_best_effort else _RELIABLE)


def kept_messages(application: Application, middleware: Middleware) -> int:
    """The most messages that the histories of an application keep together."""
    several = {
        HandleKind.ACTION_SERVER: ACTION_SERVICES,
        HandleKind.ACTION_CLIENT: ACTION_SERVICES + ACTION_TOPICS,
        HandleKind.PARAMETER_SERVICE: parameter_services(middleware.ros),
        HandleKind.LIFECYCLE_SERVICE: LIFECYCLE_SERVICES,
    }
    sections = (each for node in application.nodes for each in sections_of(node))
    return sum(several.get(kind, 1) * (depth_of(section) or 0) for kind, section in sections)
