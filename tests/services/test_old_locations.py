"""Findings about old models lead to the lines and columns of the old files, whatever the steps did to the objects."""

import pytest

import amalthea_uros as amuros
from amalthea_uros import am

OLD = """<?xml version="1.0" encoding="UTF-8"?>
<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xmlns:am="http://app4mc.eclipse.org/amalthea/0.8.0">
  <swModel>
    <tasks name="T" stimuli="S?type=Periodic Lost?type=Periodic" preemption="preemptive" multipleTaskActivationLimit="1">
      <callGraph>
        <graphEntries xsi:type="am:CallSequence" name="CS">
          <calls xsi:type="am:TaskRunnableCall" runnable="R?type=Runnable"/>
        </graphEntries>
      </callGraph>
    </tasks>
    <runnables name="R">
      <runnableItems xsi:type="am:RunnableInstructions">
        <default xsi:type="am:InstructionsConstant" value="100000"/>
      </runnableItems>
    </runnables>
  </swModel>
  <hwModel>
    <coreTypes name="CoreType" instructionsPerCycle="1.0"/>
    <system name="System">
      <ecus name="Ecu">
        <microcontrollers name="Micro">
          <cores name="Core" coreType="CoreType?type=CoreType">
            <prescaler name="P" clockRatio="1.0" quartz="Q?type=Quartz"/>
          </cores>
          <quartzes name="Q">
            <frequency value="100.0" unit="MHz"/>
          </quartzes>
        </microcontrollers>
      </ecus>
    </system>
  </hwModel>
  <osModel>
    <operatingSystems name="Os">
      <taskSchedulers name="Sched">
        <schedulingAlgorithm xsi:type="am:OSEK"/>
      </taskSchedulers>
    </operatingSystems>
  </osModel>
  <stimuliModel>
    <stimuli xsi:type="am:Periodic" name="S">
      <recurrence value="0" unit="ms"/>
    </stimuli>
  </stimuliModel>
  <mappingModel>
    <coreAllocation scheduler="Sched?type=TaskScheduler" core="Core?type=Core"/>
    <taskAllocation task="T?type=Task" scheduler="Sched?type=TaskScheduler" priority="3"/>
  </mappingModel>
</am:Amalthea>
"""


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "old.amxmi"
    path.write_text(OLD)
    return path


def line(text: str) -> int:
    """The line of the old file that contains a text."""
    return OLD[: OLD.index(text)].count("\n") + 1


@pytest.mark.parametrize(
    ("cls", "text"),
    [
        (am.Task, '<tasks name="T"'),
        (am.ActivityGraph, "<callGraph>"),
        (am.Group, "<graphEntries"),
        (am.RunnableCall, "<calls"),
        (am.Ticks, "<runnableItems"),
        (am.ProcessingUnitDefinition, "<coreTypes"),
        (am.ProcessingUnit, "<cores"),
        (am.PeriodicStimulus, "<stimuli "),
        (am.SchedulerAllocation, "<coreAllocation"),
        (am.TaskAllocation, "<taskAllocation"),
    ],
)
def test_every_object_has_a_place_in_the_old_file(cls, text, path):
    model = amuros.load(path)
    element = next(model.all(cls))
    assert element.document.location_of(element).line == line(text)


def test_references_lead_to_the_attribute(path):
    (finding,) = [finding for finding in amuros.load(path).findings if finding.rule == "XMI020"]
    assert (finding.location.line, finding.location.column) == (line("<tasks"), 21)
    assert "Lost" in finding.message


def test_rules_and_analyses_lead_to_the_objects(path):
    found = [finding for finding in amuros.check_files(path).findings if finding.object == "S" or "'S'" in finding.message]
    assert {finding.location.line for finding in found} <= {line("<stimuli "), line("<recurrence")}
    assert found
    path.write_text(OLD.replace('value="0" unit="ms"', 'value="5" unit="ms"').replace(" Lost?type=Periodic", ""))
    (process,) = amuros.analyze_files(path).analysis.processes
    assert (process.name, process.response.worst) == ("T", 1_000_000_000)
