"""What a model does not know is written again so that everything is read as before, and what would not be is not written."""

import re

import pytest
from effort import every, examples
from hypothesis import given
from hypothesis import strategies as st
from scrambler import Scrambler
from strategies import meaning, models, parse
from support import MODEL, corpus, hand_written

from amalthea_uros import load, save
from amalthea_uros.am import Label, PeriodicStimulus, Task, Time
from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.element import extras_of
from amalthea_uros.metamodel.features import containments_of
from amalthea_uros.metamodel.tags import ElementEnd, attributes_of_tag
from amalthea_uros.xmi.emf.escape import unescape
from amalthea_uros.xmi.emf.source_merger import SourceMerger
from amalthea_uros.xmi.emf.writer import document_text

AMALTHEA = "http://app4mc.eclipse.org/amalthea/3.3.0"
XSI = "http://www.w3.org/2001/XMLSchema-instance"
XMI = "http://www.omg.org/XMI"


def root(content, prefix="am", **namespaces):
    declared = {prefix: AMALTHEA} | namespaces
    spaces = "".join(f' xmlns:{name}="{uri}"' for name, uri in declared.items())
    return f'<{prefix}:Amalthea xmi:version="2.0" xmlns:xmi="{XMI}"{spaces}>{content}</{prefix}:Amalthea>'


def canonical(text):
    return document_text(parse(text).documents[0], canonical=True)


def said(model):
    return meaning(model.documents[0].root, version=model.documents[0].version)


def stimulus(*content):
    return MODEL.format(
        f'<stimuliModel><stimuli xsi:type="am:PeriodicStimulus" name="S">{"".join(content)}</stimuli></stimuliModel>'
    )


def allocation(content):
    return root(f"<mappingModel><taskAllocation>{content}</taskAllocation></mappingModel>")


FIRST, SECOND = '<recurrence value="1" unit="ms"/>', '<recurrence value="5" unit="ms"/>'
PROPERTY = '<customProperties key="k"><value xsi:type="am:StringObject" value="v"/></customProperties>'

KEPT = {
    "a type that only unknown content has": root('<swModel><unknown xsi:type="am:Foo"/></swModel>', xsi=XSI),
    "unknown attributes with a prefix": root('<swModel x:a="1"/>', x="urn:x"),
    "an unknown element with the prefix of the model": root("<x:extra/>", "x"),
    "another prefix of XMI, too": root('<swModel><labels name="L"/><unknown m:id="1"/></swModel>', m=XMI),
    "another prefix of types, too": root('<swModel><unknown i:type="am:Foo"/></swModel>', i=XSI),
    "am for something else": root("<swModel><am:extra/></swModel>", "x", am="urn:other"),
    "am for something else that is not used": root("<swModel/>", "x", am="urn:other"),
    "a second value before what is written first": stimulus(FIRST, SECOND, PROPERTY),
    "a second value, and a comment": stimulus("<!-- a -->", FIRST, SECOND, "<!-- b -->", PROPERTY),
    "a reference inside a reference": allocation('<task href="amlt:/#A?type=Task"><task href="amlt:/#B?type=Task"/></task>'),
    "the same for one of several": allocation(
        '<affinity href="amlt:/#A?type=ProcessingUnit"><affinity href="amlt:/#B?type=ProcessingUnit"/><!-- c --></affinity>'
    ),
    "a reference with another attribute": allocation('<task href="amlt:/#A?type=Task" more="1"/>'),
    "an empty attribute and an element": allocation('<task href="amlt:/#A?type=Task"/>').replace(
        "<taskAllocation", '<taskAllocation task=""'
    ),
    "a text that is longer than a buffer": root("<swModel>" + "word " * 4_000 + "</swModel>"),
    "the end of a character data section as text": root("<swModel>a ]]&gt; b</swModel>"),
    "a carriage return in a text": root("<swModel>a&#xD;b</swModel>"),
    "a text of blanks that are none of XML": root("<swModel>\u00a0</swModel>"),
    "a value that speaks of types": root('<swModel><labels name="L" description="like xsi:type"/></swModel>'),
    "a comment that speaks of types": root('<!-- <a xsi:type="b"/> --><swModel/>'),
}


@pytest.mark.parametrize("text", KEPT.values(), ids=KEPT)
def test_the_canonical_form_says_the_same_and_is_a_fixed_point(text):
    model = parse(text)
    once = canonical(text)
    again = parse(once)
    assert said(again) == said(model)
    assert sorted(f.rule for f in again.findings) == sorted(f.rule for f in model.findings)
    assert canonical(once) == once


def test_the_first_of_two_values_stays_the_one_that_counts():
    (found,) = parse(canonical(stimulus(FIRST, SECOND, PROPERTY))).all(PeriodicStimulus)
    assert found.recurrence.value == 1


def test_namespaces_that_nothing_needs_are_not_written():
    assert canonical(root("<swModel/>", "m", i=XSI, x="urn:x")) == canonical(root("<swModel/>"))


def test_a_type_without_namespace_is_refused_with_what_to_add():
    with pytest.raises(Exception, match="undeclared namespace prefix 'xsi'"):
        parse(root('<stimuliModel><stimuli xsi:type="am:PeriodicStimulus"/></stimuliModel>'))


