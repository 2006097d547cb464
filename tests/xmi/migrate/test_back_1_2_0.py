"""2.0.0 -> 1.2.0, and what the step up restores."""

import pytest
from migration import meaning, migrated, opened

from amalthea_uros.xmi.tree.node import all_below
from amalthea_uros.xmi.tree.notes import NoteKind
from amalthea_uros.xmi.tree.results import tree_text

PRIORITY = '<schedulingParameterDefinitions name="priority" type="Integer" many="false" mandatory="true"/>'
OSEK = '<schedulerDefinitions name="OSEK" processParameters="priority?type=SchedulingParameterDefinition"/>'


FLAGS = dict.fromkeys(("requiresParentScheduler", "passesParametersUpwards", "hasExactlyOneChild"), "false")
ALGORITHM = ("osModel", "operatingSystems", "taskSchedulers", "schedulingAlgorithm")


def os_model(schedulers, definitions):
    return f'<osModel><operatingSystems name="OS">{schedulers}</operatingSystems>{definitions}</osModel>'


def scheduler(definition, content="", name="S"):
    return f'<taskSchedulers name="{name}" definition="{definition}?type=SchedulerDefinition">{content}</taskSchedulers>'


def osek(content=""):
    """A scheduler of that policy and its definitions."""
    return os_model(scheduler("OSEK", content), OSEK + PRIORITY)


def definition(name, content="", **attributes):
    stated = "".join(f' {key}="{text}"' for key, text in attributes.items())
    return f'<schedulerDefinitions name="{name}"{stated}>{content}</schedulerDefinitions>'


def parameter_definition(name, kind="Integer", content=""):
    return f'<schedulingParameterDefinitions name="{name}" type="{kind}">{content}</schedulingParameterDefinitions>'


def parameter(name, value):
    return f'<schedulingParameters key="{name}?type=SchedulingParameterDefinition"><value {value}/></schedulingParameters>'


def integer(name, number):
    return parameter(name, f't="IntegerObject" value="{number}"')


def time(name, number, unit="ms"):
    return parameter(name, f't="Time" value="{number}" unit="{unit}"')


def string(name, text):
    return parameter(name, f't="StringObject" value="{text}"')


def allocated(content, properties=""):
    return f"""<swModel><tasks name="T">{properties}</tasks></swModel>
    <mappingModel><taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler">{content}</taskAllocation></mappingModel>"""


def taken_back(models, *contents):
    """The roots in 1.2.0; from there, everything comes back."""
    paths = models.files("newer", "2.0.0", *contents)
    older, models.notes = migrated(paths, "1.2.0")
    assert models.messages(NoteKind.LOST) == []
    between = models.files("older", "1.2.0", *contents)
    for path, tree in zip(between, older.trees, strict=True):
        path.write_text(tree_text(tree), encoding="utf-8")
    assert meaning(older) == meaning(opened(*between))
    back, notes = migrated(between, "2.0.0")
    assert [note for note in notes if note.kind is NoteKind.LOST] == []
    assert meaning(back) == meaning(opened(*paths))
    return older.roots


def changed_and_back(models, content, change):
    """A model that was taken back, changed there, and brought up again."""
    older, _ = migrated(models.files("newer", "2.0.0", content), "1.2.0")
    change(older.roots)
    (path,) = models.files("older", "1.2.0", "")
    path.write_text(tree_text(older.trees[0]), encoding="utf-8")
    return migrated([path], "2.0.0")[0]


def refused(models, *contents):
    migrated_notes = migrated(models.files("newer", "2.0.0", *contents), "1.2.0")[1]
    return [note.message for note in migrated_notes if note.kind is NoteKind.LOST]


def found(roots, *path):
    return [node for root in roots for node in root.find(*path)]


def keys(node):
    return [child.get("key") for child in node.all("customProperties")]


