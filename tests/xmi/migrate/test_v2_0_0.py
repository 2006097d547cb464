"""Schedulers, scheduling parameters and conditions of 2.0.0."""

import pytest
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


def property_(key, text):
    return f'<customProperties key="{key}"><value t="StringObject" value="{text}"/></customProperties>'


def parameter(key, value):
    name = key.replace(": ", "%3A+").replace(" ", "+")
    return f'<schedulingParameters key="{name}?type=SchedulingParameterDefinition"><value {value}/></schedulingParameters>'


def integer(key, number):
    return parameter(key, f't="IntegerObject" value="{number}"')


def string(key, text):
    return parameter(key, f't="StringObject" value="{text}"')


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


def test_known_algorithms_have_parameters(models):
    cycle = f"""<schedulerDefinitions name="StaticCyclic" {FLAGS}
      processParameters="cycleOrder?type=SchedulingParameterDefinition"/>"""
    order = '<schedulingParameterDefinitions name="cycleOrder" type="Integer" many="false" mandatory="true"/>'
    after = new_os(OSEK + cycle + order + PRIORITY + GROUP, "StaticCyclic", "OSEK")
    assert models.migrate("1.2.0", "2.0.0", old_os("StaticCyclic", "OSEK")) == models.read("2.0.0", after)


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


def test_algorithms_of_the_user_have_definitions_of_their_own(models):
    scheduler = """<taskSchedulers name="{0}"><schedulingAlgorithm t="UserSpecificSchedulingAlgorithm">{1}
      </schedulingAlgorithm></taskSchedulers>"""
    extension = '<parameterExtensions key="{}" value="v"/>'
    before = scheduler.format("A", extension.format("b c")) + scheduler.format("B", "")
    before += scheduler.format("C", extension.format("B") + property_("k", "w"))
    key = "extended%3A+{}?type=SchedulingParameterDefinition"
    after = f"""<operatingSystems name="OS">
      <taskSchedulers name="A" definition="UserSpecificSchedulingAlgorithm1?type=SchedulerDefinition">
        {string("extended: b c", "v")}</taskSchedulers>
      <taskSchedulers name="B" definition="UserSpecificSchedulingAlgorithm2?type=SchedulerDefinition"/>
      <taskSchedulers name="C" definition="UserSpecificSchedulingAlgorithm3?type=SchedulerDefinition">
        {property_("k", "w")}{string("extended: B", "v")}</taskSchedulers></operatingSystems>
      <schedulerDefinitions name="UserSpecificSchedulingAlgorithm1" algorithmParameters="{key.format("b+c")}"/>
      <schedulerDefinitions name="UserSpecificSchedulingAlgorithm2"/>
      <schedulerDefinitions name="UserSpecificSchedulingAlgorithm3" algorithmParameters="{key.format("B")}"/>
      <schedulingParameterDefinitions name="extended: B" type="String" many="false" mandatory="false"/>
      <schedulingParameterDefinitions name="extended: b c" type="String" many="false" mandatory="false"/>"""
    given = f'<osModel><operatingSystems name="OS">{before}</operatingSystems></osModel>'
    assert models.migrate("1.2.0", "2.0.0", given) == models.read("2.0.0", f"<osModel>{after}</osModel>")


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
    content = tasks(property_("priority", "7")) + new_os("", "X") + allocated(integer("priority", 4))
    assert models.migrate("1.2.0", "2.0.0", content) == models.read("2.0.0", content)


def test_one_set_of_definitions_for_several_files(models):
    mapping = allocated('<schedulingParameters priority="4"/><parameterExtensions key="k" value="v"/>')
    key = '<key href="amlt:/#{}?type=SchedulingParameterDefinition"/>'
    after = f"""<mappingModel><taskAllocation>
      <task href="amlt:/#T+0?type=Task"/><scheduler href="amlt:/#S0?type=TaskScheduler"/>
      <schedulingParameters>{key.format("priority")}<value t="IntegerObject" value="4"/></schedulingParameters>
      <schedulingParameters>{key.format("extended%3A+k")}<value t="StringObject" value="v"/></schedulingParameters>
      </taskAllocation></mappingModel>"""
    extended = '<schedulingParameterDefinitions name="extended: k" type="String" many="false" mandatory="false"/>'
    os = new_os(FPP + PRIORITY + extended, "FixedPriorityPreemptive")
    found = models.migrate("1.2.0", "2.0.0", mapping, tasks(""), old_os("FixedPriorityPreemptive"))
    assert found == models.read("2.0.0", after, tasks(""), os)