class Hostile(Scrambler):
    """A way of writing in which unknown content also has prefixes, known names and texts."""

    def text(self, canonical, *declaration):
        self.has_types = "xmlns:xsi" in canonical
        return super().text(canonical, *declaration)

    def noise(self):
        if not self.has_types or not self.chance(0.15):
            return super().noise()
        i, m, x = self.prefixes["xsi"], self.prefixes["am"], self.prefixes["xmi"]
        return [
            self.rng.choice(
                [
                    f'<unknown {i}:type="{m}:Foo"/>',
                    f'<{m}:extra {x}:id="{self.number()}"/>',
                    f"text {self.number()} ]]&gt; &lt;",
                    "<![CDATA[ <x> ]]>",
                    '<tags href="amlt:/#none?type=Tag" more="1"><tags/></tags>',
                    '<recurrence unknown="1"><recurrence/></recurrence>',
                    "<!-- xsi:type -->",
                ]
            )
        ]


@examples(16)
@given(model=models(12), rng=st.randoms(use_true_random=False))
def test_the_canonical_form_of_any_file_is_a_fixed_point(model, rng):
    document = model.documents[0]
    text = Hostile(rng, document.version).text(document_text(document))
    once = canonical(text)
    assert canonical(once) == once
    assert said(parse(once)) == said(parse(text))


@examples(16)
@given(model=models(12), rng=st.randoms(use_true_random=False))
def test_each_object_is_found_where_it_stands(model, rng):
    document = model.documents[0]
    source = parse(Hostile(rng, document.version).text(document_text(document))).documents[0].source
    for element, start in zip(source.elements, source.starts, strict=True):
        assert is_at(element, source.text, start)


def is_at(element, text, start) -> bool:
    """Whether the tag at an offset is that of an object."""
    attributes = {each["name"]: unescape(each["quoted"][1:-1]) for each in attributes_of_tag(text, start)}
    tag = re.match(r"<([^\s/>]+)", text[start:])[1]
    holder = element.container
    if holder is None:
        return tag.endswith(":Amalthea")
    names = {feature.xml_name for feature in containments_of(type(holder)) if holds(holder.__dict__.get(feature.name), element)}
    return tag in names and attributes.get("name") == element.__dict__.get("name", attributes.get("name"))


def holds(value, element) -> bool:
    return value is element or (isinstance(value, list) and any(part is element for part in value))


@pytest.mark.parametrize("path", every(5, hand_written()[:40]) + corpus("jdom")[:10])
def test_the_canonical_form_of_published_models_is_a_fixed_point(path):
    once = document_text(load(path).documents[0], canonical=True)
    assert canonical(once) == once


def test_a_new_value_gets_before_an_unknown_one_of_the_same_name():
    model = parse(stimulus(PROPERTY.replace('"k"', '"a"'), FIRST, SECOND, PROPERTY))
    (found,) = model.all(PeriodicStimulus)
    found.recurrence = Time(2, "ms")
    (again,) = parse(document_text(model.documents[0])).all(PeriodicStimulus)
    assert again.recurrence.value == 2


def test_unknown_content_takes_its_namespace_to_another_file(tmp_path):
    (tmp_path / "a.amxmi").write_text(root('<swModel><tasks name="T"><x:extra/></tasks></swModel>', x="urn:x"))
    (tmp_path / "b.amxmi").write_text(root('<swModel><tasks name="U"/></swModel>'))
    model = load(tmp_path)
    first, second = (document.root.sw_model for document in model.documents)
    second.tasks.append(first.tasks[0])
    assert 'xmlns:x="urn:x"' in document_text(model.documents[1])


class TestReadingBack:
    """A text that would be read as another model is not written."""

    def test_a_value_that_was_removed_while_a_second_one_is_kept(self, tmp_path):
        path = tmp_path / "m.amxmi"
        path.write_text(stimulus(FIRST, SECOND))
        model = load(path)
        model[PeriodicStimulus, "S"].recurrence = None
        with pytest.raises(WriteError) as caught:
            save(model)
        (finding,) = caught.value.findings
        assert finding.rule == "XMI106"
        assert "'recurrence'" in finding.message
        assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [("m.amxmi", stimulus(FIRST, SECOND))]

    @pytest.mark.parametrize("raw", ["<open>", "<tasks name='x'/>"])
    @pytest.mark.parametrize("is_canonical", [True, False])
    def test_content_that_programs_made_of_something_wrong(self, raw, is_canonical):
        model = parse(root('<swModel><tasks name="T"/></swModel>'))
        (task,) = model.all(Task)
        extras_of(task.container).content.append((None, raw))
        task.name = "U"
        with pytest.raises(WriteError, match="XMI106"):
            document_text(model.documents[0], canonical=is_canonical)

    def test_a_change_in_an_object_that_is_not_noted_as_modified_is_not_lost(self):
        model = parse(root('<swModel><tasks name="T"/><labels name="L"/></swModel>'))
        (document,) = model.documents
        (task,) = model.all(Task)
        task.name = "U"
        document.changes.modified.discard(task.container)
        assert '<tasks name="U"/><labels name="L"/>' in document_text(document)

    @pytest.mark.parametrize("beyond", [-1, len("</labels>"), len('</labels><tasks name="T"/>')])
    def test_an_untouched_object_that_would_not_be_copied_as_a_whole(self, monkeypatch, beyond):
        """Its text would end before or after its own end."""
        model = parse(root('<swModel><labels name="L"><size value="1" unit="bit"/></labels><tasks name="T"/></swModel>'))
        (document,) = model.documents
        (label,) = model.all(Label)
        place = document.source.index[label]
        usual = SourceMerger.end

        def other_end(merger, at):
            content, element = usual(merger, at)
            return ElementEnd(content, element + (beyond if at == place else 0))

        monkeypatch.setattr(SourceMerger, "end", other_end)
        model.documents[0].root.sw_model.tasks[0].name = "U"
        with pytest.raises(WriteError, match="XMI106"):
            document_text(document)
