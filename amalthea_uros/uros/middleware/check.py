"""What the middleware cannot do for an application, or only with delays."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.errors import ReadError
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.callbacks import Callback
from amalthea_uros.uros.middleware.blocking import check_blocking
from amalthea_uros.uros.middleware.histories import check_histories
from amalthea_uros.uros.middleware.load import profile_of
from amalthea_uros.uros.middleware.message_sizes import check_message_sizes
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.middleware.streams import check_streams
from amalthea_uros.uros.notes import Notes


def check_middleware(callbacks: Sequence[Callback], middleware: Middleware, notes: Notes) -> None:
    """Report what an application asks too much of its middleware; nothing but its profile if that cannot be read."""
    try:
        profile = profile_of(middleware)
    except ReadError as error:
        notes.findings.extend(error.findings)
        return
    check_message_sizes(callbacks, middleware, profile, notes)
    check_streams(callbacks, middleware, profile, notes)
    check_blocking(callbacks, middleware, profile, notes)
    check_histories(callbacks, middleware, profile, notes)
    _check_threads(middleware, profile, notes)


def _check_threads(middleware: Middleware, profile: Profile, notes: Notes) -> None:
    """Report threads whose priority is not known."""
    for thread in profile.threads(middleware):
        if thread.priority is None:
            text = f"the priority of the thread {thread.name!r} of {profile.name} is not specified: it {thread.does}"
            advice = f"Set it under 'middleware': tasks: [{{name: {thread.name}, priority: ...}}]."
            notes.error("APP003", text, middleware.location("tasks"), advice)
