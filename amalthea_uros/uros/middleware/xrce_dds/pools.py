"""The build options with what an application needs."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.uros.middleware.profile import Option


def options(_application: Application, _middleware: Middleware, _data: ProfileData) -> Sequence[Option]:
    """None yet."""
    return ()
