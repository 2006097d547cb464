"""A report of a system of which a part cannot be simulated says so."""

import pytest
from lxml import html
from migration import model

from amalthea_uros import report

EXECUTION = '<items t="Ticks"><default t="DiscreteValueConstant" value="100000"/></items>'
CONTENT = """
<swModel>
  <tasks name="A" stimuli="P?type=PeriodicStimulus"><activityGraph>{}</activityGraph></tasks>
  <tasks name="B" stimuli="P?type=PeriodicStimulus"/>
</swModel>
<hwModel>
  <definitions t="ProcessingUnitDefinition" name="D" puType="CPU"/>
  <structures name="S"><modules t="ProcessingUnit" name="C" frequencyDomain="F?type=FrequencyDomain"
    definition="D?type=ProcessingUnitDefinition"/></structures>
  <domains t="FrequencyDomain" name="F"><defaultValue value="100.0" unit="MHz"/></domains>
</hwModel>
<osModel><operatingSystems name="OS">
  <taskSchedulers name="TS"><schedulingAlgorithm t="OSEK"/></taskSchedulers>
</operatingSystems></osModel>
<stimuliModel><stimuli t="PeriodicStimulus" name="P"><recurrence value="10" unit="ms"/></stimuli></stimuliModel>
<constraintsModel>
  <requirements t="ProcessRequirement" name="R" process="B?type=Task">
    <limit t="TimeRequirementLimit" limitType="UpperLimit" metric="ResponseTime"><limitValue value="5" unit="ms"/></limit>
  </requirements>
</constraintsModel>
<mappingModel>
  <schedulerAllocation scheduler="TS?type=TaskScheduler" responsibility="C?type=ProcessingUnit"/>
  <taskAllocation task="A?type=Task" scheduler="TS?type=TaskScheduler"><schedulingParameters priority="2"/></taskAllocation>
  <taskAllocation task="B?type=Task" scheduler="TS?type=TaskScheduler"><schedulingParameters priority="1"/></taskAllocation>
</mappingModel>
"""


@pytest.mark.parametrize("execution", [EXECUTION, ""], ids=["one of two", "both"])
def test_a_requirement_on_a_task_that_cannot_be_simulated(execution, tmp_path):
    path, page = tmp_path / "model.amxmi", tmp_path / "report.html"
    path.write_text(model("1.0.0", CONTENT.format(execution)))
    report(path).save(page)
    text = html.parse(page).getroot().text_content()
    assert "'B' is not simulated: it has no execution time" in text
