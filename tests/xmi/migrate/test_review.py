"""Content whose meaning a chain of steps has to keep, beyond what single steps show."""

import itea
import pytest
from inline_models import of_kind, written
from migration import migrated

import amalthea_uros as amuros
from amalthea_uros.perf.activities import Execute
from amalthea_uros.xmi.tree.notes import NoteKind

# Clocks


def clocks_of(tmp_path, target, clocks):
    paths = written(tmp_path, "0.9.4", f"<stimuliModel>{clocks}</stimuliModel>")
    models, notes = migrated(paths, target)
    return models.parts("stimuliModel", "clocks"), notes


SINE = """<clocks t="ClockSinusFunction" name="c" amplitude="2.0" yOffset="1.5"><period value="1" unit="s"/>
    <shift value="5" unit="ms"/></clocks>"""
TRIANGLE = '<clocks t="ClockTriangleFunction" name="c" max="3.0" min="0.5"><period value="1" unit="s"/></clocks>'


@pytest.mark.parametrize(
    ("clock", "expected"),
    [
        (SINE, {"period": "1", "xOffset": "5", "peakToPeak": "4.0", "yOffset": "1.5"}),
        (TRIANGLE, {"period": "1", "peakToPeak": "2.5", "yOffset": "0.5"}),
        (SINE.replace('"2.0"', '"?"'), {"period": "1", "xOffset": "5", "yOffset": "1.5"}),
        ('<clocks t="ClockSinusFunction" name="c"/>', {}),
    ],
)
def test_the_curve_of_a_clock_is_stated_beyond_the_published_conversions(tmp_path, clock, expected):
    [found], notes = clocks_of(tmp_path, "3.3.0", clock)
    parts = [part for part in found.children if part.tag != "customProperties"]
    assert {part.tag: part.get("value") for part in parts} == expected
    assert {part.get("unit") for part in parts if part.tag in ("peakToPeak", "yOffset")} <= {""}
    assert len(of_kind(notes, NoteKind.TO_CHECK)) == bool(expected)


# Execution times

NEED = """<runnableItems t="ExecutionNeed">{default}<extended key="P?type=ProcessingUnitDefinition">
    <value key="Instructions">{value}</value></extended></runnableItems>"""
GAUSS = """<value t="NeedDeviation"><deviation><distribution t="GaussDistribution">
    <mean t="LongObject" value="100"/><sd t="LongObject" value="{}"/></distribution></deviation></value>"""
CORES = """<hwModel>{definitions}<featureCategories name="Instructions"><features name="IPC" value="2.0"/></featureCategories>
    </hwModel>"""
DEFINITION = '<definitions t="ProcessingUnitDefinition" name="{}" features="Instructions/IPC?type=HwFeature"/>'


@pytest.mark.parametrize(
    ("target", "expected"),
    [("3.3.0", ["5.0", "10.0"]), ("0.9.5", ["10", "20"])],
)
def test_the_standard_deviation_is_divided_like_the_mean(tmp_path, target, expected):
    default = f'<default key="Instructions">{GAUSS.format(20)}</default>'
    need = NEED.format(default=default, value=GAUSS.format(10))
    hardware = CORES.format(definitions=DEFINITION.format("P") + DEFINITION.format("Q"))
    content = f'<swModel><runnables name="R">{need}</runnables></swModel>{hardware}'
    models, notes = migrated(written(tmp_path, "0.9.2", content), target)
    values = [node for tree in models.trees for node in tree.root.walk() if node.tag == "value" and "sd" in node.attributes]
    assert [node.get("sd") for node in values] == expected
    assert {node.get("mean") for node in values} == {"50"}
    assert of_kind(notes, NoteKind.LOST) == []


UNEVEN = """<value t="NeedDeviation"><deviation><lowerBound t="LongObject" value="1"/>
    <upperBound t="LongObject" value="5"/><distribution t="GaussDistribution">
    <mean t="LongObject" value="3"/></distribution></deviation></value>"""


@pytest.mark.parametrize(
    ("target", "expected"),
    [("3.3.0", ["1", "0 3 1.5"]), ("0.9.5", ["0", "0 2 1"])],
)
def test_ticks_are_never_less_than_the_instructions_take(tmp_path, target, expected):
    """Otherwise runnables of one instruction each would take no time on a core that executes two per cycle."""
    needs = [NEED.format(default="", value=value) for value in ('<value t="NeedConstant" value="1"/>', UNEVEN)]
    hardware = CORES.format(definitions=DEFINITION.format("P"))
    content = f'<swModel><runnables name="R">{"".join(needs)}</runnables></swModel>{hardware}'
    models, notes = migrated(written(tmp_path, "0.9.2", content), target)
    values = [node for tree in models.trees for node in tree.root.walk() if node.type.startswith("DiscreteValue")]
    names = ("value", "lowerBound", "upperBound", "mean")
    assert [" ".join(node.get(name) for name in names if node.get(name)) for node in values] == expected
    assert any("upperBound 2 -> 3" in detail for _, detail in of_kind(notes, NoteKind.CONVERTED)) == (expected[0] == "1")


