import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
from lxml import etree
from synthetic import main, synthetic_folder, synthetic_model

from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind
from amalthea_uros.metamodel.versions import VersionFacts, facts

XMI_ID = "{http://www.omg.org/XMI}id"
XSI_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
VERSIONS = ["2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0"]
SIZE = 4000


class Node(NamedTuple):
    element: etree._Element
    cls: str
    declared: str
    features: dict[str, FeatureFact]

    def references(self) -> Iterator[tuple[FeatureFact, str]]:
        for name, fact in self.features.items():
            if fact.kind is FeatureKind.REFERENCE:
                yield from ((fact, target) for target in self.element.get(name, "").split())
                for child in self.element.findall(name):
                    yield fact, child.get("href").removeprefix("amlt:/#")


def parse(text: str) -> etree._Element:
    return etree.fromstring(text.encode())


def nodes(root: etree._Element, known: VersionFacts) -> Iterator[Node]:
    def walk(element: etree._Element, declared: str) -> Iterator[Node]:
        cls = element.get(XSI_TYPE, f"am:{declared}").removeprefix("am:")
        features = {fact.name: fact for fact in known.features(cls)}
        yield Node(element, cls, declared, features)
        for child in element:
            if child.get("href") is None:
                yield from walk(child, features[child.tag].type)

    return walk(root, etree.QName(root).localname)


@pytest.fixture(scope="module", params=VERSIONS)
def known(request) -> VersionFacts:
    return facts(request.param)


@pytest.fixture(scope="module")
def model(known) -> list[Node]:
    return list(nodes(parse(synthetic_model(SIZE, known.version)), known))


@pytest.fixture(scope="module")
def folder() -> dict[str, list[Node]]:
    return {name: list(nodes(parse(text), facts("3.3.0"))) for name, text in synthetic_folder(SIZE).items()}


@cache
def instances(known_version: str, cls: str) -> frozenset[str]:
    return frozenset(facts(known_version).concrete_subtypes(cls))


def ids(found: list[Node]) -> Counter[str]:
    return Counter(node.element.get(XMI_ID) for node in found if node.element.get(XMI_ID))


@pytest.mark.parametrize("elements", [100, 999, 1000, 1001, 5000])
def test_has_as_many_elements_as_asked_for(elements):
    assert sum(1 for _ in parse(synthetic_model(elements)).iter()) == elements


def test_references_grow_with_the_elements():
    small, large = (
        sum(1 for node in nodes(parse(synthetic_model(size)), facts("3.3.0")) for _ in node.references())
        for size in (5000, 20000)
    )
    assert 0.25 * 5000 < small < 0.4 * 5000
    assert 0.25 * 20000 < large < 0.4 * 20000


def test_same_seed_gives_the_same_text():
    assert synthetic_model(SIZE, seed=3) == synthetic_model(SIZE, seed=3)
    assert synthetic_model(SIZE, seed=3) != synthetic_model(SIZE, seed=4)


@pytest.mark.parametrize("version", ["1.2.0", "0.9.7", "9.9.9"])
def test_refuses_versions_it_does_not_know(version):
    with pytest.raises(ValueError, match=version):
        synthetic_model(100, version)


def test_layout_is_that_of_emf():
    text = synthetic_model(SIZE)
    assert text.startswith(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
        ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">\n'
        "  <customProperties"
    )
    assert text.endswith("</am:Amalthea>\n")
    assert "\r" not in text
    assert "\t" not in text
    for line in text.splitlines()[1:]:
        assert (len(line) - len(line.lstrip(" "))) % 2 == 0
        assert line.endswith(">")
        assert line.count("<") == 1


def test_attributes_stand_in_the_order_of_the_features(model):
    for node in model[1:]:
        plain = [name for name in node.element.attrib if not name.startswith("{")]
        assert plain == [name for name in node.features if name in plain]
        assert list(node.element.attrib) == [n for n in (XSI_TYPE, XMI_ID) if n in node.element.attrib] + plain


def test_children_stand_in_the_order_of_the_features(model):
    for node in model:
        order = list(node.features)
        positions = [order.index(child.tag) for child in node.element]
        assert positions == sorted(positions)


def test_only_stored_features_are_written(model):
    for node in model:
        for name in [*(n for n in node.element.attrib if not n.startswith("{")), *(child.tag for child in node.element)]:
            assert not node.features[name].derived
            assert not node.features[name].readonly
        singles = {name for name, fact in node.features.items() if not fact.many}
        assert all(count == 1 for tag, count in Counter(c.tag for c in node.element).items() if tag in singles)


def test_type_is_written_where_it_differs_from_the_declared_one(model, known):
    for node in model:
        assert not known.classes[node.cls].abstract
        assert node.cls in instances(known.version, node.declared)
        assert (XSI_TYPE in node.element.attrib) == (node.cls != node.declared)


def test_defaults_with_a_literal_are_written(model):
    for node in model:
        with_literal = {
            name for name, fact in node.features.items() if fact.kind is FeatureKind.ATTRIBUTE and fact.default is not None
        }
        assert with_literal <= set(node.element.attrib)


def test_required_features_are_there(model):
    for node in model:
        present = {*node.element.attrib, *(child.tag for child in node.element)}
        assert {name for name, fact in node.features.items() if fact.required and fact.stored} <= present


