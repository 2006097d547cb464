"""Operating systems as data, by name or as files of users."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.spec.section import Section
from amalthea_uros.spec.values import WHOLE_NUMBER, Name


class Rtos(Section):
    """An operating system that platforms and applications refer to by name."""

    amuros: Annotated[Literal[1], WHOLE_NUMBER]
    """Version of the format."""
    rtos: Name
    """Name by which `os.rtos` refers to it."""
    title: Name
    """Its full name."""
    os: OsSection = Field(default_factory=OsSection)
    """Its properties; keys of the platform and of the application override them."""
    middleware: Middleware = Field(default_factory=Middleware)
    """The generic micro-ROS model as ported to it; keys of the platform and of the application override it, key by key."""
    sources: dict[Name, str] = Field(default_factory=dict)
    """Sources of the figures, by their keys."""
