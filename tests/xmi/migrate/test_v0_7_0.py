"""ITEA 1.3.0 -> 0.7.0."""

import pytest
from itea import all_of, messages, model, only, write
from migration import migrated

from amalthea_uros.xmi.tree.results import tree_text

TARGET = "0.7.0"


def step(folder, **files):
    return migrated(write(folder, "1.3.0", **files), TARGET)


#: Content of the model, tag, class afterwards.
CLASSES = [
    ('<swModel><activations xsi:type="sw:Periodic" name="x"/></swModel>', "activations", "PeriodicActivation"),
    ('<stimuliModel><stimuli xsi:type="stimuli:Periodic"/></stimuliModel>', "stimuli", "Periodic"),
    ('<componentsModel><components xsi:type="components:Composite"/></componentsModel>', "components", "Composite"),
    ('<hwModel><networkTypes xsi:type="hw:Bus"/></hwModel>', "networkTypes", "Bus"),
]


@pytest.mark.parametrize(("content", "tag", "class_name"), CLASSES)
def test_classes_lose_their_package(tmp_path, content, tag, class_name):
    models, _ = step(tmp_path, m__amxmi=content)
    assert all_of(models, tag)[0].type == class_name


#: Content, reference to it, text of the reference afterwards.
REFERENCES = [
    ('<swModel><events name="e v"/></swModel>', "e+v?type=sw.OSEvent", "e+v?type=OsEvent"),
    ('<swModel><activations xsi:type="sw:Periodic" name="a"/></swModel>', "a?type=sw.Periodic", "a?type=PeriodicActivation"),
    ('<hwModel><memoryTypes name="m"/></hwModel>', "m?type=hw.MemType", "m?type=MemoryType"),
    ('<hwModel><system name="s"/></hwModel>', "s?type=hw.System", "s?type=HwSystem"),
    ('<hwModel><system><components name="c"/></system></hwModel>', "c?type=hw.Component", "c?type=HwComponent"),
    ('<hwModel><system><ports name="p"/></system></hwModel>', "p?type=hw.Port", "p?type=HwPort"),
    ('<osModel><osOverheads name="o"/></osModel>', "o?type=os.OSInstructions", "o?type=OsInstructions"),
    ("", "gone?type=hw.MemType", "gone?type=MemoryType"),
    ("", "gone?type=sw.Label", "gone?type=Label"),
]


@pytest.mark.parametrize(("content", "text", "after"), REFERENCES)
def test_references_name_the_new_class(tmp_path, content, text, after):
    holder = f"""<configModel><customProperties key="k"><value xsi:type="common:ReferenceObject" value="{text}"/>
        </customProperties></configModel>"""
    models, _ = step(tmp_path, m__amxmi=content + holder)
    assert after in tree_text(models.trees[0])


#: Content, tag, attribute before and after.
ATTRIBUTES = [
    ('<hwModel><system><ports xsi:type="hw:ComplexPort" isMaster="true"/></system></hwModel>', "ports", "master"),
    ('<swModel><labels isBuffered="buffered"/></swModel>', "labels", "buffered"),
    (
        '<swModel><runnables><runnableItems xsi:type="sw:SenderReceiverRead" isBuffered="true"/></runnables></swModel>',
        "runnableItems",
        "buffered",
    ),
    (
        '<swModel><runnables><runnableItems xsi:type="sw:Group"><items><runnableItem xsi:type="sw:SemaphoreAccess" '
        'accessEnum="release"/></items></runnableItems></runnables></swModel>',
        "runnableItem",
        "access",
    ),
    (
        '<swModel><isrs><callGraph><graphEntries xsi:type="sw:ModeSwitch"><entries isDefault="true"/></graphEntries></callGraph>'
        "</isrs></swModel>",
        "entries",
        "default",
    ),
]


@pytest.mark.parametrize(("content", "tag", "attribute"), ATTRIBUTES)
def test_attributes_are_renamed(tmp_path, content, tag, attribute):
    models, notes = step(tmp_path, m__amxmi=content)
    assert list(all_of(models, tag)[0].attributes) == [attribute]
    assert len(messages(notes, "renamed")) == 1


def test_memory_types_of_property_constraints(tmp_path):
    text = model("1.3.0", '<memTypeDefinitions name="m"/>', "propertyconstraints:PropertyConstraintsModel")
    models, _ = step(tmp_path, p__amxmi=text)
    assert [child.tag for child in models.trees[0].root.children] == ["memoryTypeDefinitions"]
    assert models.trees[0].root.tag == "PropertyConstraintsModel"


