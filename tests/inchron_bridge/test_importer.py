"""Projects against those that INCHRON's importer makes of the same AMALTHEA models, fact by fact."""

import json
import re

import pytest
from iprx_facts import VECTORS, differences, facts_of
from support import ROOT, model_text

from amalthea_uros.services.export import export
from amalthea_uros.services.subject import open_system

PAGE = (ROOT / "docs" / "inchron.md").read_text(encoding="utf-8")
#: What the importer leaves out: patterns of facts that only we write, each with the reason.
ADDED = {
    r"/comment$": "a project has no place for it",
    r"/(memories|interconnects)\[\w+\]/clock$": "the metamodel demands a clock",
    r"^/requirements(\[\w+_response_time\])?$": "the importer drops requirements on processes and runnables",
    r"/generators\[rounds_of_\w+\]$": "the importer drops the activations of executors",
    r"/graphEntries\[CallSequence_0\]/calls\[ModeAccess\]$": "the importer drops reads of modes",
}
#: Where the importer writes something that the model does not say: by the model, its row of docs/inchron.md and the facts that differ.
CHANGED = {
    "10_chain_gap": ("a segment that begins with another event than the previous one ends with", r"^/eventChains\[EC\]/nodes"),
    "10_lat_nobounds": ("a latency constraint without an upper limit", r"^/requirements\[LC\]/"),
    "20_ticks_beta": ("a beta distribution", r"/timeDistribution/type$"),
    "20_ticks_bounds_default": ("bounds without a shape", r"/timeDistribution/mean/value$"),
    "22_label_undef": ("an access of unknown kind", r"/variables$|/calls\[(Incomplete|LabelAccess_L1_0)\]$"),
    "25_modelabelaccess": ("a counter that is set", r"/calls\[NumericModeLabelAccess_1\]/value$"),
    "25_switch_num_lt": ("a relation other than equal", r"^/globalConditions\[Condition_0\]/conjunctions"),
    "44_unalloc_task_only": (
        "a task without allocation, if nothing else is without an operating system",
        r"^/systems\[__GLOBAL__\]$|/calls\[ActivateT1\]/target$",
    ),
}


def vectors():
    found = sorted(VECTORS.glob("*.json"))
    return [pytest.param(path, id=path.stem) for path in found] or [pytest.param(None, marks=pytest.mark.skip("no vectors"))]


@pytest.mark.parametrize("vector", vectors())
def test_projects_are_those_of_the_importer(vector, tmp_path):
    stored = json.loads(vector.read_text())
    result = export(VECTORS / stored["input"], tmp_path / "project.iprx")
    changed = [
        path
        for path, _, theirs in differences(facts_of(result.text), stored["model"])
        if theirs is not None or not any(re.search(pattern, path) for pattern in ADDED)
    ]
    _, pattern = CHANGED.get(vector.stem, ("", None))
    assert [path for path in changed if pattern is None or not re.search(pattern, path)] == []
    assert bool(changed) == (pattern is not None)


def test_the_page_lists_what_differs():
    table = PAGE.partition("with a few exceptions")[2].partition("\n\n| ")[2].partition("\n\n")[0]
    rows = [row.split(" | ")[0].removeprefix("| ") for row in table.splitlines()[2:]]
    assert sorted(rows) == sorted(row for row, _ in CHANGED.values())


def exported(model, tmp_path):
    """The facts of the project of a model."""
    (tmp_path / "model.amxmi").write_text(model_text(model))
    return facts_of(export(tmp_path / "model.amxmi", tmp_path / "project.iprx").text)


def outline(entries):
    """The names of entries of a call graph and of what is in them."""
    return [
        (entry.get("name"), [call["name"] for call in entry["calls"]])
        if entry["class"] == "CallSequence" and "calls" in entry
        else (entry.get("name"), *(outline(each.get("graphEntries", ())) for each in entry.get("entries", [entry])))
        for entry in entries
    ]


#: A runnable with a condition, a schedule point, and a loop and switches with conditions of their own; the task of a conditional stimulus.
CONDITIONED = """\
<swModel>
  <tasks name="T" stimuli="S?type=SingleStimulus"/>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="5"/></items>
      <items xsi:type="am:Switch">
        <entries name="outer">
          <items xsi:type="am:WhileLoop">
            <items xsi:type="am:SchedulePoint"/>
            <condition><entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="1"/></condition>
          </items>
          <condition><entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="2"/></condition>
        </entries>
      </items>
    </activityGraph>
    <executionCondition>
      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="3"/>
    </executionCondition>
  </runnables>
  <modes xsi:type="am:NumericMode" name="M"/>
  <modeLabels name="L" mode="M?type=NumericMode" initialValue="0"/>
</swModel>
<stimuliModel>
  <stimuli xsi:type="am:SingleStimulus" name="S">
    <executionCondition>
      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="4"/>
    </executionCondition>
    <occurrence value="1" unit="ms"/>
  </stimuli>
</stimuliModel>
"""


def test_points_and_conditions_are_counted_in_the_order_of_the_metamodel(tmp_path):
    """Contents before conditions, and the software before the stimuli: the importer counts objects when it reaches them."""
    model = exported(CONDITIONED, tmp_path)
    constants = {each["name"]: each["conjunctions"][0]["expressions"][0]["constant"] for each in model["globalConditions"]}
    assert constants == {"Condition_1": 1, "Condition_2": 2, "Condition_3": 3, "Condition_4": 4}
    (function,) = model["systems"][0]["components"][0]["functions"]
    assert outline(function["callGraph"]["graphEntries"]) == [
        ("CallSequence_0", ["Tick_0"]),
        # The first sequence of a loop has no name.
        ("Switch_1", [("WhileLoop", [(None, ["SchedulePoint_0"])])]),
    ]


#: Groups within groups, of which one may not be interrupted, and one is empty.
GROUPS = """\
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Group" name="A" interruptible="false">
        <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="1"/></items>
        <items xsi:type="am:Group" name="B">
          <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="2"/></items>
        </items>
      </items>
      <items xsi:type="am:Group" name="C"/>
      <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="3"/></items>
      <items xsi:type="am:Group" name="D">
        <items xsi:type="am:Group" name="E">
          <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="4"/></items>
        </items>
      </items>
      <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="5"/></items>
    </activityGraph>
  </runnables>
</swModel>
"""


def test_groups_within_groups_are_sequences_beside_them(tmp_path):
    """A sequence is begun after each group; of those without an entry, the ones at the end of a group stay."""
    (function,) = exported(GROUPS, tmp_path)["systems"][0]["components"][0]["functions"]
    assert outline(function["callGraph"]["graphEntries"]) == [
        ("A", ["ImplicitSuspend_A", "Tick_0"]),
        ("B", ["Tick_1"]),
        ("CallSequence_1", ["ImplicitResume_A"]),
        ("C", []),
        ("CallSequence_3", ["Tick_2"]),
        ("D", []),
        ("E", ["Tick_3"]),
        ("CallSequence_4", []),
        ("CallSequence_5", ["Tick_4"]),
    ]
    first, second = (open_system(tmp_path / name).system.runnables["R"] for name in ("model.amxmi", "project.iprx"))
    assert first.activities == second.activities