def test_definitions_that_are_there_are_used(models):
    present = new_os(FPP.replace("name=", 'description="mine" name=') + PRIORITY, "FixedPriorityPreemptive")
    scheduler, end = '<taskSchedulers name="S1"{}</taskSchedulers>', "</operatingSystems>"
    old, new = (
        '><schedulingAlgorithm t="FixedPriorityPreemptive"/>',
        ' definition="FixedPriorityPreemptive?type=SchedulerDefinition">',
    )
    before, after = (present.replace(end, scheduler.format(form) + end) for form in (old, new))
    # A snapshot of 2.0.0, and of the version after it.
    for version in ("2.0.0", "2.1.0"):
        assert models.migrate(version, "3.0.0", before) == models.read("3.0.0", after)


@pytest.mark.parametrize("version", ["1.2.0", "2.0.0"])
def test_what_is_converted_stays(models, version):
    content = tasks("") + new_os(FPP + PRIORITY, "FixedPriorityPreemptive") + allocated(integer("priority", 0))
    assert models.migrate(version, "2.1.0", content) == models.read("2.1.0", content)


def test_priorities_in_custom_properties_become_parameters(models):
    before = tasks(
        property_("priority", "0"), property_("priority", "5"), property_("priority", "6"), property_("priority", "high")
    )
    before += old_os("FixedPriorityPreemptive")
    before += allocated("", '<schedulingParameters priority="5"/>', '<schedulingParameters priority="9"/>', "")
    after = tasks("", "", property_("priority", "6"), property_("priority", "high"))
    after += new_os(FPP + PRIORITY, "FixedPriorityPreemptive")
    after += allocated(integer("priority", 0), integer("priority", 5), integer("priority", 9), "")
    assert models.migrate("1.2.0", "2.0.0", before) == models.read("2.0.0", after)
    # Once more: nothing is left to do.
    assert models.migrate("1.2.0", "2.0.0", after) == models.read("2.0.0", after)


def test_task_groups_of_osek(models):
    before = tasks(property_("osekTaskGroup", "2"), "") + old_os("OSEK") + allocated("", '<schedulingParameters priority="1"/>')
    after = tasks("", "") + new_os(OSEK + PRIORITY + GROUP, "OSEK")
    after += allocated(integer("taskGroup", 2), integer("priority", 1) + integer("taskGroup", 0))
    assert models.migrate("1.2.0", "2.0.0", before) == models.read("2.0.0", after)
    assert len(models.messages(NoteKind.DEFAULTED)) == 1


def test_without_any_task_group_none_is_invented(models):
    before = tasks("") + old_os("OSEK") + allocated("")
    assert models.migrate("1.2.0", "2.0.0", before) == models.read(
        "2.0.0", tasks("") + new_os(OSEK + PRIORITY + GROUP, "OSEK") + allocated("")
    )
    assert models.messages(NoteKind.DEFAULTED) == []


def test_task_groups_below_a_grouping(models):
    text = """<osModel><operatingSystems name="OS"><taskSchedulers name="S0"{}<parentAssociation parent="P?type=TaskScheduler"/>
      </taskSchedulers><taskSchedulers name="P"{}</taskSchedulers></operatingSystems>{}</osModel>"""
    old = [f'><schedulingAlgorithm t="{algorithm}"/>' for algorithm in ("Grouping", "OSEK")]
    new = [f' definition="{algorithm}?type=SchedulerDefinition">' for algorithm in ("Grouping", "OSEK")]
    before = tasks(property_("osekTaskGroup", "2")) + text.format(*old, "") + allocated("")
    definitions = '<schedulerDefinitions name="Grouping"/>' + OSEK + PRIORITY + GROUP
    after = tasks("") + text.format(*new, definitions) + allocated(integer("taskGroup", 2))
    assert models.migrate("1.2.0", "2.0.0", before) == models.read("2.0.0", after)


def test_schedulers_in_a_circle_end(models):
    scheduler = """<taskSchedulers name="S0"><schedulingAlgorithm t="Grouping"/>
      <parentAssociation parent="S0?type=TaskScheduler"/></taskSchedulers>"""
    os = f'<osModel><operatingSystems name="OS">{scheduler}</operatingSystems></osModel>'
    models.migrate("1.2.0", "2.0.0", tasks(property_("osekTaskGroup", "1")) + os + allocated(""))
    assert models.messages(NoteKind.LOST) == []


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
