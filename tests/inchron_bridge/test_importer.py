"""Projects against those that INCHRON's importer makes of the same AMALTHEA models, fact by fact."""

import json
import re
from unittest.mock import ANY

import pytest
from iprx_facts import VECTORS, differences, facts_of
from support import ROOT, model_text

from amalthea_uros.services.export import export
from amalthea_uros.services.subject import open_system

#: The calls of the first sequence of the first task of the models.
OF_FIRST_CALL = (
    "/systems[OS]/rtosConfig/schedulables[IsrScheduler]/schedulables[Sch0]/schedulables[T1]/callGraph"
    "/graphEntries[CallSequence_0]/calls"
)
PAGE = (ROOT / "docs" / "inchron.md").read_text(encoding="utf-8")
#: What the importer leaves out: patterns of facts that only we write, each with the reason.
ADDED = {
    r"/comment$": "a project has no place for it",
    r"/(memories|interconnects)\[\w+\]/clock$": "the metamodel demands a clock",
    r"^/requirements(\[\w+_response_time\])?$": "the importer drops requirements on processes and runnables",
    r"^/eventChains$": "the importer drops chains with events without a type",
    r"/generators\[rounds_of_\w+\]$": "the importer drops the activations of executors",
    r"/graphEntries\[CallSequence_0\]/calls\[ModeAccess\]$": "the importer drops reads of modes",
}
#: Where the importer writes something that the model does not say: by the model, its row of docs/inchron.md, and the facts that differ,
#: each with ours, which is what the model says.
CHANGED: dict[str, tuple[str, dict[str, object]]] = {
    # The first segment ends with the write, the second one begins with the read.
    "10_chain_gap": (
        "a segment that begins with another event than the previous one ends with",
        {
            "/eventChains[EC]/nodes[e_l1_read]/predecessors[EC/e_l1_write]": "EC/e_l1_write",
            "/eventChains[EC]/nodes[e_l1_read]/predecessors[EC/e_r1_start]": None,
            "/eventChains[EC]/nodes[e_l1_write]": ANY,
        },
    ),
    "10_lat_nobounds": ("a latency constraint without an upper limit", {"/requirements[LC]/evaluate": False}),
    "20_ticks_beta": ("a beta distribution", {f"{OF_FIRST_CALL}[Tick_0]/timeDistribution/type": "Beta"}),
    # Between 100 and 200 ticks.
    "20_ticks_bounds_default": ("bounds without a shape", {f"{OF_FIRST_CALL}[Tick_0]/timeDistribution/mean/value": 150}),
    "25_modelabelaccess": ("a counter that is set", {f"{OF_FIRST_CALL}[NumericModeLabelAccess_1]/value": 9}),
    "25_switch_num_lt": (
        "a relation other than equal",
        {"/globalConditions[Condition_0]/conjunctions[0]/expressions[0]/relationalOperator": "lt"},
    ),
    # The importer's project breaks the metamodel, which demands the target.
    "44_unalloc_task_only": (
        "a task without allocation, if nothing else is without an operating system",
        {
            "/systems[__GLOBAL__]": ANY,
            "/scenarios[DefaultScenario]/generators[S10]/targets/graphEntries[CallSequence_0]/calls[ActivateT1]/target": (
                "__GLOBAL__/RtosConfig/IsrScheduler/DefaultScheduler/T1"
            ),
        },
    ),
}
#: Further rows of docs/inchron.md, of which there is no project of the importer.
FURTHER = {
    "a normally distributed distance between activations",
    "a uniformly distributed distance with bounds in different units",
    "a frequency, a period or the length of a burst that is not stated",
    "an inter-process stimulus that nothing triggers",
}
#: What the project keeps also if it is to be like that of the importer: more events, and what the metamodel demands.
KEPT = {"10_chain_gap", "44_unalloc_task_only"}


def vectors():
    found = sorted(VECTORS.glob("*.json"))
    return [pytest.param(path, id=path.stem) for path in found] or [pytest.param(None, marks=pytest.mark.skip("no vectors"))]


def changed_facts(vector, folder, **options):
    """The facts of ours that differ from those of the importer, without what only we write."""
    stored = json.loads(vector.read_text())
    text = export(VECTORS / stored["input"], folder / "project.iprx", **options).text
    return {
        path: ours
        for path, ours, theirs in differences(facts_of(text), stored["model"])
        if theirs is not None or not any(re.search(pattern, path) for pattern in ADDED)
    }


