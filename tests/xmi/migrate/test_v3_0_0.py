"""Switches, data types, interfaces and semaphores of 3.0.0."""

import pytest
from migration import migrated

from amalthea_uros.xmi.tree.node import all_below


def software(content):
    return f'<swModel>{content}<typeDefinitions t="BaseTypeDefinition" name="u 8"/></swModel>'


ARRAY = """<{0} t="Array" numberElements="{1}">
  <dataType t="TypeRef" typeDef="u+8?type=BaseTypeDefinition"/></{0}>"""


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


@pytest.mark.parametrize("version", ["2.2.0", "3.0.0", "3.1.0"])
def test_switches_of_isrs_and_runnables_also_in_snapshots(models, version):
    text = """<swModel><isrs name="I"><activityGraph><items t="{0}"><entries name="e"><condition>
        <entries t="{1}"/></condition><items t="{0}"/></entries></items></activityGraph></isrs>
      <runnables name="R"><activityGraph><items t="{0}"/></activityGraph></runnables></swModel>"""
    before = text.format("ModeSwitch", "ModeConditionConjunction")
    assert models.migrate(version, "3.2.0", before) == models.read("3.2.0", text.format("Switch", "ConditionConjunction"))