def test_definitions_are_kept_with_all_they_say(models):
    content = f"""<commonElements><tags name="a tag"/></commonElements>{
        os_model(
            scheduler("OSEK"),
            definition(
                "OSEK",
                '<customProperties key="k"><value t="StringObject" value="Q?type=Task"/></customProperties>',
                description="two&#xA;lines",
                tags="a+tag?type=Tag",
                requiresParentScheduler="true",
                passesParametersUpwards="true",
                hasExactlyOneChild="true",
                algorithmParameters="quantum+%2F+x?type=SchedulingParameterDefinition",
                processParameters="priority?type=SchedulingParameterDefinition quantum+%2F+x?type=SchedulingParameterDefinition",
            )
            + definition("of nobody")
            + PRIORITY
            + parameter_definition("quantum / x", "Time", '<defaultValue t="Time" value="3" unit="us"/>'),
        )
    }"""
    (node,) = found(taken_back(models, content), "osModel")
    assert keys(node) == [
        "AMALTHEA 2.0.0: schedulerDefinitions/OSEK",
        "AMALTHEA 2.0.0: schedulerDefinitions/of nobody",
        "AMALTHEA 2.0.0: schedulingParameterDefinitions/priority",
        "AMALTHEA 2.0.0: schedulingParameterDefinitions/quantum / x",
    ]


@pytest.mark.parametrize("name", ["My own", "PriorityBased", "UserSpecificSchedulingAlgorithm3"])
def test_a_definition_that_is_no_class_is_user_specific(models, name):
    schedulers = scheduler(name.replace(" ", "+"), string("extended%3A+min", "5 ms")) + scheduler("OSEK", name="Q")
    content = os_model(schedulers, definition(name) + OSEK + PRIORITY + parameter_definition("extended: min", "String"))
    node, other = found(taken_back(models, content), "osModel", "operatingSystems", "taskSchedulers")
    assert keys(node) == ["AMALTHEA 2.0.0: definition"]
    algorithm = node.child("schedulingAlgorithm")
    assert algorithm.type == "UserSpecificSchedulingAlgorithm"
    assert [child.attributes for child in algorithm.children] == [{"key": "min", "value": "5 ms"}]
    assert other.child("schedulingAlgorithm").type == "OSEK"


def test_interrupt_controllers_have_algorithms_of_their_own(models):
    controllers = """<interruptControllers name="I" definition="PriorityBased?type=SchedulerDefinition"/>
    <interruptControllers name="J" definition="OSEK?type=SchedulerDefinition"/><interruptControllers name="K"/>"""
    content = os_model(controllers, OSEK + definition("PriorityBased") + PRIORITY)
    nodes = found(taken_back(models, content), "osModel", "operatingSystems", "interruptControllers")
    types = [algorithm.type for node in nodes for algorithm in node.all("schedulingAlgorithm")]
    assert types == ["PriorityBased", "UserSpecificSchedulingAlgorithm"]


def test_budgets_are_parts_also_in_an_association(models):
    budgets = time("replenishment", 10) + time("maxBudget", 2) + integer("priority", 3) + integer("weight", 1)
    schedulers = scheduler("OSEK", name="root") + scheduler(
        "DeferrableServer", f'<parentAssociation parent="root?type=TaskScheduler">{budgets}</parentAssociation>'
    )
    names = ("replenishment", "maxBudget", "minBudget", "weight")
    definitions = OSEK + definition("DeferrableServer") + PRIORITY + "".join(parameter_definition(n, "Time") for n in names)
    content = os_model(schedulers, definitions) + allocated(time("minBudget", 1) + time("maxBudget", 2))
    roots = taken_back(models, content)
    (association,) = found(roots, "osModel", "operatingSystems", "taskSchedulers", "parentAssociation")
    (old,) = association.all("schedulingParameters")
    assert old.attributes == {"priority": "3"}
    assert [(child.tag, child.type, child.get("value")) for child in old.children] == [
        ("replenishment", "", "10"),
        ("maxBudget", "", "2"),
    ]
    assert keys(association.parent) == [
        "AMALTHEA 2.0.0: parentAssociation/schedulingParameters/weight",
        "AMALTHEA 2.0.0: parentAssociation/order of schedulingParameters",
    ]


def test_other_parameters_are_kept_and_extended_ones_are_extensions(models):
    parameters = [
        integer("taskGroup", 0),
        string("extended%3A+slice", "50us"),
        time("deadline", 10),
        string("priority", "high"),
        parameter("list", 't="ListObject"'),
    ]
    names = ("taskGroup", "extended: slice", "deadline", "priority", "list")
    definitions = OSEK + "".join(map(parameter_definition, names))
    content = os_model(scheduler("OSEK"), definitions) + allocated("".join(parameters))
    (node,) = found(taken_back(models, content), "mappingModel", "taskAllocation")
    assert [child.attributes for child in node.all("parameterExtensions")] == [{"key": "slice", "value": "50us"}]
    assert keys(node)[:-1] == [f"AMALTHEA 2.0.0: schedulingParameters/{n}" for n in names if n != "extended: slice"]


