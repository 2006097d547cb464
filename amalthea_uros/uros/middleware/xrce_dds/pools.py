"""The build options with what an application needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.middleware.profile import Option


def options(application: Application, middleware: Middleware, defaults: Mapping[str, int]) -> Sequence[Option]:
    """None yet."""
    return ()
