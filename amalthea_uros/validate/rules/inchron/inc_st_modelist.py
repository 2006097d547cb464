"""Mode values set by a stimulus."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Stimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Stimulus, context: Context) -> Iterator[str]:
    if element.set_mode_value_list is not None:
        yield f"the mode values set by the stimulus {element.name or ''!r} are ignored by am2inc"


RULE = ModelRule(
    id="INC-ST-MODELIST",
    title="mode values set by a stimulus",
    severity=Severity.WARNING,
    target=Stimulus,
    check=_check,
    rationale="am2inc silently ignores mode values that are set by stimuli.",
    remedy="Set the mode labels in a runnable instead.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <setModeValueList/>
  </stimuli>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
""",
)
