"""The whole of an `app.yaml`, and its JSON Schema for completion and checks in editors."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.fields import entry
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.host import HostSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.spec.processes import IsrSection, LabelSection, TaskSection
from amalthea_uros.spec.requirements import Chain, RequirementSection
from amalthea_uros.spec.section import EXTENSION, DescriptionSection
from amalthea_uros.spec.values import WHOLE_NUMBER, Name


class Description(DescriptionSection):
    """A micro-ROS application on a controller, and the other software that runs there."""

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