@pytest.mark.parametrize("vector", vectors())
def test_projects_are_those_of_the_importer(vector, tmp_path):
    _, expected = CHANGED.get(vector.stem, ("", {}))
    assert changed_facts(vector, tmp_path) == expected
    if expected:
        assert changed_facts(vector, tmp_path, like_importer=True) == (expected if vector.stem in KEPT else {})


def test_the_page_lists_what_differs():
    table = PAGE.partition("with a few exceptions")[2].partition("\n\n| ")[2].partition("\n\n")[0]
    rows = [row.split(" | ")[0].removeprefix("| ") for row in table.splitlines()[2:]]
    assert sorted(rows) == sorted({row for row, _ in CHANGED.values()} | FURTHER)


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


#: A runnable with a condition, and in it a loop and a switch with conditions of their own; the task of a conditional stimulus.
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
    """A sequence is begun after each group; one without content is replaced by what follows, but stays at the end of a group."""
    (function,) = exported(GROUPS, tmp_path)["systems"][0]["components"][0]["functions"]
    assert outline(function["callGraph"]["graphEntries"]) == [
        ("A", ["ImplicitSuspend_A", "Tick_0"]),
        ("B", ["Tick_1"]),
        ("CallSequence_1", ["ImplicitResume_A"]),
        ("C", []),
        ("CallSequence_3", ["Tick_2"]),
        ("E", ["Tick_3"]),
        ("CallSequence_4", []),
        ("CallSequence_5", ["Tick_4"]),
    ]
    first, second = (open_system(tmp_path / name).system.runnables["R"] for name in ("model.amxmi", "project.iprx"))
    assert first.activities == second.activities


#: Distances of 9 to 11 ms around 10 ms, and of 0.9 to 11 ms.
DISTANCES = """\
<stimuliModel>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="N">
    <nextOccurrence xsi:type="am:TimeGaussDistribution">
      <lowerBound value="9" unit="ms"/><upperBound value="11" unit="ms"/><mean value="10" unit="ms"/><sd value="1" unit="ms"/>
    </nextOccurrence>
  </stimuli>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="U">
    <nextOccurrence xsi:type="am:TimeUniformDistribution">
      <lowerBound value="900" unit="us"/><upperBound value="11" unit="ms"/>
    </nextOccurrence>
  </stimuli>
  <stimuli xsi:type="am:InterProcessStimulus" name="I"/>
</stimuliModel>
"""


def test_distances_are_those_of_the_model(tmp_path):
    normal, uniform, triggered = (
        next(each for each in exported(DISTANCES, tmp_path)["scenarios"][0]["generators"] if each["name"] == name)
        for name in "NUI"
    )
    assert [normal["variation"][end]["value"] for end in ("min", "max")] == [-1, 1]
    assert (uniform["period"]["value"], uniform["variation"]["max"]["value"]) == (900, 10_100)
    assert "targets" not in triggered
    like = facts_of(export(tmp_path / "model.amxmi", tmp_path / "project.iprx", like_importer=True).text)
    (variation,) = (each["variation"] for each in like["scenarios"][0]["generators"] if each["name"] == "N")
    assert [variation[end]["value"] for end in ("min", "max")] == [9, 11]


#: Two processors, one with two cores of which one has a cache, and a memory beside them; a core has a port of 4 B.
HARDWARE = """\
<hwModel>
  <definitions xsi:type="am:CacheDefinition" name="CD"/>
  <domains xsi:type="am:FrequencyDomain" name="FD"><defaultValue value="200.0" unit="MHz"/></domains>
  <structures name="S" structureType="System">
    <structures name="A">
      <modules xsi:type="am:ProcessingUnit" name="A0" frequencyDomain="FD?type=FrequencyDomain">
        <ports name="out" portType="initiator" bitWidth="4"/>
        <caches name="L1" frequencyDomain="FD?type=FrequencyDomain" definition="CD?type=CacheDefinition"/>
      </modules>
      <modules xsi:type="am:ProcessingUnit" name="A1" frequencyDomain="FD?type=FrequencyDomain"/>
    </structures>
    <structures name="B">
      <modules xsi:type="am:ProcessingUnit" name="B0" frequencyDomain="FD?type=FrequencyDomain"/>
    </structures>
    <modules xsi:type="am:Memory" name="M" frequencyDomain="FD?type=FrequencyDomain"/>%s
  </structures>
</hwModel>
"""
HANDLER = """
    <modules xsi:type="am:ConnectionHandler" name="Bus" frequencyDomain="FD?type=FrequencyDomain">
      <ports name="p" portType="responder" portInterface="AXI" bitWidth="32"/>
    </modules>"""


