"""Unsupported activity item."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ActivityGraphItem,
    ChannelReceive,
    ChannelSend,
    CustomEventTrigger,
    EnforcedMigration,
    TerminateProcess,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ActivityGraphItem, context: Context) -> Iterator[str]:
    yield f"the {type(element).__name__} is dropped by am2inc"


RULE = ModelRule(
    id="INC-SW-CHANNEL",
    title="unsupported activity item",
    severity=Severity.WARNING,
    target=(ChannelSend, ChannelReceive, EnforcedMigration, CustomEventTrigger, TerminateProcess),
    check=_check,
    rationale="am2inc drops channel accesses, enforced migrations, custom event triggers and process terminations, and prints "
    "one warning per class.",
    remedy="Replace the item, e.g. a channel access with label accesses, or do not rely on it after the import.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:TerminateProcess"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        """<activityGraph>
      <items xsi:type="am:TerminateProcess"/>
    </activityGraph>""": "<activityGraph/>",
    },
)
