"""A model has one answer, in whatever version or form it is written: what nobody stated is not a number after writing it either."""

import json
from pathlib import Path

import pytest
from effort import every
from migration import model
from support import SHARED

from amalthea_uros import analyze_files, build, save
from amalthea_uros.report.writers.json import content
from amalthea_uros.services.format import format_files
from amalthea_uros.services.migrate import migrate_files
from amalthea_uros.services.simulate import simulate_files
from amalthea_uros.simulate.options import Options
from amalthea_uros.units import MILLISECOND, Duration
from amalthea_uros.xmi.emf.versions import is_older

CORPUS = SHARED / "corpus"
VERDICTS = SHARED / "vectors" / "verdicts"

#: Where something is, and what says that a file was migrated, or how references were spelled in it.
PLACES = {"location", "model", "findings"}
OF_FILES = {"XMI008", "XMI009", "XMI020", "XMI021", "XMI025"}


def without_places(found):
    if isinstance(found, dict):
        return {key: without_places(value) for key, value in found.items() if key not in PLACES}
    return [without_places(value) for value in found] if isinstance(found, list) else found


def answer(paths):
    """The system that files describe, everything that is computed of it, and what is said about both."""
    result = analyze_files(paths)
    said = {(finding.rule, finding.message) for finding in result.findings if finding.rule not in OF_FILES}
    return result.system, without_places(content(result)), said


def migrated(path, folder):
    """The files that the migration of a file writes."""
    result = migrate_files([path], target=folder)
    return [file.target for file in result.files]


def published():
    """The older published models; the largest has the constructs of the others."""
    inventory = CORPUS / "inventory.json"
    if not inventory.exists():
        return [pytest.param("", marks=pytest.mark.skip("the published models are not at hand"))]
    entries = json.loads(inventory.read_text())
    return sorted(e["file"] for e in entries if is_older(e["version"]) and e["wellFormed"] and e["size"] < 1_000_000)


@pytest.mark.parametrize("file", every(3, published()))
def test_a_published_model_says_the_same_after_its_migration(file, tmp_path):
    before, after = answer([CORPUS / file]), answer(migrated(CORPUS / file, tmp_path / "migrated"))
    assert after == before


#: Deadlines of tasks, for which there is no feature in 1.2.0; and of the association of a scheduler with its parent.
DEADLINES = """
amuros: 1
name: deadlines
hardware: {platform: single-core, frequency: 1 MHz}
tasks:
  - {name: A, period: 1 ms, execution_time: 300 us, priority: 2}
  - {name: B, period: 10 ms, execution_time: 1 ms, priority: 1, deadline: 2 ms}
"""


@pytest.mark.parametrize("policy", ["FixedPriorityPreemptive", "EarliestDeadlineFirst"])
def test_a_model_says_the_same_in_an_older_version(policy, tmp_path):
    """The deadlines of its tasks are features in 2.0.0 and later, and kept in custom properties before."""
    description, newest = tmp_path / "app.yaml", tmp_path / "newest.amxmi"
    description.write_text(DEADLINES)
    save(build(description).model, newest)
    newest.write_text(newest.read_text().replace("FixedPriorityPreemptive", policy))
    older = tmp_path / "older.amxmi"
    migrate_files([newest], to="1.2.0", target=older)
    _, expected, _ = answer([newest])
    assert [each["deadline_ps"] for each in expected["processes"]] == [1_000_000_000, 2_000_000_000]
    assert answer([older])[1] == expected


@pytest.mark.parametrize(("version", "deadline"), [("1.2.0", 7 * MILLISECOND), ("2.0.0", None)])
def test_only_versions_without_the_feature_have_deadlines_in_properties(version, deadline, tmp_path):
    kept = """<customProperties key="AMALTHEA 2.0.0: schedulingParameters/deadline">
      <value t="Time" value="7" unit="ms"/></customProperties>"""
    content = f"""<swModel><tasks name="A"/></swModel>
      <osModel><operatingSystems name="OS"><taskSchedulers name="T"/></operatingSystems></osModel>
      <mappingModel><taskAllocation task="A?type=Task" scheduler="T?type=TaskScheduler">{kept}</taskAllocation></mappingModel>"""
    path = tmp_path / "model.amxmi"
    path.write_text(model(version, content))
    assert [each.deadline for each in answer([path])[0].mapping.tasks] == [deadline]


