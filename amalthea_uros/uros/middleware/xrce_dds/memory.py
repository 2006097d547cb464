"""The memory that the middleware occupies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.middleware.profile import MemoryUse


def memory(application: Application, middleware: Middleware, defaults: Mapping[str, int]) -> Sequence[MemoryUse]:
    """None yet."""
    return ()
