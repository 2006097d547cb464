"""Invalid custom property of a callback server."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import BooleanObject, CustomProperty, Group, StringObject, Task
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel

#: The orders in which a group of a callback server can dispatch its services.
_POLICIES = ("FIFO", "LIFO", "Priority")


def _check(element: CustomProperty, context: Context) -> Iterator[str]:
    if metamodel(element) < "3":
        return
    holder, value = element.container, element.value
    if isinstance(holder, Task) and element.key == "callbackServer" and not isinstance(value, BooleanObject):
        yield f"the custom property 'callbackServer' of the task {holder.name or ''!r} is not a BooleanObject"
    if isinstance(holder, Group) and element.key == "dispatchingPolicy" and _is_server(holder.enclosing(Task)):
        policy = value.value if isinstance(value, StringObject) else None
        if policy not in _POLICIES:
            yield f"the custom property 'dispatchingPolicy' of the group {holder.name or ''!r} is not one of {', '.join(_POLICIES)}"


def _is_server(task: Task | None) -> bool:
    """Whether a task is a callback server, whose groups are services."""
    properties = task.custom_properties if task is not None else []
    return any(p.key == "callbackServer" and isinstance(p.value, BooleanObject) and p.value.value for p in properties)


RULE = ModelRule(
    id="INC-SW-DISPATCH",
    title="invalid custom property of a callback server",
    severity=Severity.ERROR,
    target=CustomProperty,
    check=_check,
    rationale="am2inc crashes with a segmentation fault at an invalid callbackServer, and aborts the conversion at an invalid "
    "dispatchingPolicy.",
    remedy="Use a BooleanObject for callbackServer, and a StringObject with the value FIFO, LIFO or Priority for "
    "dispatchingPolicy.",
    fails="""
<swModel>
  <tasks name="T">
    <customProperties key="callbackServer">
      <value xsi:type="am:BooleanObject" value="true"/>
    </customProperties>
    <activityGraph>
      <items xsi:type="am:Group" name="G">
        <customProperties key="dispatchingPolicy">
          <value xsi:type="am:StringObject" value="random"/>
        </customProperties>
      </items>
    </activityGraph>
  </tasks>
</swModel>
""",
    edits={'value="random"': 'value="FIFO"'},
)