def test_the_deadline_of_a_scheduler_below_another_is_kept_in_an_older_version(tmp_path):
    parameter = """<schedulingParameters key="deadline?type=SchedulingParameterDefinition">
      <value t="Time" value="7" unit="ms"/></schedulingParameters>"""
    content = f"""<osModel><operatingSystems name="OS"><taskSchedulers name="P" definition="E?type=SchedulerDefinition"/>
      <taskSchedulers name="T" definition="E?type=SchedulerDefinition">
        <parentAssociation parent="P?type=TaskScheduler">{parameter}</parentAssociation></taskSchedulers></operatingSystems>
      <schedulerDefinitions name="E" processParameters="deadline?type=SchedulingParameterDefinition"/>
      <schedulingParameterDefinitions name="deadline" type="Time"/></osModel>"""
    newest = tmp_path / "newest.amxmi"
    newest.write_text(model("3.3.0", content))
    older = tmp_path / "older.amxmi"
    migrate_files([newest], to="1.2.0", target=older)
    deadlines = [answer([path])[0].schedulers["T"].parent.deadline for path in (newest, older)]
    assert deadlines == [7 * MILLISECOND] * 2


@pytest.mark.parametrize("kind", ["CountingSemaphore", "Resource"])
@pytest.mark.parametrize("kept", ["", "true", "false"])
def test_who_may_release_a_semaphore_is_the_same_before_and_after_a_migration(kind, kept, tmp_path):
    value = f'<value t="BooleanObject" value="{kept}"/>'
    stated = f'<customProperties key="AMALTHEA 3.0.0: ownership">{value}</customProperties>' if kept else ""
    older = tmp_path / "older.amxmi"
    content = f'<osModel><semaphores name="S" semaphoreType="{kind}" maxValue="1">{stated}</semaphores></osModel>'
    older.write_text(model("2.2.0", content))
    newest = tmp_path / "newest.amxmi"
    migrate_files([older], target=newest)
    expected = kept == "true" if kept else kind != "CountingSemaphore"
    assert [answer([path])[0].os.semaphores[0].ownership for path in (older, newest)] == [expected] * 2


PLATFORM = """
<hwModel>
  <definitions t="ProcessingUnitDefinition" name="D" puType="CPU"/>
  <structures name="S"><modules t="ProcessingUnit" name="C" frequencyDomain="F?type=FrequencyDomain"
    definition="D?type=ProcessingUnitDefinition"/></structures>
  <domains t="FrequencyDomain" name="F"><defaultValue value="100.0" unit="MHz"/></domains>
</hwModel>
<osModel><operatingSystems name="OS">
  <taskSchedulers name="TS"><schedulingAlgorithm t="OSEK"/></taskSchedulers>
</operatingSystems></osModel>
<mappingModel>
  <schedulerAllocation scheduler="TS?type=TaskScheduler" responsibility="C?type=ProcessingUnit"/>
  <taskAllocation task="A?type=Task" scheduler="TS?type=TaskScheduler"><schedulingParameters priority="1"/></taskAllocation>
</mappingModel>
"""
EVERY_10_MS = '<stimuli t="PeriodicStimulus" name="P"><recurrence value="10" unit="ms"/></stimuli>'
ONE_MS = '<items t="Ticks"><default t="DiscreteValueConstant" value="100000"/></items>'


def with_item(version, item, stimulus=EVERY_10_MS, more=""):
    """A model with a task that executes something."""
    graph = "callGraph" if version == "0.9.5" else "activityGraph"
    kind = stimulus.split('"')[1]
    task = f'<tasks name="A" stimuli="P?type={kind}" multipleTaskActivationLimit="1"><{graph}>{item}</{graph}></tasks>'
    return model(version, f"<swModel>{task}{more}</swModel>{PLATFORM}<stimuliModel>{stimulus}</stimuliModel>")


#: Values without a number that nothing replaces.
NOT_STATED = [
    '<default t="DiscreteValueConstant"/>',
    '<default t="DiscreteValueBoundaries" lowerBound="0"/>',
    '<default t="DiscreteValueBoundaries" samplingType="Uniform"/>',
    '<default t="DiscreteValueUniformDistribution" lowerBound="100000"/>',
    '<default t="DiscreteValueGaussDistribution"/>',
    '<default t="DiscreteValueGaussDistribution" mean="100000.0" upperBound="200000"/>',
    '<default t="DiscreteValueStatistics" lowerBound="100000" upperBound="200000"/>',
    '<default t="DiscreteValueWeibullEstimatorsDistribution" lowerBound="100000" upperBound="200000"/>',
    '<default t="DiscreteValueBetaDistribution" lowerBound="100000" upperBound="200000"/>',
    '<default t="DiscreteValueHistogram"><entries upperBound="200000" occurrences="1"/></default>',
]


