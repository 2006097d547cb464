"""Schedulers, scheduling parameters and conditions of 2.0.0."""

import pytest
from inline_models import text_property
from migration import migrated

from amalthea_uros.xmi.tree.node import all_below
from amalthea_uros.xmi.tree.notes import NoteKind

FLAGS = 'requiresParentScheduler="false" passesParametersUpwards="false" hasExactlyOneChild="false"'
PRIORITY = '<schedulingParameterDefinitions name="priority" type="Integer" many="false" mandatory="true"/>'
GROUP = '<schedulingParameterDefinitions name="taskGroup" type="Integer" many="false" mandatory="true"/>'
FPP = f"""<schedulerDefinitions name="FixedPriorityPreemptive" processParameters="priority?type=SchedulingParameterDefinition"
  {FLAGS}/>"""
OSEK = f"""<schedulerDefinitions name="OSEK" {FLAGS}
  processParameters="priority?type=SchedulingParameterDefinition taskGroup?type=SchedulingParameterDefinition"/>"""


def parameter(key, value):
    name = key.replace(": ", "%3A+").replace(" ", "+")
    return f'<schedulingParameters key="{name}?type=SchedulingParameterDefinition"><value {value}/></schedulingParameters>'


def integer(key, number):
    return parameter(key, f't="IntegerObject" value="{number}"')


def old_os(*algorithms):
    schedulers = [
        f'<taskSchedulers name="S{number}"><schedulingAlgorithm t="{algorithm}"/></taskSchedulers>'
        for number, algorithm in enumerate(algorithms)
    ]
    return f'<osModel><operatingSystems name="OS">{"".join(schedulers)}</operatingSystems></osModel>'


def new_os(definitions, *algorithms):
    schedulers = [
        f'<taskSchedulers name="S{number}" definition="{algorithm}?type=SchedulerDefinition"/>'
        for number, algorithm in enumerate(algorithms)
    ]
    return f'<osModel><operatingSystems name="OS">{"".join(schedulers)}</operatingSystems>{definitions}</osModel>'


def allocated(*allocations):
    """Allocations of the tasks T 0, T 1 ... to the scheduler S0."""
    found = [
        f'<taskAllocation task="T+{number}?type=Task" scheduler="S0?type=TaskScheduler">{content}</taskAllocation>'
        for number, content in enumerate(allocations)
    ]
    return f"<mappingModel>{''.join(found)}</mappingModel>"


def tasks(*contents):
    return "<swModel>" + "".join(f'<tasks name="T {n}">{content}</tasks>' for n, content in enumerate(contents)) + "</swModel>"


@pytest.mark.parametrize(
    "algorithm",
    [
        *("EarliestDeadlineFirst", "RateMonotonic", "DeadlineMonotonic", "LeastLocalRemainingExecutionTimeFirst", "Grouping"),
        *("PriorityBasedRoundRobin", "SporadicServer", "PollingPeriodicServer", "ConstantBandwidthServerWithCASH"),
    ],
)
def test_other_algorithms_are_definitions_of_the_same_name(models, algorithm):
    after = new_os(f'<schedulerDefinitions name="{algorithm}"/>', algorithm, algorithm)
    assert models.migrate("1.2.0", "2.0.0", old_os(algorithm, algorithm)) == models.read("2.0.0", after)
    assert models.messages(NoteKind.LOST) == []


@pytest.mark.parametrize("algorithm", ["PfairPD2", "PartlyPFairPD2", "EarlyReleaseFairPD2", "PartlyEarlyReleaseFairPD2"])
@pytest.mark.parametrize(
    ("attribute", "content"), [('quantSizeNs="500"', ""), ("", '<parameterExtensions key="quantSizeNs" value="500"/>')]
)
def test_the_quantum_is_a_parameter_of_the_algorithm(models, algorithm, attribute, content):
    before = f"""<osModel><operatingSystems name="OS"><taskSchedulers name="S">
      <schedulingAlgorithm t="{algorithm}" {attribute}>{content}</schedulingAlgorithm>
      </taskSchedulers></operatingSystems></osModel>"""
    after = f"""<osModel><operatingSystems name="OS"><taskSchedulers name="S" definition="{algorithm}?type=SchedulerDefinition">
      {parameter("quantSize", 't="Time" value="500" unit="ns"')}</taskSchedulers></operatingSystems>
      <schedulerDefinitions name="{algorithm}" algorithmParameters="quantSize?type=SchedulingParameterDefinition"/>
      <schedulingParameterDefinitions name="quantSize" type="Time" many="false" mandatory="false"/></osModel>"""
    assert models.migrate("1.2.0", "2.0.0", before) == models.read("2.0.0", after)


def test_numbers_of_algorithms_of_the_user_are_new_and_in_order(models):
    user = "UserSpecificSchedulingAlgorithm"
    present = f'<schedulerDefinitions name="{user}3"/>'
    before = old_os(*[user] * 11).replace("</osModel>", f"{present}</osModel>")
    numbers = [number for number in range(1, 13) if number != 3]
    made = "".join(f'<schedulerDefinitions name="{user}{number}"/>' for number in numbers)
    after = new_os(present + made, *(f"{user}{number}" for number in numbers))
    assert models.migrate("1.2.0", "2.0.0", before) == models.read("2.0.0", after)


