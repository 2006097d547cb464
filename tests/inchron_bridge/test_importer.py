"""Projects against those that INCHRON's importer makes of the same AMALTHEA models, fact by fact."""

import json
import re

import pytest
from iprx_facts import VECTORS, differences, facts_of
from support import ROOT, model_text

from amalthea_uros.services.export import export

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


#: A runnable with a condition and a schedule point.
CONDITIONED = """\
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="5"/></items>
      <items xsi:type="am:SchedulePoint"/>
      <items xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="7"/></items>
    </activityGraph>
    <executionCondition>
      <entries xsi:type="am:ModeValueCondition" label="L?type=ModeLabel" relation="EQUAL" value="3"/>
    </executionCondition>
  </runnables>
  <modes xsi:type="am:NumericMode" name="M"/>
  <modeLabels name="L" mode="M?type=NumericMode" initialValue="0"/>
</swModel>
"""


def test_points_are_counted_with_the_conditions_of_the_model(tmp_path):
    (tmp_path / "model.amxmi").write_text(model_text(CONDITIONED))
    model = facts_of(export(tmp_path / "model.amxmi", tmp_path / "project.iprx").text)
    ((condition,), (conjunction,)) = model["globalConditions"], model["globalConditions"][0]["conjunctions"]
    assert condition["name"] == "Condition_0"
    assert [(each["value"], each["constant"]) for each in conjunction["expressions"]] == [("L", 3)]
    (function,) = model["systems"][0]["components"][0]["functions"]
    (sequence,) = function["callGraph"]["graphEntries"]
    assert [call["name"] for call in sequence["calls"]] == ["Tick_0", "SchedulePoint_1", "Tick_1"]