@pytest.mark.parametrize(
    ("unit", "expected"), [("ns", {"quantSizeNs": "7"}), ("us", {"quantSizeNs": "7000"}), ("ps", {}), ("s", {})]
)
def test_a_quantum_is_a_number_of_nanoseconds(models, unit, expected):
    definitions = definition("PfairPD2") + parameter_definition("quantSize", "Time")
    content = os_model(scheduler("PfairPD2", time("quantSize", 7, unit)), definitions)
    older = migrated(models.files("newer", "2.0.0", content), "1.2.0")[0]
    (algorithm,) = found(older.roots, *ALGORITHM)
    assert algorithm.attributes == expected
    if unit != "us":  # which comes back as 7000 ns
        taken_back(models, content)


@pytest.mark.parametrize("text", ["0", "007"])
def test_a_quantum_that_would_come_back_as_another_text_is_kept(models, text):
    definitions = definition("PfairPD2") + parameter_definition("quantSize", "Time")
    roots = taken_back(models, os_model(scheduler("PfairPD2", time("quantSize", text, "ns")), definitions))
    (algorithm,) = found(roots, *ALGORITHM)
    assert algorithm.attributes == {}


def test_what_the_step_up_fills_in_is_not_restored(models):
    """The task group 0 and the quantum 0 of an allocation and algorithm that state none."""
    osek = definition("OSEK", processParameters="taskGroup?type=SchedulingParameterDefinition")
    content = os_model(scheduler("OSEK"), osek + parameter_definition("taskGroup"))
    group = '<customProperties key="osekTaskGroup"><value t="StringObject" value="0"/></customProperties>'
    priority = '<customProperties key="priority"><value t="StringObject" value="4"/></customProperties>'
    roots = taken_back(models, content + allocated("", group + priority))
    (task,) = found(roots, "swModel", "tasks")
    assert keys(task) == ["AMALTHEA 2.0.0: customProperties/osekTaskGroup", "AMALTHEA 2.0.0: customProperties/priority"]
    # Whoever writes the 1.2.0 file may state the default of the attribute.
    pfair = os_model(scheduler("PfairPD2"), definition("PfairPD2"))

    def state(roots):
        found(roots, *ALGORITHM)[0].attributes["quantSizeNs"] = "0"

    assert meaning(changed_and_back(models, pfair, state)) == models.read("2.0.0", pfair)


def test_defaults_of_parameters_are_stated(models):
    default = '<defaultValue t="IntegerObject" value="7"/>'
    content = os_model(scheduler("OSEK"), OSEK + parameter_definition("priority", "Integer", default)) + allocated("")
    (node,) = found(taken_back(models, content), "mappingModel", "taskAllocation")
    assert node.child("schedulingParameters").attributes == {"priority": "7"}
    assert len(models.messages(NoteKind.DEFAULTED)) == 1


def test_a_stated_parameter_needs_no_default(models):
    default = '<defaultValue t="IntegerObject" value="7"/>'
    content = os_model(scheduler("OSEK"), OSEK + parameter_definition("priority", "Integer", default))
    (node,) = found(taken_back(models, content + allocated(integer("priority", 3))), "mappingModel", "taskAllocation")
    assert [child.attributes for child in node.all("schedulingParameters")] == [{"priority": "3"}]
    assert models.messages(NoteKind.DEFAULTED) == []


def test_a_default_that_was_changed_in_1_2_0_counts(models):
    default = '<defaultValue t="IntegerObject" value="7"/>'
    content = os_model(scheduler("OSEK"), OSEK + parameter_definition("priority", "Integer", default))

    def change(roots):
        (allocation,) = found(roots, "mappingModel", "taskAllocation")
        allocation.children[-1].attributes["priority"] = "5"

    back = changed_and_back(models, content + allocated(""), change)
    assert meaning(back) == models.read("2.0.0", content + allocated(integer("priority", 5)))


