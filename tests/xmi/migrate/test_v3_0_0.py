"""Switches, data types, interfaces and semaphores of 3.0.0."""

import pytest
from inline_models import InlineModels
from migration import migrated

from amalthea_uros.xmi.migrate.model_set import all_below
from amalthea_uros.xmi.migrate.notes import NoteKind


@pytest.fixture
def models(tmp_path):
    return InlineModels(tmp_path)


def software(content):
    return f'<swModel>{content}<typeDefinitions t="BaseTypeDefinition" name="u 8"/></swModel>'


ARRAY = """<{0} t="Array" numberElements="{1}">
  <dataType t="TypeRef" typeDef="u+8?type=BaseTypeDefinition"/></{0}>"""


def test_equal_types_share_a_definition_whose_name_is_new(models):
    taken = '<typeDefinitions t="BaseTypeDefinition" name="L 1_type"/>'
    before = f"""{taken}<labels name="L 1">{ARRAY.format("dataType", 4)}</labels>
      <labels name="L 2">{ARRAY.format("dataType", 4)}</labels>
      <channels name="C">{ARRAY.format("elementType", 4)}</channels>
      <channels name="D">{ARRAY.format("elementType", 5)}</channels>"""
    after = f"""{taken}<labels name="L 1" dataType="L+1_type_2?type=DataTypeDefinition"/>
      <labels name="L 2" dataType="L+1_type_2?type=DataTypeDefinition"/>
      <channels name="C" elementType="L+1_type_2?type=DataTypeDefinition"/>
      <channels name="D" elementType="D_type?type=DataTypeDefinition"/>
      <typeDefinitions t="BaseTypeDefinition" name="u 8"/>
      <typeDefinitions t="DataTypeDefinition" name="L 1_type_2">{ARRAY.format("dataType", 4)}</typeDefinitions>
      <typeDefinitions t="DataTypeDefinition" name="D_type">{ARRAY.format("dataType", 5)}</typeDefinitions>"""
    assert models.migrate("2.2.0", "3.0.0", software(before)) == models.read("3.0.0", f"<swModel>{after}</swModel>")


def test_different_types_have_definitions_of_their_own(models):
    pointer = """<dataType t="{}"><dataType t="TypeRef" typeDef="{}?type=BaseTypeDefinition"/></dataType>"""
    types = [pointer.format(*each) for each in (("Pointer", "u+8"), ("Pointer", "u16"), ("Other", "u+8"))]
    present = """<typeDefinitions t="BaseTypeDefinition" name="u 8"/>
      <typeDefinitions t="BaseTypeDefinition" name="u16"/>"""
    before = "".join(f'<labels name="L{n}">{each}</labels>' for n, each in enumerate(types))
    after = "".join(f'<labels name="L{n}" dataType="L{n}_type?type=DataTypeDefinition"/>' for n, _ in enumerate(types))
    made = "".join(
        f'<typeDefinitions t="DataTypeDefinition" name="L{n}_type">{each}</typeDefinitions>' for n, each in enumerate(types)
    )
    found = models.migrate("2.2.0", "3.0.0", f"<swModel>{before}{present}</swModel>")
    assert found == models.read("3.0.0", f"<swModel>{after}{present}{made}</swModel>")


def test_equal_types_of_two_files_have_definitions_of_their_own(models):
    text = '<swModel><labels name="{}"><dataType t="Array" numberElements="2"/></labels></swModel>'
    after = """<swModel><labels name="{0}" dataType="{1}?type=DataTypeDefinition"/>
      <typeDefinitions t="DataTypeDefinition" name="{1}"><dataType t="Array" numberElements="2"/>
      </typeDefinitions></swModel>"""
    found = models.migrate("2.2.0", "3.0.0", text.format("A"), text.format("B"))
    assert found == models.read("3.0.0", after.format("A", "A_type"), after.format("B", "B_type"))


def test_the_first_of_two_type_references_counts(models):
    other = '<typeDefinitions t="BaseTypeDefinition" name="u16"/>'
    both = "".join(f'<dataType t="TypeRef" typeDef="{name}?type=BaseTypeDefinition"/>' for name in ("u16", "u+8"))
    after = '<labels name="L" dataType="u16?type=BaseTypeDefinition"/>'
    before = software(f'{other}<labels name="L">{both}</labels>')
    assert models.migrate("2.2.0", "3.0.0", before) == models.read("3.0.0", software(other + after))
    assert models.messages(NoteKind.LOST) == ["second data type"]


def test_a_type_of_another_file_is_a_reference_between_files(models):
    before = """<swModel><labels name="L"><dataType t="TypeRef">
      <typeDef href="amlt:/#u+8?type=BaseTypeDefinition"/></dataType></labels></swModel>"""
    after = '<swModel><labels name="L"><dataType href="amlt:/#u+8?type=BaseTypeDefinition"/></labels></swModel>'
    assert models.migrate("2.2.0", "3.0.0", before, software("")) == models.read("3.0.0", after, software(""))


