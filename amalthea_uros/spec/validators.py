"""Validators of values, as parts of the schemas of pydantic.

Its own ones, such as `BeforeValidator` and `field_validator("*")`, inspect the signatures of their functions once for each field of
each section, which took a third of the time of a short command.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_after_validator_function, no_info_before_validator_function

from amalthea_uros._internal.records import dataclass


@dataclass(frozen=True, slots=True)
class Before:
    """A mark of a type: what converts a value before its type is checked."""

    convert: Callable[[Any], Any]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_before_validator_function(self.convert, handler(source))


@dataclass(frozen=True, slots=True)
class After:
    """A mark of a type: what examines a value of the right type."""

    examine: Callable[[Any], Any]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_after_validator_function(self.examine, handler(source))


def require_values(schema: Any) -> None:
    """Have all fields of a section refuse keys without a value: a mistake also where the key is optional."""
    # The validators of the whole section are around those of its fields.
    while schema["type"] != "model-fields":
        schema = schema["schema"]
    for field in schema["fields"].values():
        # A default is not examined.
        holder = field["schema"] if field["schema"]["type"] == "default" else field
        if holder["schema"].get("function", {}).get("function") is not _given:
            holder["schema"] = no_info_before_validator_function(_given, holder["schema"])


def _given(value: Any) -> Any:
    if value is None:
        raise PydanticCustomError("empty", "no value")
    return value
