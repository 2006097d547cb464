"""Findings of extracting the performance model from an AMALTHEA model."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="EXT001",
        title="objects that are not taken into account",
        severity=Severity.INFO,
        rationale="Objects of this class have no counterpart in the performance model, so they do not influence the results.",
        remedy="Nothing to do if they do not influence the timing.",
        fails="""
<mappingModel><runnableAllocation/></mappingModel>
""",
    ),
    FindingKind(
        id="EXT002",
        title="name that occurs more than once",
        severity=Severity.WARNING,
        rationale="Results are reported by name, so the object gets a unique name there.",
        remedy="Give each object a name of its own.",
        fails="""
<swModel><tasks name="T"/><tasks name="T"/></swModel>
""",
    ),
    FindingKind(
        id="EXT003",
        title="reference to an object that is not taken into account",
        severity=Severity.WARNING,
        rationale=(
            "The object is not part of the model, or was left out because it is incomplete. The reference is "
            "treated as not set."
        ),
        remedy="Correct the reference, or complete the object.",
        fails="""
<swModel><tasks name="T" stimuli="S?type=SingleStimulus"/></swModel>
""",
    ),
    FindingKind(
        id="EXT004",
        title="incomplete object",
        severity=Severity.WARNING,
        rationale=(
            "A value that the analysis needs is missing. What the object would influence is unknown, if it is part of a process or "
            "activates one; otherwise it is left out."
        ),
        remedy="Add the missing value.",
        fails="""
<mappingModel><taskAllocation/></mappingModel>
""",
    ),
    FindingKind(
        id="EXT005",
        title="property of amuros that cannot be read",
        severity=Severity.WARNING,
        rationale="The property says what a task means: an executor, or a message on a wire. Without it, the activation of the task is "
        "unknown; without that of the network, the activation of all tasks.",
        remedy="Build the model again, or remove the property if the task is an ordinary one.",
        fails="""
<swModel>
  <tasks name="T">
    <customProperties key="amuros.executor"><value xsi:type="am:StringObject" value="{}"/></customProperties>
  </tasks>
</swModel>
""",
    ),
)