def observed(paths):
    """What a short run shows."""
    simulation = simulate_files(paths, Options(duration=Duration(100 * MILLISECOND))).simulation
    return [(each.name, each.jobs, each.response_time) for each in simulation.processes]


@pytest.mark.parametrize("ticks", NOT_STATED)
def test_a_number_that_is_not_stated_is_none_after_a_migration(ticks, tmp_path):
    path = tmp_path / "old.amxmi"
    path.write_text(with_item("0.9.5", f'<items t="Ticks">{ticks}</items>'))
    written = migrated(path, tmp_path / "migrated")
    assert answer(written) == answer([path])
    assert observed(written) == observed([path])


@pytest.mark.parametrize("ticks", NOT_STATED)
def test_a_number_that_is_not_stated_is_none_in_canonical_form(ticks, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(with_item("1.0.0", f'<items t="Ticks">{ticks}</items>'))
    before = answer([path])
    assert format_files([path]).changed
    assert answer([path]) == before


def test_without_an_upper_bound_the_execution_time_is_unknown(tmp_path):
    path = tmp_path / "old.amxmi"
    path.write_text(with_item("0.9.5", '<items t="Ticks"><default t="DiscreteValueBoundaries" lowerBound="0"/></items>'))
    (process,) = analyze_files(migrated(path, tmp_path / "migrated")).analysis.processes
    assert process.verdict == "unknown"
    assert process.wcet is None


OPEN = [
    # How often a runnable is called, or a part of a curve counts; a limit; how many elements.
    '<stimuli t="ArrivalCurveStimulus" name="P"><entries><lowerTimeBorder value="5" unit="ms"/></entries></stimuli>',
    '<stimuli t="RelativePeriodicStimulus" name="P"><nextOccurrence t="TimeBetaDistribution"><lowerBound value="5" unit="ms"/>'
    '<upperBound value="9" unit="ms"/></nextOccurrence></stimuli>',
]


@pytest.mark.parametrize("stimulus", OPEN)
def test_a_stimulus_of_which_a_number_is_not_stated(stimulus, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(with_item("1.0.0", ONE_MS, stimulus))
    before = answer([path])
    assert format_files([path]).changed
    assert answer([path]) == before


@pytest.mark.parametrize("statistic", ["SingleValueStatistic", "MinAvgMaxStatistic"])
def test_a_number_of_calls_that_is_not_stated_is_once(statistic, tmp_path):
    path = tmp_path / "model.amxmi"
    call = f'<items t="RunnableCall" runnable="R?type=Runnable"><statistic><statistic t="{statistic}"/></statistic></items>'
    runnable = f'<runnables name="R"><activityGraph>{ONE_MS}</activityGraph></runnables>'
    path.write_text(with_item("1.0.0", call, more=runnable))
    before = answer([path])
    assert format_files([path]).changed
    assert answer([path]) == before
    assert analyze_files([path]).analysis.processes["A"].wcet == MILLISECOND


@pytest.mark.skipif(not VERDICTS.exists(), reason="the vectors are not at hand")
def test_the_open_bound_of_the_vector(tmp_path):
    path = Path(VERDICTS / "old-open-bound.amxmi")
    before, after = answer([path]), answer(migrated(path, tmp_path / "migrated"))
    assert after == before
    assert before[1]["summary"]["schedulable"] == "unknown"


DISTANCES = """<stimuli t="RelativePeriodicStimulus" name="P"><nextOccurrence t="TimeGaussDistribution"><lowerBound value="{}"{}/>
    <upperBound value="100" unit="ms"/><mean value="30" unit="ms"/><sd value="5" unit="ms"/></nextOccurrence></stimuli>"""


def test_0_without_unit_is_0_in_any_unit(tmp_path):
    bare, stated, wrong = (tmp_path / f"{name}.amxmi" for name in ("bare", "stated", "wrong"))
    bare.write_text(with_item("1.0.0", ONE_MS, DISTANCES.format(0, "")))
    stated.write_text(with_item("1.0.0", ONE_MS, DISTANCES.format(0, ' unit="ms"')))
    wrong.write_text(with_item("1.0.0", ONE_MS, DISTANCES.format(5, "")))
    assert answer([bare]) == answer([stated])
    assert observed([bare]) == observed([stated]) != []
    assert observed([wrong]) == []
