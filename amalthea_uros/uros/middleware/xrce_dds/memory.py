"""The memory that the middleware occupies."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.uros.middleware.profile import MemoryUse


def memory(_application: Application, _middleware: Middleware, _data: ProfileData) -> Sequence[MemoryUse]:
    """None yet."""
    return ()