# Hardware


def hardware(value, tag="attribute", holder="ecuTypes"):
    return f'<hwModel><{holder} name="h"><customProperties key="old"/>{value}<ports/></{holder}></hwModel>'.replace("TAG", tag)


@pytest.mark.parametrize(
    ("value", "key", "class_name", "text"),
    [
        ('<TAG xsi:type="hw:BoolValue" name="a b" value="true"/>', "#a b", "BooleanObject", "true"),
        ('<TAG xsi:type="hw:CharValue" name="c" value="8364"/>', "#c", "StringObject", "€"),
        ('<TAG xsi:type="hw:CharValue" name="c" value="x"/>', "#c", "StringObject", "x"),
        ('<TAG xsi:type="hw:CharValue" name="c" value="0"/>', "#c", "StringObject", "0"),
        ('<TAG xsi:type="hw:CharValue" name="c" value="99999999999"/>', "#c", "StringObject", "99999999999"),
        ('<TAG xsi:type="hw:CharValue" name="c"/>', "#c", "StringObject", None),
        ('<TAG xsi:type="hw:DoubleValue" name="d" value="1.5"/>', "#d", "DoubleObject", "1.5"),
        ('<TAG xsi:type="hw:IntValue" name="i" value="2"/>', "#i", "IntegerObject", "2"),
        ('<TAG xsi:type="hw:LongValue" name="l" value="3"/>', "#l", "LongObject", "3"),
        (
            '<TAG xsi:type="hw:StrValue" name="s" value="_AAAAAAAAAAAAAAAAAAAAAA"/>',
            "#s",
            "StringObject",
            "_AAAAAAAAAAAAAAAAAAAAAA",
        ),
        ('<TAG xsi:type="hw:FeatureTypes" name="f" value="SIMD"/>', "#FeatureTypes#f", "StringObject", "SIMD"),
    ],
)
@pytest.mark.parametrize(("tag", "prefix"), [("attribute", "attribute"), ("features", "feature")])
def test_values_of_hardware_are_custom_properties(tmp_path, value, key, class_name, text, tag, prefix):
    models, notes = step(tmp_path, m__amxmi=hardware(value, tag))
    old, made, port = only(models, "hwModel", "ecuTypes").children
    assert (old.get("key"), port.tag) == ("old", "ports")
    assert (made.tag, made.get("key")) == ("customProperties", prefix + key)
    assert (made.child("value").type, made.child("value").attributes.get("value")) == (class_name, text)
    assert "kept as custom property" in {note.kind for note in notes}


@pytest.mark.parametrize("key", ["attribute"])
def test_a_value_without_name(tmp_path, key):
    models, _ = step(tmp_path, m__amxmi=hardware('<attribute xsi:type="hw:IntValue" value="1"/>'))
    assert all_of(models, "customProperties")[1].get("key") == key


def test_attributes_come_before_features(tmp_path):
    values = '<features xsi:type="hw:IntValue" name="f"/><attribute xsi:type="hw:IntValue" name="a"/>'
    models, _ = step(tmp_path, m__amxmi=hardware(values))
    assert [made.get("key") for made in all_of(models, "customProperties")] == ["old", "attribute#a", "feature#f"]


@pytest.mark.parametrize("second", ["attribute#a 2"])
def test_attributes_of_one_name_stay_apart(tmp_path, second):
    values = '<attribute xsi:type="hw:IntValue" name="a"/><attribute xsi:type="hw:StrValue" name="a"/>'
    models, _ = step(tmp_path, m__amxmi=hardware(values))
    assert [made.get("key") for made in all_of(models, "customProperties")] == ["old", "attribute#a", second]


# Mixed and early files


def test_an_early_file_of_070_takes_the_step(tmp_path):
    path = tmp_path / "early.amxmi"
    path.write_text(
        """<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/0.7.0" xmlns:xmi="http://www.omg.org/XMI"
        xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"><swModel><tasks name="T"/></swModel><mappingModel>
        <processAllocation t="TaskAllocation" process="T?type=Task"/></mappingModel></am:Amalthea>"""
    )
    models, _ = migrated([path], "0.7.0")
    assert only(models, "mappingModel", "taskAllocation").target("task").name == "T"
