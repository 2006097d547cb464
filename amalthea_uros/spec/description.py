"""The whole of an `app.yaml`, and its JSON Schema for completion and checks in editors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, Self

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.fields import entry, examines
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.host import HostSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.spec.processes import IsrSection, LabelSection, TaskSection
from amalthea_uros.spec.requirements import Chain, RequirementSection
from amalthea_uros.spec.section import EXTENSION, DescriptionSection
from amalthea_uros.spec.values import WHOLE_NUMBER, Name, problem


class ControllerFile(DescriptionSection):
    """A controller of a robot, which a description of its own describes."""

    name: Name
    """Name of the controller; it is put before the names of all that is described in its file, e.g. `drive_Motor`."""
    file: Name
    """Its description, relative to the directory of this file, e.g. `drive.yaml`."""


class Description(DescriptionSection):
    """A micro-ROS application on a controller, and the other software that runs there; or a robot with several controllers."""

    amuros: Annotated[Literal[1], WHOLE_NUMBER]
    """Version of the format."""
    name: Name
    """Name of the application."""
    hardware: HardwareSection
    """The controller."""
    os: OsSection = entry(default_factory=OsSection.model_construct)
    """The operating system."""
    middleware: Middleware = entry(default_factory=Middleware.model_construct)
    """The generic micro-ROS model."""
    application: Application = entry(default_factory=Application.model_construct)
    """The micro-ROS application."""
    controllers: list[ControllerFile] = entry(default_factory=list)
    """The controllers of a robot that has several ones, instead of `hardware` and everything that runs on it."""
    host: HostSection | None = None
    """The host with ROS 2 at the other end of the transport."""
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

    @classmethod
    def _prepared(cls, value: Any) -> Any:
        value = super()._prepared(value)
        has_several = isinstance(value, dict) and "controllers" in value and "hardware" not in value
        return value | {"hardware": {}} if has_several else value

    @classmethod
    def implied_keys(cls) -> Mapping[str, Sequence[str]]:
        """Each controller states its hardware in its own file."""
        return {"controllers": ["hardware"]}

    @examines
    def _describes_one_or_several(self) -> Self:
        if self.controllers:
            own = ["hardware"] if self.hardware.model_fields_set else []
            own += [key for key in _OF_ONE_CONTROLLER if self.states(key)]
            if own:
                raise problem(f"{own[0]!r} cannot be combined with 'controllers': state it in the file of a controller")
        return self


#: What a controller has, besides its hardware.
_OF_ONE_CONTROLLER = ("os", "middleware", "application", "tasks", "isrs", "labels")

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
