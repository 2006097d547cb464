"""The whole of an `app.yaml`, and its JSON Schema for completion and checks in editors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Self

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.fields import Limits, entry, examines
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.host import HostSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.spec.processes import IsrSection, LabelSection, TaskSection
from amalthea_uros.spec.requirements import Chain, RequirementSection
from amalthea_uros.spec.section import EXTENSION, DescriptionSection
from amalthea_uros.spec.values import Name, VersionedSection, problem

#: Each is assembled anew, also if several name the same file.
MAX_CONTROLLERS = 100


class ControllerSection(DescriptionSection):
    """A micro-ROS application on a controller, and the other software that runs there."""

    name: Name
    """Name of the application, or of a controller of a robot."""
    hardware: HardwareSection
    """The controller."""
    os: OsSection = entry(default_factory=OsSection.model_construct)
    """The operating system."""
    middleware: Middleware = entry(default_factory=Middleware.model_construct)
    """The generic micro-ROS model."""
    application: Application = entry(default_factory=Application.model_construct)
    """The micro-ROS application."""
    tasks: list[TaskSection] = entry(default_factory=list)
    """Tasks of the controller that are not part of the micro-ROS application."""
    isrs: list[IsrSection] = entry(default_factory=list)
    """Interrupt service routines of the controller that are not part of the micro-ROS application."""
    labels: dict[Name, LabelSection] = entry(default_factory=dict)
    """Variables; one that is read or written somewhere needs no entry if its size and memory are the default ones."""
    chains: list[Chain] = entry(default_factory=list)
    """Cause-effect chains."""
    requirements: list[RequirementSection] = entry(default_factory=list)
    """Requirements on processes."""


class RobotController(ControllerSection):
    """One of several controllers: described here, or in a file of its own."""

    file: Name | None = None
    """The app.yaml that describes it, instead of the other keys; relative to the directory of this file, e.g. `drive.yaml`."""

    @classmethod
    def _prepared(cls, value: Any) -> Any:
        return _with_hardware_of("file", super()._prepared(value))

    @classmethod
    def implied_keys(cls) -> Mapping[str, Sequence[str]]:
        """The hardware is that of the file."""
        return {"file": ["hardware"]}

    @examines
    def _is_in_one_place(self) -> Self:
        own = _stated_of_controller(self, "chains", "requirements") if self.file is not None else []
        if own:
            raise problem(f"{own[0]!r} cannot be combined with 'file': state it there")
        return self


class Description(ControllerSection, VersionedSection):
    """A micro-ROS application on a controller, and the other software that runs there; or a robot with several controllers."""

    controllers: Annotated[list[RobotController], Limits(min_length=1, max_length=MAX_CONTROLLERS)] = entry(
        default_factory=list
    )
    """The controllers of a robot that has several ones; the name of each comes before those of its objects, e.g. `drive_Motor`."""
    host: HostSection | None = None
    """The host with ROS 2 at the other end of the transport."""

    @classmethod
    def _prepared(cls, value: Any) -> Any:
        return _with_hardware_of("controllers", super()._prepared(value))

    @classmethod
    def implied_keys(cls) -> Mapping[str, Sequence[str]]:
        """Each controller has its own hardware."""
        return {"controllers": ["hardware"]}

    @examines
    def _has_one_or_several_controllers(self) -> Self:
        own = _stated_of_controller(self) if self.controllers else []
        if own:
            raise problem(f"{own[0]!r} cannot be combined with 'controllers': state it in one of these")
        return self

    @classmethod
    def of_controller(cls, section: RobotController) -> Self:
        """The description of a controller of a robot as one of its own."""
        values = {name: getattr(section, name) for name in ControllerSection.model_fields}
        description = cls.model_construct(amuros=1, **values)
        description._where, description._stated = section._where, section._stated
        return description


#: What only one controller has, besides its hardware.
OF_CONTROLLER = ("os", "middleware", "application", "tasks", "isrs", "labels")


def _with_hardware_of(key: str, value: Any) -> Any:
    """The content of a section, with hardware that its controllers or another file state."""
    has_other = isinstance(value, dict) and key in value and "hardware" not in value
    return value | {"hardware": {}} if has_other else value


def _stated_of_controller(section: ControllerSection, *more: str) -> list[str]:
    """The keys of a section that only one controller has, and of some more, that it states."""
    hardware = ["hardware"] if section.hardware.model_fields_set else []
    return hardware + [key for key in (*OF_CONTROLLER, *more) if section.states(key)]


#: The draft that editors support.
_DRAFT = "http://json-schema.org/draft-07/schema#"
#: Where the schema is found on the web, which is also its name.
_ID = f"{DOCUMENTATION}/app.schema.json"
#: Extensions, and YAML's merge key, which editors look at before it is merged.
_OTHER_KEYS = f"^({EXTENSION}|<<$)"


def json_schema() -> dict[str, Any]:
    """The schema, draft-07, with the messages and snippets of yaml-language-server."""
    from amalthea_uros.spec.section_schemas import whole_schema

    schema = whole_schema(Description, "#/definitions/{name}")
    definitions: dict[str, Any] = schema.pop("$defs")
    whole: dict[str, Any] = {"$schema": _DRAFT, "$id": _ID, "title": "amuros application"} | _tidied(schema)
    named = {_name(name): _tidied(definition) for name, definition in definitions.items()}
    return whole | {"definitions": dict(sorted(named.items()))}


def _name(definition: str) -> str:
    """What users call a section: the classes of sections whose plain names are those of the performance model have a longer one."""
    return definition.removesuffix("Section")


def _tidied(schema: Any) -> Any:
    """The schema without titles that repeat keys, without `null` as a value, and without defaults in internal units."""
    if isinstance(schema, list):
        return [_tidied(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    found = {key: _tidied(value) for key, value in schema.items() if key != "title" or not isinstance(value, str)}
    if "$ref" in found:
        found["$ref"] = _name(found["$ref"])
    alternatives = found.get("anyOf")
    if alternatives is not None:
        kept = [item for item in alternatives if item != {"type": "null"}]
        if len(kept) == 1:
            del found["anyOf"]
            found = kept[0] | found
        else:
            found["anyOf"] = kept
    if "default" in found and not _is_value(found["default"], found):
        del found["default"]
    if "patternProperties" in found:
        found["additionalProperties"] = False  # these are the names of objects
    elif found.get("additionalProperties") is False:
        found["patternProperties"] = {_OTHER_KEYS: {}}
    if "$ref" in found and len(found) > 1:
        # Draft-07 ignores other keywords next to a reference.
        found["allOf"] = [{"$ref": found.pop("$ref")}]
    return found


def _is_value(default: Any, schema: dict[str, Any]) -> bool:
    """Whether a default is a value that may be written, rather than a missing one or a number of picoseconds or bits."""
    return default is not None and ("pattern" not in schema or isinstance(default, str))
