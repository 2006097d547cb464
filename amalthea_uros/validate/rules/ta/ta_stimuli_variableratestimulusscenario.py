"""Variable-rate stimulus without a scenario."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import VariableRateStimulus
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: VariableRateStimulus, context: Context) -> Iterator[str]:
    if element.scenario is None:
        yield f"{element.name!r} has no scenario"


RULE = ModelRule(
    id="TA-Stimuli-VariableRateStimulusScenario",
    title="variable-rate stimulus without a scenario",
    severity=Severity.ERROR,
    target=VariableRateStimulus,
    check=_check,
    rationale="The rate is known, but not the points in time at which the stimulus occurs. APP4MC's validation also reports it.",
    remedy="Add a scenario with a clock.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <step value="1" unit="s"/>
    <occurrencesPerStep xsi:type="am:ContinuousValueConstant" value="9.0"/>
  </stimuli>
</stimuliModel>
""",
    edits={
        "</stimuli>": """  <scenario clock="C?type=ClockStepList"/>
  </stimuli>""",
        "</stimuliModel>": """  <clocks xsi:type="am:ClockStepList" name="C">
    <entries>
      <frequency value="50" unit="Hz"/>
      <time value="0" unit="s"/>
    </entries>
  </clocks>
</stimuliModel>""",
    },
)
