"""Incomplete or early server call."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import SenderReceiverCommunication, ServerCall
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel


def _check(element: ServerCall | SenderReceiverCommunication, context: Context) -> Iterator[str | Downgraded]:
    wanted = "server runnable" if isinstance(element, ServerCall) else "label"
    if metamodel(element) < "3":
        yield Downgraded(f"the {type(element).__name__} is dropped, because the model is of a version before 3.0")
    elif (element.server_runnable if isinstance(element, ServerCall) else element.label) is None:
        yield f"the {type(element).__name__} names no {wanted}"


RULE = ModelRule(
    id="INC-SW-SERVER",
    title="server call or data access that cannot be converted",
    severity=Severity.ERROR,
    target=(ServerCall, SenderReceiverCommunication),
    check=_check,
    rationale="Without a server runnable, or a label, the conversion is aborted; models before 3.0 lose these items, with a warning.",
    remedy="Name the server runnable or the label, in a model of AMALTHEA 3.0 or newer.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:SynchronousServerCall"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:SynchronousServerCall" serverRunnable="Server?type=Runnable"/>
    </activityGraph>
  </runnables>
  <runnables name="Server"/>
</swModel>
""",
)