def test_values_are_of_the_declared_type(model, known):
    for node in model:
        for name, fact in node.features.items():
            value = node.element.get(name)
            if value is not None and fact.kind is FeatureKind.ATTRIBUTE:
                assert re.fullmatch(written_as(fact, known), value), (node.cls, name, value)


def written_as(fact: FeatureFact, known: VersionFacts) -> str:
    """The pattern of the values of an attribute."""
    if fact.type in known.enums:
        _, *others = known.enums[fact.type].literals
        return "|".join(others)
    java_type = known.numbers[fact.type].java_type if fact.type in known.numbers else fact.type
    if fact.type == "Address":
        return "0x(0|[1-9a-f][0-9a-f]*)"
    sign = "" if fact.type in known.numbers else "-?"
    return {
        "EString": "(?s).*",
        "EBoolean": "true|false",
        **dict.fromkeys(["EFloat", "EDouble", "EDoubleObject", "double"], sign + r"\d+\.\d+(E-?\d+)?"),
    }.get(java_type, sign + r"\d+")


def test_every_referable_object_has_the_id_of_its_name_and_class(model, known):
    for node in model:
        identifier = node.element.get(XMI_ID)
        assert (identifier is not None) == (node.cls in instances(known.version, "IReferable"))
        if identifier is not None:
            assert identifier.endswith(f"?type={node.cls}")


def test_ids_are_encoded_as_java_does():
    text = synthetic_model(SIZE)
    assert 'xmi:id="Task+7+%28left%2Fright%29?type=Task" name="Task 7 (left/right)"' in text
    assert 'xmi:id="Label_5%3A+Gr%C3%B6%C3%9Fe+%26+%3CLage%3E?type=Label" name="Label_5: Größe &amp; &lt;Lage>"' in text


def test_ids_of_contained_objects_begin_with_their_owner():
    found = ids(list(nodes(parse(synthetic_model(SIZE)), facts("3.3.0"))))
    assert found["Vehicle+mode/off?type=ModeLiteral"] == 1
    assert found["Core+0.0/Core+0.0+to+ECU_0+crossbar?type=HwPort"] == 1
    assert found["ECU_0+chip/Core+0.0+to+ECU_0+crossbar?type=HwConnection"] == 1
    assert found["Instructions/IPC_0.8?type=HwFeature"] == 1
    assert any(identifier.startswith(("engine/Label", "body+control/Label")) for identifier in found)


def test_every_reference_resolves_to_one_object_of_the_declared_type(model, known):
    found = ids(model)
    targets = [(fact, target) for node in model for fact, target in node.references()]
    assert targets
    for fact, target in targets:
        assert found[target] == 1
        assert target.rpartition("?type=")[2] in instances(known.version, fact.type)


def test_references_inside_one_file_are_attributes(model):
    assert all(node.element.get("href") is None for node in model)
    assert not any(child.get("href") for node in model for child in node.element)


def test_has_objects_of_many_classes():
    known = facts("3.3.0")
    classes = {node.cls for node in nodes(parse(synthetic_model(40000)), known)}
    assert len(classes) > 110
    assert len([cls for cls in known.concrete_subtypes("Stimulus") if cls in classes]) >= 9


def test_folder_resolves_across_files(folder):
    everywhere = sum((ids(found) for found in folder.values()), Counter())
    known = facts("3.3.0")
    crossing = 0
    for found in folder.values():
        here = ids(found)
        for node in found:
            for fact, target in node.references():
                assert everywhere[target] == 1
                child = next((c for c in node.element.findall(fact.name) if c.get("href") == f"amlt:/#{target}"), None)
                if child is not None:
                    assert (child.get(XSI_TYPE) is not None) == known.classes[fact.type].abstract
                    crossing += target not in here
                else:
                    assert target in here
    assert crossing > 100


def test_folder_writes_a_feature_as_attribute_or_as_children(folder):
    for found in folder.values():
        here = ids(found)
        for node in found:
            for name, fact in node.features.items():
                children = node.element.findall(name) if fact.kind is FeatureKind.REFERENCE else []
                assert not (children and name in node.element.attrib)
                assert not children or any(child.get("href").removeprefix("amlt:/#") not in here for child in children)


def test_folder_has_as_many_objects_as_asked_for(folder):
    assert list(folder) == ["platform.amxmi", "applications_1.amxmi", "applications_2.amxmi", "applications_3.amxmi"]
    assert sum(len(found) for found in folder.values()) == SIZE
    assert all(len(found) > 100 for found in folder.values())


def test_command_writes_the_file(tmp_path, monkeypatch):
    target = tmp_path / "model.amxmi"
    monkeypatch.setattr(sys, "argv", ["synthetic.py", "--elements", "500", "--version", "2.2.0", "-o", str(target)])
    main()
    assert target.read_bytes().decode() == synthetic_model(500, "2.2.0")


def test_script_runs_from_any_folder(tmp_path):
    script = Path(__file__).parents[2] / "benchmarks" / "synthetic.py"
    root = {"PYTHONPATH": str(script.parents[1])}
    subprocess.run([sys.executable, script, "--elements", "200", "-o", "x.amxmi"], check=True, cwd=tmp_path, env=root)
    assert (tmp_path / "x.amxmi").read_bytes().count(b"\n") > 200
