"""ITEA 1.3.0 -> 0.7.0."""

import pytest
from itea import all_of, messages, model, nested, only, write
from migration import migrated

from amalthea_uros.xmi.tree.results import tree_text

TARGET = "0.7.0"


def step(folder, **files):
    return migrated(write(folder, "1.3.0", **files), TARGET)


@pytest.mark.parametrize(
    ("path", "class_name"),
    [
        ("swModel/activations sw:Periodic", "PeriodicActivation"),
        ("stimuliModel/stimuli stimuli:Periodic", "Periodic"),
        ("componentsModel/components components:Composite", "Composite"),
        ("hwModel/networkTypes hw:Bus", "Bus"),
    ],
)
def test_classes_lose_their_package(tmp_path, path, class_name):
    models, _ = step(tmp_path, m__amxmi=nested(path))
    assert class_name in {node.type for node in models.walk()}


#: Object, reference to it, text of the reference afterwards.
REFERENCES = [
    ("swModel/events", "e+v?type=sw.OSEvent", "e+v?type=OsEvent"),
    ("swModel/activations sw:Periodic", "e+v?type=sw.Periodic", "e+v?type=PeriodicActivation"),
    ("hwModel/memoryTypes", "e+v?type=hw.MemType", "e+v?type=MemoryType"),
    ("hwModel/system", "e+v?type=hw.System", "e+v?type=HwSystem"),
    ("hwModel/system/components", "e+v?type=hw.Component", "e+v?type=HwComponent"),
    ("hwModel/system/ports", "e+v?type=hw.Port", "e+v?type=HwPort"),
    ("osModel/osOverheads", "e+v?type=os.OSInstructions", "e+v?type=OsInstructions"),
    ("hwModel", "gone?type=hw.MemType", "gone?type=MemoryType"),
    ("hwModel", "gone?type=sw.Label", "gone?type=Label"),
]


@pytest.mark.parametrize(("path", "text", "after"), REFERENCES)
def test_references_name_the_new_class(tmp_path, path, text, after):
    holder = f"""<configModel><customProperties key="k"><value xsi:type="common:ReferenceObject" value="{text}"/>
        </customProperties></configModel>"""
    models, _ = step(tmp_path, m__amxmi=nested(path, 'name="e v"') + holder)
    assert after in tree_text(models.trees[0])


@pytest.mark.parametrize(
    ("path", "before", "after"),
    [
        ("hwModel/system/ports hw:ComplexPort", 'isMaster="true"', "master"),
        ("swModel/labels", 'isBuffered="buffered"', "buffered"),
        ("swModel/runnables/runnableItems sw:SenderReceiverRead", 'isBuffered="true"', "buffered"),
        (
            "swModel/runnables/runnableItems sw:Group/items/runnableItem sw:SemaphoreAccess",
            'accessEnum="release"',
            "access",
        ),
        ("swModel/isrs/callGraph/graphEntries sw:ModeSwitch/entries", 'isDefault="true"', "default"),
    ],
)
def test_attributes_are_renamed(tmp_path, path, before, after):
    models, notes = step(tmp_path, m__amxmi=nested(path, before))
    assert [list(node.attributes) for node in models.walk() if node.attributes] == [[after]]
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
