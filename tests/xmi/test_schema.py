import json
import random
import re
from functools import cache
from pathlib import Path

import pytest
import xmlschema
from effort import IS_THOROUGH, every
from lxml import etree

from amalthea_uros._internal.resources import resource_folder
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.versions import VersionFacts, facts, supported_versions
from amalthea_uros.xmi.schema import MAX_PROBLEMS, SchemaProblem, schema_path, validate

VERSION = "3.3.0"
SHARED = Path(__file__).parents[2].parent / "shared"
XSI = "http://www.w3.org/2001/XMLSchema-instance"
#: The newest one, and older ones.
VERSIONS = every(len(supported_versions()) - 1, supported_versions()[::-1])


def document(content: str, version: str = VERSION) -> bytes:
    """A file whose line 3 is the first one of the content."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="{XSI}"'
        f' xmlns:am="http://app4mc.eclipse.org/amalthea/{version}">\n{content}\n</am:Amalthea>\n'
    ).encode()


@cache
def read_by_xmlschema(version: str) -> xmlschema.XMLSchema10:
    return xmlschema.XMLSchema10(str(schema_path(version)), allow="local")


def only_problem(content: str) -> SchemaProblem:
    problems = validate(document(content), VERSION)
    assert len(problems) == 1, problems
    return problems[0]


@pytest.mark.parametrize("version", every(len(VERSIONS), VERSIONS))
def test_schemas_are_accepted_by_both_validators_and_small(version):
    path = schema_path(version)
    etree.XMLSchema(file=str(path))
    assert read_by_xmlschema(version).all_errors == []
    assert path.stat().st_size < 250_000


@pytest.mark.parametrize("version", ["0.9.5", "3.4.0", "../3.3.0", ""])
def test_a_version_without_schema_is_refused(version):
    with pytest.raises(match="no XML schema for AMALTHEA"):
        validate(b"<a/>", version)


def test_an_installed_package_holds_the_schemas_itself(tmp_path, monkeypatch):
    (tmp_path / "schemas").mkdir()
    monkeypatch.setattr("amalthea_uros._internal.resources._PACKAGE", tmp_path)
    assert resource_folder("schemas") == tmp_path / "schemas"
    assert resource_folder("templates") == tmp_path.parent / "templates"


# What is legal


def sample_value(declared: VersionFacts, type_name: str) -> str:
    if type_name in declared.enums:
        return declared.enums[type_name].literals[-1]
    return {"EString": "any <text>", "EBoolean": "true"}.get(type_name, "1")


def fill(element: etree._Element, declared: VersionFacts, class_name: str, rng: random.Random) -> None:
    """Give an object every feature, contained ones with every class that they may hold, in an order by chance."""
    children = []
    for feature in declared.features(class_name):
        if not feature.stored:
            continue
        types = declared.concrete_subtypes(feature.type) if feature.type in declared.classes else ()
        if feature.kind is FeatureKind.ATTRIBUTE:
            element.set(feature.name, sample_value(declared, feature.type))
            continue
        if feature.kind is FeatureKind.REFERENCE:
            element.set(feature.name, "a?type=A b?type=B")
            children.append((feature.name, None))
        elif feature.type in types:
            children.append((feature.name, None))
        children += [(feature.name, type_name) for type_name in types]
    children *= 2
    rng.shuffle(children)
    for name, type_name in children:
        child = etree.SubElement(element, name, href="amlt:/#x?type=X")
        if type_name:
            child.set(f"{{{XSI}}}type", f"am:{type_name}")


def ways_to_contain(declared: VersionFacts) -> dict[str, tuple[tuple[str, str], ...]]:
    """For every class that may be in a file a way from the root to it, as features and classes."""
    ways: dict[str, tuple[tuple[str, str], ...]] = {"Amalthea": ()}
    waiting = ["Amalthea"]
    while waiting:
        owner = waiting.pop(0)
        for feature in declared.features(owner):
            if feature.kind is FeatureKind.CONTAINMENT:
                for class_name in declared.concrete_subtypes(feature.type):
                    if class_name not in ways:
                        ways[class_name] = (*ways[owner], (feature.name, class_name))
                        waiting.append(class_name)
    return ways


@pytest.mark.parametrize("version", VERSIONS)
def test_every_feature_of_every_class_is_accepted_in_any_order(version):
    declared = facts(version)
    ways = ways_to_contain(declared)
    assert len(ways) > 250
    for class_name, way in every(5, list(ways.items())):
        root = etree.fromstring(document("", version))
        element = root
        for name, step in way:
            element = etree.SubElement(element, name, {f"{{{XSI}}}type": f"am:{step}"})
        fill(element, declared, class_name, random.Random(class_name))
        assert validate(etree.tostring(root), version) == [], class_name


#: Classes accepted where they do not belong, since a schema type derives from one type only.
TOLERATED = {
    ("ProcessGroup", "RunnableEntityGroup"),
    ("TaskSchedulingAlgorithm", "PriorityBased"),
    ("Condition", "ModeConditionConjunction"),
    ("ConditionDisjunctionEntry", "ModeConditionConjunction"),
}


@pytest.mark.parametrize("version", every(len(VERSIONS), VERSIONS))
def test_a_class_is_accepted_only_where_it_belongs(version):
    declared = facts(version)
    types = read_by_xmlschema(version).types
    held = {f.type for c in declared.classes for f in declared.features(c) if f.kind is FeatureKind.CONTAINMENT and c in types}
    accepted = {
        (upper, name)
        for upper in held
        for name, fact in declared.classes.items()
        if not fact.abstract and types[name].is_derived(types[upper])
    }
    legal = {(upper, name) for upper in held for name in declared.concrete_subtypes(upper)}
    assert legal <= accepted
    assert accepted - legal <= TOLERATED


@pytest.mark.parametrize("value", ["1.0", "5.0E-4", "2.034807E7", "80000", "NaN", "Infinity", "1.5f", ".5"])
def test_numbers_as_java_writes_them_are_accepted(value):
    content = f'<customProperties key="k"><value xsi:type="am:DoubleObject" value="{value}"/></customProperties>'
    assert validate(document(content), VERSION) == []


@pytest.mark.parametrize("value", ["0x0", "0x1A", "#1a", "017", "200000", "0"])
def test_addresses_as_java_reads_them_are_accepted(value):
    content = f'<mappingModel><physicalSectionMapping startAddress="{value}"/></mappingModel>'
    assert validate(document(content), VERSION) == []


def test_comments_instructions_and_equal_ids_are_accepted():
    content = '<swModel><!-- one --><tasks xmi:id="a"/><?two?><tasks xmi:id="a"/><isrs/><tasks/></swModel>'
    assert validate(document(content), VERSION) == []


def test_the_schemas_that_a_file_names_are_not_loaded(tmp_path):
    (tmp_path / "other.xsd").write_text("no schema")
    data = document("").replace(b" xmi:version", f' xsi:schemaLocation="urn:other {tmp_path}/other.xsd" xmi:version'.encode())
    assert validate(data, VERSION) == []


# What is not


@pytest.mark.parametrize(
    ("content", "path", "reason", "advice"),
    [
        (
            '<tasks preemption="quick"/>',
            "tasks",
            'attribute preemption="quick" is not a literal of Preemption',
            '"cooperative"',
        ),
        (
            '<tasks preemption="it\'s"/>',
            "tasks",
            'attribute preemption="it\'s" is not a literal of Preemption',
            '"cooperative"',
        ),
        ('<tasks nme="a"/>', "tasks", 'Task has no attribute "nme"', 'did you mean "name"?'),
        ('<tasks foo="a"/>', "tasks", 'Task has no attribute "foo"', 'allowed: "multipleTaskActivationLimit", "name"'),
        ('<tasks xmi:foo="a"/>', "tasks", 'Task has no attribute "xmi:foo"', None),
        ("<tsks><foo/></tsks>", "tsks", 'SWModel has no element "tsks"', 'did you mean "tasks"?'),
        ("<!-- comment --><am:tasks/>", "am:tasks", 'SWModel has no element "am:tasks"', 'did you mean "tasks"?'),
        (
            '<tasks><activityGraph><items xsi:type="am:Label" name="x"><size foo="1"/></items></activityGraph></tasks>',
            "tasks/activityGraph/items",
            'wrong xsi:type Label: "items" contains objects of class ActivityGraphItem',
            'did you mean "am:LabelAccess"?',
        ),
        (
            '<tasks><activityGraph><items name="x"><size/></items></activityGraph></tasks>',
            "tasks/activityGraph/items",
            "missing xsi:type: ActivityGraphItem is an abstract class",
            '"am:RunnableCall"',
        ),
        (
            '<tasks><activityGraph><items xsi:type="am:RunableCall" runnable="r"/></activityGraph></tasks>',
            "tasks/activityGraph/items",
            'xsi:type="am:RunableCall" is not a class of AMALTHEA 3.3.0',
            'did you mean "am:RunnableCall"?',
        ),
        (
            '<tasks><activityGraph><items xsi:type="am:ActivityGraphItem"/></activityGraph></tasks>',
            "tasks/activityGraph/items",
            'xsi:type="am:ActivityGraphItem" is an abstract class',
            '"am:RunnableCall"',
        ),
        ('<foo xsi:type="am:Foo"/>', "foo", 'xsi:type="am:Foo" is not a class of AMALTHEA 3.3.0', None),
        ('<tasks><stimuli name="s"/></tasks>', "tasks/stimuli", 'a reference has no attribute "name"', 'allowed: "href"'),
        ("<tasks><stimuli><a/></stimuli></tasks>", "tasks/stimuli/a", 'a reference has no element "a"', None),
        ('<labels constant="yes"/>', "labels", 'attribute constant="yes" is not a boolean', 'allowed: "true", "false"'),
        ('<labels><size value="3x"/></labels>', "labels/size", 'attribute value="3x" is not a whole number', None),
        (
            '<tasks multipleTaskActivationLimit="3000000000"/>',
            "tasks",
            'attribute multipleTaskActivationLimit="3000000000" is not a whole number of 32 bits',
            None,
        ),
        (
            '<tasks multipleTaskActivationLimit="1_0"/>',
            "tasks",
            "Element 'tasks', attribute 'multipleTaskActivationLimit': '1_0' is not a valid value of the atomic type 'xs:int'.",
            None,
        ),
        ("<tasks>text</tasks>", "tasks", "text between the elements", "remove it"),
        ('<tasks xsi:nil="true"/>', "tasks", "element is not nillable", None),
    ],
)
def test_a_mistake_is_one_readable_problem(content, path, reason, advice):
    problem = only_problem(f"<swModel>\n<labels/>\n{content}\n</swModel>")
    assert (problem.line, problem.column) == (5, None)
    assert re.sub(r"\[\d\]", "", problem.path) == f"/am:Amalthea/swModel/{path}"
    assert problem.reason == reason
    assert advice in problem.advice if advice else problem.advice is None or advice is None


@pytest.mark.parametrize(
    ("content", "path", "reason"),
    [
        (
            '<stimuliModel><stimuli xsi:type="am:PeriodicBurstStimulus" occurrenceCount="-1"/></stimuliModel>',
            "stimuliModel/stimuli",
            'attribute occurrenceCount="-1" is not a whole number greater than 0',
        ),
        (
            '<hwModel><domains xsi:type="am:FrequencyDomain"><defaultValue value="-1.0"/></domains></hwModel>',
            "hwModel/domains/defaultValue",
            'attribute value="-1.0" is not a number of at least 0',
        ),
        (
            '<hwModel><domains xsi:type="am:PowerDomain"><defaultValue value="INF"/></domains></hwModel>',
            "hwModel/domains/defaultValue",
            'attribute value="INF" is not a number',
        ),
        (
            '<mappingModel><physicalSectionMapping startAddress="-0x1"/></mappingModel>',
            "mappingModel/physicalSectionMapping",
            'attribute startAddress="-0x1" is not an address',
        ),
        (
            '<componentsModel><components name="c"><componentInstances/></components></componentsModel>',
            "componentsModel/components/componentInstances",
            'Component has no element "componentInstances"',
        ),
    ],
)
def test_mistakes_outside_of_the_software_model(content, path, reason):
    problem = only_problem(content)
    assert (problem.line, problem.path, problem.reason) == (3, f"/am:Amalthea/{path}", reason)


def test_problems_come_by_line_and_the_second_of_equal_elements_is_named():
    content = '<swModel>\n<tasks/>\n<tasks nme="b">\n<activityGraph foo="1"/>\n</tasks>\n<tsks/>\n<tsks/>\n</swModel>'
    assert [(p.line, p.path.removeprefix("/am:Amalthea/swModel/")) for p in validate(document(content), VERSION)] == [
        (5, "tasks[2]"),
        (6, "tasks[2]/activityGraph"),
        (8, "tsks[1]"),
        (9, "tsks[2]"),
    ]


def test_a_long_list_is_cut_and_says_so():
    problems = validate(document("<swModel>" + '<tasks foo="1"/>\n' * (MAX_PROBLEMS + 50) + "</swModel>"), VERSION)
    assert len(problems) == MAX_PROBLEMS + 1
    assert problems[-1].reason == "50 more problems from here on, not listed"
    assert problems[-1].path == "/am:Amalthea/swModel/tasks[101]"


def test_each_unknown_attribute_of_a_great_many_is_a_problem():
    def element(count: int) -> bytes:
        unknown = " ".join(f'none{number}="1"' for number in range(count))
        return document(f'<swModel><labels name="L" constant="perhaps" {unknown}/></swModel>')

    # 10,000 attributes: xmlschema alone takes minutes, because it formats all of them for each error.
    few, many = (validate(element(count), VERSION) for count in (99, 10_000))
    assert sorted(problem.reason for problem in few) == sorted(problem.reason for problem in many[:100])
    assert many[-1].reason == "9901 more problems from here on, not listed"


def test_a_great_many_attributes_of_an_element_of_an_unknown_class_are_one_problem():
    attributes = " ".join(f'none{number}="1"' for number in range(1000))
    problem = only_problem(f'<stimuliModel><stimuli xsi:type="am:None" {attributes}/></stimuliModel>')
    assert problem.reason == 'xsi:type="am:None" is not a class of AMALTHEA 3.3.0'


@pytest.mark.parametrize(
    ("data", "reason", "advice"),
    [
        (document("", "2.0.0"), "wrong namespace of the root element", "validate it as AMALTHEA 2.0.0"),
        (b"<model/>", 'wrong namespace of the root element: ""', f'expected: "{facts(VERSION).namespace}"'),
        (document("").replace(b"am:Amalthea", b"am:SWModel"), 'wrong root element "SWModel"', 'expected: "Amalthea"'),
    ],
)
def test_another_root_is_one_problem(data, reason, advice):
    (problem,) = validate(data, VERSION)
    assert problem.reason.startswith(reason)
    assert problem.advice.startswith(advice)


@pytest.mark.parametrize(("data", "line"), [(b"", 1), (b"<a>\n<b></a>", 2), (b"\x00\x01", 1)])
def test_what_is_not_xml_is_one_problem_with_its_column(data, line):
    (problem,) = validate(data, VERSION)
    assert problem.line == line
    assert problem.column is not None
    assert re.fullmatch("not well-formed XML: [^,]+", problem.reason)


def test_entities_are_not_replaced():
    doctype = b'<!DOCTYPE a [<!ENTITY secret SYSTEM "file:///etc/hostname">]><am:Amalthea'
    data = document("<swModel><tasks>&secret;</tasks></swModel>").replace(b"<am:Amalthea", doctype, 1)
    (problem,) = validate(data, VERSION)
    assert problem.path == "/am:Amalthea/swModel/tasks"
    assert problem.reason == "entity reference &secret; between the elements"


def test_an_avalanche_of_entities_is_refused():
    levels = "".join(f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 10))
    doctype = f'<!DOCTYPE a [<!ENTITY a0 "aaaaaaaaaa">{levels}]><am:Amalthea'.encode()
    data = document('<swModel><tasks name="&a9;"/></swModel>').replace(b"<am:Amalthea", doctype, 1)
    (problem,) = validate(data, VERSION)
    assert problem.reason.startswith("not well-formed XML: Maximum entity amplification")


# Files of others


def corpus() -> list[tuple[str, str]]:
    inventory = SHARED / "corpus" / "inventory.json"
    entries = json.loads(inventory.read_text(encoding="utf-8")) if inventory.exists() else []
    return [(e["file"], e["version"]) for e in entries if e["wellFormed"] and e["version"] in supported_versions()]


@pytest.mark.skipif(not SHARED.exists(), reason="no collection of models beside the repository")
@pytest.mark.parametrize(("file", "version"), corpus())
def test_models_of_others_are_valid(file, version):
    assert validate((SHARED / "corpus" / file).read_bytes(), version) == []


#: Vectors with a defect that a schema can see, and the lines of its problems.
DEFECTS = {
    "01_ns_0_9_9": [26, 27, 28, 37, 37, 39, 39],
    "01_ns_1_0_0": [26, 27, 28, 37, 37, 39, 39],
    "01_ns_1_1_0": [26, 27, 28, 37, 37, 39, 39],
    "31_burst_count0_ok": [23],
    "31_burst_zerocount": [23],
    "70_unknown_attr": [4],
    "70_unknown_elem": [3],
}


@pytest.mark.skipif(not SHARED.exists(), reason="no collection of models beside the repository")
@pytest.mark.parametrize("path", sorted((SHARED / "vectors" / "am2inc").glob("*.amxmi")), ids=lambda path: path.stem)
def test_small_models_with_deliberate_defects(path):
    data = path.read_bytes()
    version = re.search(rb'amalthea/([\d.]+)"', data)
    if version is None or version[1] == b"3.4.0":
        pytest.skip("not a file of a version with schema")
    if version[1] < b"1.2" and not IS_THOROUGH:
        pytest.skip("to read another schema takes long")
    assert [problem.line for problem in validate(data, version[1].decode())] == DEFECTS.get(path.stem, [])
