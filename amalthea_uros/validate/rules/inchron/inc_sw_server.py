"""Unsupported server call or sender-receiver access."""

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
        yield Downgraded(f"the {type(element).__name__} is dropped by am2inc, because the model is older than AMALTHEA 3.0")
    elif (element.server_runnable if isinstance(element, ServerCall) else element.label) is None:
        yield f"the {type(element).__name__} has no {wanted}"


RULE = ModelRule(
    id="INC-SW-SERVER",
    title="unsupported server call or sender-receiver access",
    severity=Severity.ERROR,
    target=(ServerCall, SenderReceiverCommunication),
    check=_check,
    rationale="am2inc aborts the conversion if the server runnable or the label is missing. In models before AMALTHEA 3.0 it "
    "drops these items and prints a warning.",
    remedy="Set the server runnable or the label, and use AMALTHEA 3.0 or newer.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:SynchronousServerCall"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'xsi:type="am:SynchronousServerCall"': 'xsi:type="am:SynchronousServerCall" serverRunnable="Server?type=Runnable"',
        "</swModel>": """  <runnables name="Server"/>
</swModel>""",
    },
)