def test_references_to_nothing_are_dropped_also_inside_of_types(models):
    before = """<labels name="L"><dataType t="TypeRef"/></labels>
      <labels name="P"><dataType t="Pointer"><dataType t="TypeRef"/></dataType></labels>"""
    after = """<labels name="L"/><labels name="P" dataType="P_type?type=DataTypeDefinition"/>"""
    definition = '<typeDefinitions t="DataTypeDefinition" name="P_type"><dataType t="Pointer"/></typeDefinitions>'
    expected = software(after).replace("</swModel>", definition + "</swModel>")
    assert models.migrate("2.2.0", "3.0.0", software(before)) == models.read("3.0.0", expected)
    assert len(models.messages(NoteKind.LOST)) == 2


def test_custom_properties_of_a_type_reference_stay_with_the_label(models):
    note = '<customProperties key="k"><value t="StringObject" value="v"/></customProperties>'
    before = f"""<labels name="L"><dataType t="TypeRef" typeDef="u+8?type=BaseTypeDefinition">{note}</dataType></labels>"""
    after = f'<labels name="L" dataType="u+8?type=BaseTypeDefinition">{note}</labels>'
    assert models.migrate("2.2.0", "3.0.0", software(before)) == models.read("3.0.0", software(after))


def test_comments_on_a_type_that_goes_away_stay_with_the_label(models):
    reference = '<!--{}--><dataType t="TypeRef" typeDef="u+8?type=BaseTypeDefinition"/>'
    array = "<!--{}-->" + ARRAY.format("dataType", 1)
    before = f"""<labels name="A">{reference.format(1)}</labels><labels name="B">{array.format(2)}</labels>
      <labels name="C">{array.format(3)}{array.format(4)}</labels><labels name="D"><!--5--><dataType t="TypeRef"/></labels>"""
    roots = migrated(models.files("before", "2.2.0", software(before)), "3.0.0")[0].roots
    commented = [(node.tag, node.name, node.comments) for node in all_below(roots) if node.comments]
    assert commented == [
        ("labels", "A", ["<!--1-->"]),
        ("labels", "C", ["<!--3-->", "<!--4-->"]),
        ("labels", "D", ["<!--5-->"]),
        ("dataType", "", ["<!--2-->"]),
    ]


def test_a_second_type_and_an_unreadable_reference_do_not_raise(models):
    before = f"""<labels name="L"><dataType t="TypeRef" typeDef="what?"/></labels>
      <labels name="M">{ARRAY.format("dataType", 1) * 2}</labels><labels>{ARRAY.format("dataType", 2)}</labels>"""
    text = "\n".join(models.migrate("2.2.0", "3.0.0", software(before)))
    assert "labels  dataType='what?' name='L'" in text
    assert "name='labels_type'" in text
    assert models.messages(NoteKind.LOST) == ["second data type"]


def test_what_is_already_a_reference_stays(models):
    content = software('<labels name="L" dataType="u+8?type=BaseTypeDefinition"/>')
    assert models.migrate("2.2.0", "3.1.0", content) == models.read("3.1.0", content)


@pytest.mark.parametrize("version", ["2.2.0", "3.0.0", "3.1.0"])
def test_switches_of_isrs_and_runnables_also_in_snapshots(models, version):
    text = """<swModel><isrs name="I"><activityGraph><items t="{0}"><entries name="e"><condition>
        <entries t="{1}"/></condition><items t="{0}"/></entries></items></activityGraph></isrs>
      <runnables name="R"><activityGraph><items t="{0}"/></activityGraph></runnables></swModel>"""
    before = text.format("ModeSwitch", "ModeConditionConjunction")
    assert models.migrate(version, "3.2.0", before) == models.read("3.2.0", text.format("Switch", "ConditionConjunction"))


def test_the_data_type_of_an_interface_is_written_with_a_capital(models):
    text = """<componentsModel><interfaces name="I" {0}="u+8?type=BaseTypeDefinition">
      <subInterfaces name="S" {0}="u+8?type=BaseTypeDefinition"/></interfaces></componentsModel>"""
    before, after = (software("") + text.format(name) for name in ("datatype", "dataType"))
    assert models.migrate("2.2.0", "3.0.0", before) == models.read("3.0.0", after)


@pytest.mark.parametrize("kind", ["Resource", "Spinlock"])
def test_other_semaphores_have_an_owner_by_default(models, kind):
    content = f'<osModel><semaphores name="s" semaphoreType="{kind}"/><semaphores name="t"/></osModel>'
    assert models.migrate("2.2.0", "3.0.0", content) == models.read("3.0.0", content)


def test_a_stated_ownership_stays(models):
    content = '<osModel><semaphores name="s" semaphoreType="CountingSemaphore" ownership="true"/></osModel>'
    assert models.migrate("2.2.0", "3.0.0", content) == models.read("3.0.0", content)
