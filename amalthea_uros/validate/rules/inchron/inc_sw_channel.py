"""Item that is dropped."""

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
    yield f"the {type(element).__name__} is dropped"


RULE = ModelRule(
    id="INC-SW-CHANNEL",
    title="item that is dropped",
    severity=Severity.WARNING,
    target=(ChannelSend, ChannelReceive, EnforcedMigration, CustomEventTrigger, TerminateProcess),
    check=_check,
    rationale="am2inc drops channel accesses, migrations, custom event triggers and terminations, with one warning each.",
    remedy="Do not rely on them after the import.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:TerminateProcess"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph/>
  </runnables>
</swModel>
""",
)