def test_processors_are_connected_as_by_the_importer(tmp_path):
    """A cache stands between its processor and the others; an interconnect is as wide as the first core."""
    model = exported(HARDWARE % "", tmp_path)
    first, second = sorted(model["cpus"], key=lambda cpu: cpu["name"])
    (cache,), (inner,), (other,), (top,) = (
        first["memories"],
        first["interconnects"],
        second["interconnects"],
        model["interconnects"],
    )
    assert (inner["bitWidth"]["value"], inner["bitWidth"]["unit"]) == (4, "B")
    assert (other["bitWidth"]["value"], other["bitWidth"]["unit"]) == (64, "bit")
    assert [port["name"] for port in inner["initiators"]] == ["to_L1"]
    assert (cache["initiator"]["name"], cache["responder"]["name"]) == ("from_A", "to_CpuInterconnect")
    assert cache["initiator"]["responder"] == "Interconnect/to_A"
    assert [(port["name"], port["responder"]) for port in other["initiators"]] == [("from_B", "Interconnect/to_B")]
    assert [(port["name"], port["responder"]) for port in top["initiators"]] == [("to_M", "M/ResponderPort")]


def test_a_bus_outside_of_processors_is_an_interconnect_of_the_model(tmp_path):
    """No others are made then, and a cache has only the ports that are stated."""
    model = exported(HARDWARE % HANDLER, tmp_path)
    assert [(each["name"], each["bitWidth"]["value"]) for each in model["interconnects"]] == [("Bus", 32)]
    assert not any("interconnects" in cpu for cpu in model["cpus"])
    (cache,) = next(cpu["memories"] for cpu in model["cpus"] if "memories" in cpu)
    assert not {"initiator", "responder"} & cache.keys()


#: Two operating systems; the runnable R is used by a task of the second one, and by a runnable of the first one.
SYSTEMS = """\
<swModel>
  <isrs name="I"/>
  <tasks name="T1"><activityGraph><items xsi:type="am:RunnableCall" runnable="Q?type=Runnable"/></activityGraph></tasks>
  <tasks name="T2"><activityGraph><items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/></activityGraph></tasks>
  <runnables name="Q"><activityGraph><items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/></activityGraph></runnables>
  <runnables name="R"><activityGraph/></runnables>
</swModel>
<hwModel>
  <structures name="S">
    <modules xsi:type="am:ProcessingUnit" name="C0"/><modules xsi:type="am:ProcessingUnit" name="C1"/>
  </structures>
</hwModel>
<osModel>
  <operatingSystems name="O1">
    <taskSchedulers name="S1"/><interruptControllers name="IC"/>
  </operatingSystems>
  <operatingSystems name="O2"><taskSchedulers name="S2"/></operatingSystems>
</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S1?type=TaskScheduler" responsibility="C0?type=ProcessingUnit"/>
  <schedulerAllocation scheduler="S2?type=TaskScheduler" responsibility="C0?type=ProcessingUnit"/>
  <schedulerAllocation scheduler="IC?type=InterruptController" responsibility="C1?type=ProcessingUnit"/>
  <taskAllocation task="T1?type=Task" scheduler="S1?type=TaskScheduler"/>
  <taskAllocation task="T2?type=Task" scheduler="S2?type=TaskScheduler"/>
  <isrAllocation isr="I?type=ISR" controller="IC?type=InterruptController"/>
</mappingModel>
"""


def test_direct_users_come_before_indirect_ones_and_controllers_before_schedulers(tmp_path):
    first, second = sorted(exported(SYSTEMS, tmp_path)["systems"], key=lambda system: system["name"])
    functions = [[each["name"] for each in system["components"][0]["functions"]] for system in (first, second)]
    assert functions == [["Q"], ["R"]]
    roots = [system["rtosConfig"]["schedulables"][0]["cpuCores"] for system in (first, second)]
    assert roots == [["S/C1"], ["S/C0"]]