@pytest.mark.parametrize(
    "parameters",
    [
        integer("priority", 1) + integer("taskGroup", 2),
        integer("priority", 1) + integer("minBudget", 2),
        integer("priority", 1) + '<schedulingParameters key="extended%3A+k?type=SchedulingParameterDefinition">'
        '<value t="StringObject"/></schedulingParameters>',
    ],
)
def test_definitions_are_kept_where_an_allocation_keeps_a_parameter(models, parameters):
    """As the step up makes them, but only beside a parameter that 1.2.0 cannot state."""
    names = {"taskGroup": "Integer", "minBudget": "Time", "extended: k": "String"}
    used = [name for name in names if name.replace(": ", "%3A+") + "?" in parameters or name == "taskGroup"]
    group = "taskGroup?type=SchedulingParameterDefinition"
    osek = definition("OSEK", **FLAGS, processParameters=f"priority?type=SchedulingParameterDefinition {group}")
    made = "".join(
        f'<schedulingParameterDefinitions name="{name}" type="{names[name]}" many="false"'
        f' mandatory="{"true" if name == "taskGroup" else "false"}"/>'
        for name in used
    )
    roots = taken_back(models, os_model(scheduler("OSEK"), osek + PRIORITY + made) + allocated(parameters))
    (node,) = found(roots, "osModel")
    assert "AMALTHEA 2.0.0: schedulerDefinitions/OSEK" in keys(node)


def test_comments_come_back(models):
    definitions = f"<!--1-->{definition('OSEK')}<!--2-->{parameter_definition('own')}"
    content = os_model(scheduler("OSEK", "<!--3-->" + integer("own", 1)), definitions)
    nodes = all_below(changed_and_back(models, content, lambda _: None).roots)
    assert {node.tag: node.comments for node in nodes if node.comments} == {
        "schedulerDefinitions": ["<!--1-->"],
        "schedulingParameterDefinitions": ["<!--2-->"],
        "schedulingParameters": ["<!--3-->"],
    }


@pytest.mark.parametrize(
    ("comment", "part", "other", "number"),
    [
        ("", "", [], 0),
        ("<!--why-->", "", [], 2),
        ("", '<customProperties key="k"><value t="StringObject" value="v"/></customProperties>', [], 2),
        # The step up would put them there.
        ("", "", ['<osModel><osOverheads name="O"/></osModel>'], 2),
    ],
)
def test_definitions_are_kept_unless_the_step_up_makes_them_so(models, comment, part, other, number):
    standard = definition("PriorityBased", part, **FLAGS, processParameters="priority?type=SchedulingParameterDefinition")
    controller = '<interruptControllers name="C" definition="PriorityBased?type=SchedulerDefinition"/>'
    roots = taken_back(models, *other, os_model(controller, comment + standard + PRIORITY))
    assert len(keys(found(roots, "osModel")[-1])) == number


def test_a_changed_algorithm_counts(models):
    content = os_model(scheduler("My+own"), definition("My own") + OSEK + PRIORITY)

    def change(roots):
        found(roots, *ALGORITHM)[0].type = "RateMonotonic"

    back = changed_and_back(models, content, change)
    (node,) = found(back.roots, "osModel", "operatingSystems", "taskSchedulers")
    assert node.target("definition").name == "RateMonotonic"
    assert [d.name for d in found(back.roots, "osModel", "schedulerDefinitions")] == ["My own", "OSEK", "RateMonotonic"]


def test_the_os_model_may_be_in_another_file(models):
    content = os_model(scheduler("My+own"), definition("My own") + PRIORITY)
    mapping = """<swModel><tasks name="T"/></swModel><mappingModel><taskAllocation task="T?type=Task">
    <schedulingParameters><key href="amlt:/#priority?type=SchedulingParameterDefinition"/>
    <value t="IntegerObject" value="3"/></schedulingParameters>
    <scheduler href="amlt:/#S?type=TaskScheduler"/></taskAllocation></mappingModel>"""
    taken_back(models, mapping, content)


