"""The whole of an `app.yaml`."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.hardware import Hardware
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.processes import Isr, Label, Task
from amalthea_uros.spec.requirements import Chain, Requirement
from amalthea_uros.spec.section import Section
from amalthea_uros.spec.values import Name


class Description(Section):
    """A micro-ROS application on a controller, with what else runs there."""

    amuros: Literal[1]
    """Version of the format."""
    name: Name
    """Name of the application."""
    hardware: Hardware
    """The controller."""
    middleware: Middleware = Field(default_factory=Middleware)
    """The generic micro-ROS model."""
    application: Application = Field(default_factory=Application)
    """The micro-ROS application."""
    tasks: list[Task] = Field(default_factory=list)
    """The ordinary tasks of the controller."""
    isrs: list[Isr] = Field(default_factory=list)
    """The ordinary interrupt service routines of the controller."""
    labels: dict[Name, Label] = Field(default_factory=dict)
    """Variables; those that are only read or written somewhere need not be stated."""
    chains: list[Chain] = Field(default_factory=list)
    """Cause-effect chains."""
    requirements: list[Requirement] = Field(default_factory=list)
    """Requirements on processes."""
