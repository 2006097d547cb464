"""Text of one file as nodes: prefixes are what the file declares them to be, and what is no part of a model is noted."""

from pathlib import Path

import pytest
from migration import model

from amalthea_uros.metamodel.source import FileText
from amalthea_uros.xmi.tree.model_set import Origins
from amalthea_uros.xmi.tree.notes import StepNotes
from amalthea_uros.xmi.tree.parse import parse

_ITEA = "http://www.amalthea.itea2.org/model/1.2.0"


def parsed(text):
    notes = StepNotes()
    found = parse(Path("m.amxmi"), FileText(text), Origins(), notes)
    return found, [f"{note.message}: {note.detail}" for note in notes.all]


def root_of(text):
    found, notes = parsed(text)
    assert notes == []
    return found.tree.root


@pytest.mark.parametrize(
    ("outer", "inner", "expected"),
    [
        (f'xmlns:sw="{_ITEA}/sw"', "", "sw:Label"),
        (f'xmlns:other="{_ITEA}/sw"', 'xsi:type="other:Label"', "sw:Label"),
        ("", f'xmlns:own="{_ITEA}/sw" xsi:type="own:Label"', "sw:Label"),
        # The declaration of the element itself counts, also after another one of the same prefix was used.
        (f'xmlns:own="{_ITEA}/os"', f'xsi:type="own:Label" xmlns:own="{_ITEA}/sw"', "sw:Label"),
        ("", 'xsi:type="am:Label"', "Label"),
    ],
)
def test_the_package_of_a_type_is_that_of_its_prefix(outer, inner, expected):
    inner = inner or 'xsi:type="sw:Label"'
    text = (
        f'<central:AMALTHEA xmlns:central="{_ITEA}/central" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" {outer}>'
        f'<x xsi:type="own:Before"/><x {inner} name="n"/></central:AMALTHEA>'
    )
    before, found = root_of(text).children
    assert found.type == expected
    assert before.type.endswith("Before")
    assert found.attributes == {"name": "n"}


def test_other_prefixes_of_xsi_and_xmi():
    text = model("0.7.2", '<swModel i:id="_1" s:type="am:T"/>').replace("xmlns:xmi", "xmlns:i").replace("xmlns:xsi", "xmlns:s")
    found, notes = parsed(text.replace('xmi:version="2.0"', 'i:version="2.0"'))
    (node,) = found.tree.root.children
    assert (node.type, node.attributes, found.ids, notes) == ("T", {}, {"_1": node}, [])


def test_the_root_can_have_a_type_and_what_looks_like_a_reference():
    root = root_of(model("0.7.2", "").replace("xmi:version", 'href="x" xsi:type="am:T" xmi:version'))
    assert (root.tag, root.type, root.attributes, root.parent) == ("Amalthea", "T", {"href": "x"}, None)


def test_what_is_no_part_of_a_model_is_noted():
    _, notes = parsed(model("0.7.2", '<swModel xmlns:u="u" u:a="1"><u:b><c/></u:b><labels href="x#y"><d/></labels></swModel>'))
    assert notes == [
        "attribute of another namespace: u:a='1'",
        "content of another namespace, or inside a reference: <u:b>",
        "content of another namespace, or inside a reference: <c>",
        "content of another namespace, or inside a reference: <d>",
    ]


def test_nodes_are_in_the_order_of_the_file_with_their_names():
    found, _ = parsed(model("0.7.2", '<swModel><tasks t="Task"><a/></tasks><labels/></swModel>'))
    assert [node.tag for node in found.nodes] == ["Amalthea", "swModel", "tasks", "a", "labels"]
    assert found.tree.names == {"Amalthea", "swModel", "tasks", "a", "labels", "Task", ""}
    assert [node.origin for node in found.nodes] == list(range(5))
