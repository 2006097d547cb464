"""The whole of an `app.yaml`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.spec.processes import IsrSection, LabelSection, TaskSection
from amalthea_uros.spec.requirements import Chain, RequirementSection
from amalthea_uros.spec.section import Section
from amalthea_uros.spec.values import WHOLE_NUMBER, Name


class Description(Section):
    """A micro-ROS application on a controller, and the other software that runs there."""

    amuros: Annotated[Literal[1], WHOLE_NUMBER]
    """Version of the format."""
    name: Name
    """Name of the application."""
    hardware: HardwareSection
    """The controller."""
    os: OsSection = Field(default_factory=OsSection)
    """The operating system."""
    middleware: Middleware = Field(default_factory=Middleware)
    """The generic micro-ROS model."""
    application: Application = Field(default_factory=Application)
    """The micro-ROS application."""
    tasks: list[TaskSection] = Field(default_factory=list)
    """Tasks of the controller that are not part of the micro-ROS application."""
    isrs: list[IsrSection] = Field(default_factory=list)
    """Interrupt service routines of the controller that are not part of the micro-ROS application."""
    labels: dict[Name, LabelSection] = Field(default_factory=dict)
    """Variables; one that is read or written somewhere needs no entry if its size and memory are the default ones."""
    chains: list[Chain] = Field(default_factory=list)
    """Cause-effect chains."""
    requirements: list[RequirementSection] = Field(default_factory=list)
    """Requirements on processes."""