def test_conditions_are_on_modes(models):
    before = """<swModel><runnables name="R"><executionCondition>
    <entries t="ModeValueCondition" value="on" relation="EQUAL"/>
    <entries t="ConditionConjunction"><entries t="ModeValueCondition" value="1"/></entries>
    </executionCondition><activityGraph>
    <items t="WhileLoop"><condition><entries t="ConditionConjunction"/></condition></items>
    {}</activityGraph></runnables></swModel>"""
    switch = """<items t="{}Switch"><entries name="e"><condition><entries t="{}ConditionConjunction"/>
    </condition><items t="Group"/></entries><defaultEntry/></items>"""
    taken_back(models, before.format(""))
    expected = before.replace("ConditionConj", "ModeConditionConj").format(switch.format("Mode", "Mode"))
    assert models.migrate("2.0.0", "1.2.0", before.format(switch.format("", ""))) == models.read("1.2.0", expected)


def test_tags_of_overheads_are_kept(models):
    content = """<commonElements><tags name="t"/></commonElements>
    <osModel><osOverheads name="O" tags="t?type=Tag"/></osModel>"""
    (node,) = found(taken_back(models, content), "osModel", "osOverheads")
    assert keys(node) == ["AMALTHEA 2.0.0: tags"]


FILL = '<entries t="ChannelFillCondition" fillLevel="1"/>'


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            f'<swModel><runnables name="R"><executionCondition>{FILL}</executionCondition></runnables></swModel>',
            "condition on the fill level of a channel: only AMALTHEA 2.0.0 and later have it",
        ),
        (os_model("", OSEK + OSEK + PRIORITY), "definition without a unique name: AMALTHEA 1.2.0 identifies it by name"),
        (os_model(scheduler("missing"), ""), "the definition of the scheduler is in none of the files"),
        (
            os_model(scheduler("X").replace("SchedulerDefinition", "Task"), "") + '<swModel><tasks name="X"/></swModel>',
            "the definition of the scheduler is in none of the files",
        ),
        (os_model("", OSEK), "a parameter of the scheduler definition is in none of the files"),
        (osek("<schedulingParameters/>"), "scheduling parameter without a definition that has a name"),
        (osek(integer("missing", 1)), "scheduling parameter of which the definition is in none of the files"),
        (
            osek('<schedulingParameters key="priority?type=SchedulingParameterDefinition"/>'),
            "scheduling parameter without a value",
        ),
        (osek(integer("priority", 1) * 2), "scheduling parameter that is stated twice"),
        (osek(integer("priority", 1).replace("</sch", "<unknown/></sch")), "scheduling parameter with unknown content"),
        (os_model("", definition("X", "<unknown/>")), "unknown part of a definition"),
        (
            osek() + '<eventModel><customProperties key="k"><value t="ReferenceObject" value="OSEK?type=SchedulerDefinition"/>'
            "</customProperties></eventModel>",
            "reference 'value': its target is lost",
        ),
        (
            '<osModel><customProperties key="AMALTHEA 2.0.0: schedulerDefinitions/OSEK"/></osModel>',
            "custom property of an earlier migration back that was never restored",
        ),
    ],
)
def test_what_1_2_0_has_no_place_for_is_an_error(models, content, message):
    assert refused(models, content) == [message]


@pytest.mark.parametrize(
    "content",
    [
        '<osModel><customProperties key="AMALTHEA 2.0.0: schedulerDefinitions/OSEK"/></osModel>',
        '<osModel><customProperties key="AMALTHEA 2.0.0: schedulerDefinitions/OSEK"><value/></customProperties></osModel>',
        """<osModel><customProperties key="AMALTHEA 2.0.0: schedulerDefinitions/OSEK"><value t="MapObject">
        <entries/><entries key="processParameters"><value/></entries><entries key="tags"><value/></entries>
        <entries key="customProperties"/></value></customProperties>
        <operatingSystems><taskSchedulers name="S"><customProperties key="AMALTHEA 2.0.0: definition"/></taskSchedulers>
        <interruptControllers><schedulingParameters/></interruptControllers></operatingSystems></osModel>""",
        """<osModel><customProperties key="AMALTHEA 2.0.0: schedulerDefinitions/OSEK"><value t="MapObject">
        <entries key="processParameters"><value><values t="StringObject" value="lost"/></value></entries></value>
        </customProperties></osModel>
        <mappingModel><taskAllocation><customProperties key="AMALTHEA 2.0.0: defaults"/>
        <customProperties key="AMALTHEA 2.0.0: schedulingParameters/priority"/><schedulingParameters priority="1"/>
        </taskAllocation></mappingModel>""",
    ],
)
def test_damaged_properties_do_no_harm(models, content):
    models.migrate("1.2.0", "2.0.0", content)