@pytest.mark.parametrize("target", ["0.9.5", "3.3.0"])
def test_an_upper_bound_that_is_not_stated_is_left_open(tmp_path, target):
    """Execution times of 0 would be a result, where the older model has a gap."""
    uniform = """<value t="NeedDeviation"><deviation><lowerBound t="LongObject" value="6"/>
        <distribution t="UniformDistribution"/></deviation></value>"""
    default = f'<default key="Instructions">{uniform}</default>'
    need = NEED.format(default=default, value=uniform)
    hardware = CORES.format(definitions=DEFINITION.format("P") + DEFINITION.format("Q"))
    rate = """<stimuliModel><stimuli t="VariableRateStimulus" name="V"><occurrencesPerStep>
        <distribution t="UniformDistribution"/></occurrencesPerStep></stimuli></stimuliModel>"""
    content = f'<swModel><runnables name="R">{need}</runnables></swModel>{hardware}{rate}'
    models, notes = migrated(written(tmp_path, "0.9.2", content), target)
    found = [node for tree in models.trees for node in tree.root.walk() if "lowerBound" in node.attributes]
    assert [(node.get("lowerBound"), node.get("upperBound")) for node in found] == [
        ("6", ""),
        *[("3", "")] * 2,
        ("0.0", ""),
    ]
    assert len(of_kind(notes, NoteKind.TO_CHECK)) == 3


def test_execution_times_without_upper_bound_are_no_execution_times(tmp_path):
    deviation = '<value t="NeedDeviation"><deviation><distribution t="UniformDistribution"/></deviation></value>'
    need = f'<runnableItems t="ExecutionNeed"><default key="Instructions">{deviation}</default></runnableItems>'
    model = amuros.migrate(written(tmp_path, "0.9.2", f'<swModel><runnables name="R">{need}</runnables></swModel>')).model
    extraction = amuros.extract(model)
    assert not states_demand(extraction.system)
    assert any("upperBound" in finding.message for finding in extraction.findings)


def states_demand(system):
    """Whether something in the runnables of a system has a known demand."""
    return any(isinstance(item, Execute) for runnable in system.software.runnables for item in runnable.activities)


def test_a_jitter_without_bounds_is_unknown_and_not_none(tmp_path):
    jitter = '<jitter><distribution t="WeibullParameters" kappa="1.0" lambda="2.0"/></jitter>'
    stimulus = '<stimuli t="PeriodicStimulus" name="P"><recurrence value="10" unit="ms"/>{}</stimuli>'
    kinds = []
    for content in (stimulus.format(jitter), stimulus.format("")):
        model = amuros.migrate(written(tmp_path, "0.9.2", f"<stimuliModel>{content}</stimuliModel>")).model
        kinds += [type(found).__name__ for found in amuros.extract(model).system.stimuli.stimuli]
    assert kinds == ["Custom", "Periodic"]


# References


def test_a_position_in_a_file_that_is_not_here_stays_one(tmp_path):
    """Once the result of a migration is migrated again, it must not mean what is at that position in the file itself."""
    content = """<swModel><labels name="own"/><runnables name="R"><callGraph><items t="LabelAccess">
        <data href="{}gone.amxmi#//@swModel/@labels.0"/></items></callGraph></runnables></swModel>"""
    for prefix in ("", "amlt:/#"):
        models, _ = migrated(written(tmp_path, "0.9.5", content.format(prefix)), "3.3.0")
        [access] = models.parts("swModel", "runnables", "activityGraph", "items")
        assert access.target("data").get("path") == "gone.amxmi#//@swModel/@labels.0"


# Allocations

ISR = """<swModel><isrs xmi:id="_i" name="I"/><isrs xmi:id="_j" name="J"/></swModel>
    <hwModel><system name="S"><ecus name="E"><microcontrollers name="M"><cores xmi:id="_c" name="C"/><cores xmi:id="_d" name="D"/>
    </microcontrollers></ecus></system></hwModel>
    <osModel><scheduler xmi:id="_s" name="X"/><scheduler xmi:id="_u" name="Y"/></osModel>
    <mappingModel><coreAllocation scheduler="_s" core="_c"/><coreAllocation scheduler="_u" core="_d"/>
    <executableAllocation xsi:type="mapping:ProcessAllocation" process="_i" scheduler="_s"/>
    <executableAllocation xsi:type="mapping:ProcessAllocation" process="_j" scheduler="_s"/></mappingModel>"""


@pytest.mark.parametrize("target", ["3.3.0", "0.7.0"])
def test_isrs_without_interrupt_controllers_stay_on_their_cores(tmp_path, target):
    models, _ = migrated(itea.write(tmp_path, "1.1.0", m__amxmi=ISR), target)
    allocations = models.parts("mappingModel", "schedulerAllocation") or models.parts("mappingModel", "coreAllocation")
    cores = "core" if target == "0.7.0" else "responsibility"
    found = [(node.target("scheduler").name, node.target(cores).name) for node in allocations]
    expected = [("X", "C"), ("interruptController1_migration_generated", "C"), ("Y", "D")]
    assert found == (expected if target == "3.3.0" else [expected[0], expected[2]])


# Constraints


@pytest.mark.parametrize(("version", "tag"), [("0.7.1", "labels"), ("0.8.0", "group")])
def test_the_labels_of_a_pairing_constraint_can_be_read(tmp_path, version, tag):
    content = f"""<swModel><labels name="L"/></swModel><constraintsModel>
        <affinityConstraints t="DataPairingConstraint"><{tag} labels="L?type=Label"/></affinityConstraints>
        </constraintsModel>"""
    model = amuros.migrate(written(tmp_path, version, content)).model
    [constraint] = model.all(amuros.am.DataPairingConstraint)
    assert [label.name for label in constraint.group.labels] == ["L"]
    assert model.findings == ()