def test_a_quantum_that_is_stated_twice_stays_twice(models):
    before = """<osModel><operatingSystems name="OS"><taskSchedulers name="S0"><schedulingAlgorithm t="PfairPD2"
      quantSizeNs="5"><parameterExtensions key="quantSizeNs" value="6"/></schedulingAlgorithm></taskSchedulers>
      </operatingSystems></osModel>"""
    text = "\n".join(models.migrate("1.2.0", "2.0.0", before))
    assert text.index("value [Time] unit='ns' value='5'") < text.index("value [StringObject] value='6'")


def test_a_newer_file_of_the_set_takes_the_definitions(models):
    mapping = models.files("mapping", "1.2.0", tasks("") + allocated('<schedulingParameters priority="4"/>'))
    (os,) = models.files("os", "2.1.0", "<osModel/>")
    found = migrated([*mapping, os.rename(os.with_name("os.amxmi"))], "2.1.0")[0]
    assert [
        (tree.path.name, node.name)
        for tree in found.trees
        for node in tree.root.find("osModel", "schedulingParameterDefinitions")
    ] == [("os.amxmi", "priority")]


def test_a_priority_whose_definition_is_in_no_file_is_stated(models):
    content = tasks(text_property("priority", "7")) + new_os("", "X") + allocated(integer("priority", 4))
    assert models.migrate("1.2.0", "2.0.0", content) == models.read("2.0.0", content)


@pytest.mark.parametrize("version", ["1.2.0", "2.0.0"])
def test_what_is_converted_stays(models, version):
    content = tasks("") + new_os(FPP + PRIORITY, "FixedPriorityPreemptive") + allocated(integer("priority", 0))
    assert models.migrate(version, "2.1.0", content) == models.read("2.1.0", content)


def test_priorities_in_custom_properties_become_parameters(models):
    before = tasks(
        text_property("priority", "0"),
        text_property("priority", "5"),
        text_property("priority", "6"),
        text_property("priority", "high"),
    )
    before += old_os("FixedPriorityPreemptive")
    before += allocated("", '<schedulingParameters priority="5"/>', '<schedulingParameters priority="9"/>', "")
    after = tasks("", "", text_property("priority", "6"), text_property("priority", "high"))
    after += new_os(FPP + PRIORITY, "FixedPriorityPreemptive")
    after += allocated(integer("priority", 0), integer("priority", 5), integer("priority", 9), "")
    assert models.migrate("1.2.0", "2.0.0", before) == models.read("2.0.0", after)
    # Once more: nothing is left to do.
    assert models.migrate("1.2.0", "2.0.0", after) == models.read("2.0.0", after)


def test_task_groups_of_osek(models):
    before = (
        tasks(text_property("osekTaskGroup", "2"), "") + old_os("OSEK") + allocated("", '<schedulingParameters priority="1"/>')
    )
    after = tasks("", "") + new_os(OSEK + PRIORITY + GROUP, "OSEK")
    after += allocated(integer("taskGroup", 2), integer("priority", 1) + integer("taskGroup", 0))
    assert models.migrate("1.2.0", "2.0.0", before) == models.read("2.0.0", after)
    assert len(models.messages(NoteKind.DEFAULTED)) == 1


def test_damaged_content_does_not_raise(models):
    scheduler = """<taskSchedulers name="S0"><schedulingAlgorithm><parameterExtensions/></schedulingAlgorithm>
        <schedulingAlgorithm t="OSEK"/><schedulingAlgorithm t="OSEK"/><parentAssociation/></taskSchedulers>
      <taskSchedulers><schedulingAlgorithm t="PfairPD2" quantSizeNs="short" other="1"/></taskSchedulers>"""
    mapping = """<mappingModel><taskAllocation/><isrAllocation/><taskAllocation task="X?type=Task" scheduler="Y?type=TaskScheduler">
      <schedulingParameters/><schedulingParameters priority="high" weight="3"><other/></schedulingParameters>
      <parameterExtensions/></taskAllocation><isrAllocation isr="X?type=ISR"/></mappingModel>"""
    os = f'<osModel><operatingSystems name="OS">{scheduler}</operatingSystems></osModel>'
    models.migrate("1.2.0", "2.0.0", os + mapping)
    assert sorted(models.messages(NoteKind.LOST)) == [
        "scheduling algorithm without a class",
        "second scheduling algorithm",
        "unknown scheduling parameter",
        "unknown scheduling parameter",
        "unknown scheduling parameter",
    ]
    assert models.messages(NoteKind.KEPT) == ["size of the quantum is not a number"]


def test_comments_stay_with_the_scheduler_and_the_allocation(models):
    pfair = """<!--1--><schedulingAlgorithm t="PfairPD2"><!--2--><parameterExtensions key="quantSizeNs" value="5"/>
      <!--3--><parameterExtensions key="k" value="v"/></schedulingAlgorithm>"""
    os = f'<osModel><operatingSystems name="OS"><taskSchedulers name="S0">{pfair}</taskSchedulers></operatingSystems></osModel>'
    mapping = allocated(
        '<!--4--><schedulingParameters priority="1"><!--5--><minBudget value="1" unit="ms"/></schedulingParameters>'
    )
    roots = migrated(models.files("before", "1.2.0", os + mapping), "2.0.0")[0].roots
    commented = [(node.tag, node.comments) for node in all_below(roots) if node.comments]
    assert commented == [
        ("taskSchedulers", ["<!--1-->", "<!--2-->"]),
        ("schedulingParameters", ["<!--3-->"]),
        ("taskAllocation", ["<!--4-->"]),
        ("value", ["<!--5-->"]),
    ]
