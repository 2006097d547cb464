"""Files that people and other tools laid out stay as they are, except for what was changed."""

import re
from collections import Counter

import pytest
from effort import examples
from hypothesis import assume, given
from hypothesis import strategies as st
from scrambler import ENCODINGS, Scrambler
from strategies import Builder, as_list, concrete, meaning, models, parse, stored_features, value_for

from amalthea_uros import load, save
from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import supported_versions
from amalthea_uros.xmi.emf.writer import document_text

MARK = re.compile(r"mark\d+\.")


def text_of(model) -> str:
    (document,) = model.documents
    return document_text(document)


@st.composite
def scrambled(draw, size: int = 15):
    """A loaded model whose file is ugly."""
    model = draw(models(size))
    rng = draw(st.randoms(use_true_random=False))
    (document,) = model.documents
    text = Scrambler(rng, document.version).text(document_text(document))
    if rng.random() < 0.2:
        text = text.replace("\n", "\r\n")
    return parse(text), model, rng


def said(model) -> object:
    (document,) = model.documents
    return meaning(document.root, version=document.version)


@examples(12)
@given(scrambled())
def test_an_ugly_file_says_the_same_also_in_canonical_form_and_stays_as_it_is(case):
    loaded, model, _ = case
    assert said(loaded) == said(model)
    canonical = document_text(loaded.documents[0], canonical=True)
    again = parse(canonical)
    assert said(again) == said(model)
    assert document_text(again.documents[0], canonical=True) == canonical
    loaded.documents[0].changes.modified.update(loaded.walk())
    assert text_of(loaded) == loaded.documents[0].source.text


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@examples(4)
@given(rng=st.randoms(use_true_random=False))
def test_saving_unchanged_gives_the_same_bytes(encoding, newline, rng, tmp_path_factory):
    path = tmp_path_factory.mktemp("model") / "ugly.amxmi"
    model = Builder(rng, rng.choice(supported_versions()), 15).model()
    declared, codec = ENCODINGS[encoding]
    scrambler = Scrambler(rng, model.documents[0].version, is_ascii=True)
    text = scrambler.text(text_of(model), f'<?xml version="1.0" encoding="{declared}" ?>\n').replace("\n", newline)
    path.write_bytes(text.encode(codec, "xmlcharrefreplace"))
    before = path.read_bytes()
    loaded = load(path)
    assert said(loaded) == said(model)
    save(loaded)
    assert path.read_bytes() == before
    loaded.documents[0].changes.modified.update(loaded.walk())
    save(loaded)
    assert path.read_bytes() == before


# Edits: each changes one thing, and tells the objects whose tags and whose children it may change


class Editor:
    def __init__(self, model, rng) -> None:
        self.model = model
        self.rng = rng
        (self.document,) = model.documents
        self.version = self.document.version
        self.tags: set = set()
        self.contents: set = set()

    def edit(self) -> None:
        edits = [self.set_attribute, self.unset_attribute, self.add, self.remove, self.move, self.refer, self.rename]
        self.rng.choice(edits)()

    def features(self, element, *kinds):
        return [(n, f) for n, f in stored_features(self.version, type(element).__name__) if f.kind in kinds]

    def places(self, *kinds):
        """Every (object, feature) of some kinds."""
        return [(e, name, fact) for e in self.model.walk() for name, fact in self.features(e, *kinds)]

    def choice(self, items):
        assume(items)
        return self.rng.choice(items)

    def set_attribute(self) -> None:
        element, name, fact = self.choice(self.places(FeatureKind.ATTRIBUTE))
        setattr(element, name, value_for(self.rng, self.version, name, fact))
        self.tags.add(element)

    def unset_attribute(self) -> None:
        places = [(e, n) for e, n, _ in self.places(FeatureKind.ATTRIBUTE) if getattr(e, n) is not None]
        element, name = self.choice(places)
        delattr(element, name)
        self.tags.add(element)

    def rename(self) -> None:
        element = self.choice([e for e in self.model.walk() if hasattr(e, "name")])
        element.name = f"{self.rng.choice(['new', 'a/b', 'ü?=&+', ' '])}{id(element)}"
        self.tags.add(element)

    def add(self) -> None:
        element, name, fact = self.choice(self.places(FeatureKind.CONTAINMENT))
        feature = features_of(type(element))[name]
        if not fact.many:
            assume(not as_list(getattr(element, name)))
        builder = Builder(self.rng, self.version, 3)
        part = builder.element(self.choice(concrete(self.version, fact.type)), 5)
        self.contents.add(element)
        self.put(element, feature, part)

    def put(self, element, feature, part) -> None:
        if feature.many:
            held = getattr(element, feature.name)
            held.insert(self.rng.randint(0, len(held)), part)
        else:
            setattr(element, feature.name, part)

    def parts(self):
        return [e for e in self.model.walk() if e.container is not None]

    def remove(self) -> None:
        part = self.choice(self.parts())
        inside = set(part.walk())
        users = [use.holder for target in inside for use in self.model.references_to(target)]
        assume(all(user in inside for user in users))
        self.contents.add(part.container)
        self.take_out(part)

    def take_out(self, part) -> None:
        holder = part.container
        for name, _ in self.features(holder, FeatureKind.CONTAINMENT):
            held = getattr(holder, name)
            if held is part:
                setattr(holder, name, None)
            elif isinstance(held, list) and any(p is part for p in held):
                held.remove(part)

    def move(self) -> None:
        part = self.choice(self.parts())
        inside = set(part.walk())
        places = [
            (holder, name)
            for holder, name, fact in self.places(FeatureKind.CONTAINMENT)
            if holder not in inside
            and isinstance(part, getattr(classes, fact.type))
            and (fact.many or not as_list(getattr(holder, name)))
        ]
        holder, name = self.choice(places)
        self.contents |= {part.container, holder}
        self.tags.add(part)
        self.put(holder, features_of(type(holder))[name], part)

    def refer(self) -> None:
        element, name, fact = self.choice(self.places(FeatureKind.REFERENCE))
        targets = [e for e in self.model.walk() if e.is_referable and isinstance(e, getattr(classes, fact.type))]
        chosen = [self.rng.choice(targets) for _ in range(self.rng.randint(0, 3 if fact.many else 1))] if targets else []
        self.tags.add(element)
        setattr(element, name, chosen if features_of(type(element))[name].many else (chosen or [None])[0])


def targets_of(version, element):
    for name, fact in stored_features(version, type(element).__name__):
        if fact.kind is FeatureKind.REFERENCE:
            yield from as_list(getattr(element, name))


def is_unambiguous(model, version) -> bool:
    """Whether every reference has one possible target."""
    names = Counter(e.unique_name for e in model.walk() if e.is_referable)
    return all(names[target.unique_name] == 1 for e in model.walk() for target in targets_of(version, e))


def unique_names(model):
    return {e: e.unique_name for e in model.walk() if e.is_referable}


def start_tag(source, element) -> str:
    text = source.text[source.starts[source.index[element]] :]
    return re.match(r"""<(?:[^>"']|"[^"]*"|'[^']*')*>""", text)[0].rstrip("/>").rstrip()


def span(source, element) -> tuple[int, int]:
    place = source.index[element]
    start = source.starts[place]
    return start, source.content.end(start).element


def between(source, element) -> str:
    """The text of an element behind its start tag without its parts."""
    start, end = span(source, element)
    found, at = [], start + len(start_tag(source, element))
    for part_start, part_end in sorted(span(source, part) for part in element.contents()):
        found.append(source.text[at:part_start])
        at = part_end
    return "|".join([*found, source.text[at:end]])


def check_edit(loaded, rng) -> None:
    (document,) = loaded.documents
    source, version = document.source, document.version
    names, marks = unique_names(loaded), MARK.findall(source.text)
    before = {e: (start_tag(source, e), between(source, e)) for e in loaded.walk()}
    editor = Editor(loaded, rng)
    editor.edit()
    assume(is_unambiguous(loaded, version))
    renamed = {e for e, name in unique_names(loaded).items() if names.get(e) != name}
    editor.tags |= renamed | {e for e in loaded.walk() if any(t in renamed for t in targets_of(version, e))}

    if "XMLSchema-instance" not in source.text:
        editor.tags.add(document.root)  # for the sake of an xsi:type somewhere

    again = parse(text_of(loaded))
    assert said(again) == said(loaded)
    new_source = again.documents[0].source
    for old, new in zip(loaded.walk(), again.walk(), strict=True):
        if old in before:
            tag, rest = before[old]
            assert old in editor.tags or start_tag(new_source, new) == tag
            assert old in editor.contents | editor.tags or between(new_source, new) == rest
    gone = [mark for e in before.keys() - set(loaded.walk()) for mark in MARK.findall(source.text[slice(*span(source, e))])]
    assert sorted(set(marks) - set(gone)) == sorted(MARK.findall(new_source.text))


@examples(20)
@given(scrambled())
def test_an_edit_changes_what_was_edited_and_nothing_else(case):
    loaded, _, rng = case
    check_edit(loaded, rng)


# What the above found, in small

HEAD = (
    '<am:Amalthea xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">'
)


def test_a_new_child_stands_before_its_next_sibling_also_where_features_have_another_order():
    model = parse(
        f'{HEAD}\n<swModel>\n  <runnables name="r"/>\n  <tasks name="t"/>\n  <isrs name="i"/>\n</swModel>\n</am:Amalthea>'
    )
    sw = model.root.sw_model
    sw.tasks.insert(0, classes.Task(name="first"))
    sw.runnables.insert(0, classes.Runnable(name="first"))
    again = parse(text_of(model))
    assert [task.name for task in again.root.sw_model.tasks] == ["first", "t"]
    assert [runnable.name for runnable in again.root.sw_model.runnables] == ["first", "r"]


@pytest.mark.parametrize(("old", "new"), [("0.0", -0.0), ("-0.0", 0.0)])
def test_the_sign_of_zero_is_not_lost(old, new):
    model = parse(f'{HEAD}<customProperties><value xsi:type="am:DoubleObject" value="{old}"/></customProperties></am:Amalthea>')
    model.root.custom_properties[0].value.value = new
    assert f'value="{new}"' in text_of(model)


def test_a_mandatory_number_that_is_not_stated_is_not_written():
    model = parse(f'{HEAD}<customProperties><value xsi:type="am:DoubleObject" value="1.0"/></customProperties></am:Amalthea>')
    model.root.custom_properties[0].value.value = None
    assert '<value xsi:type="am:DoubleObject"/>' in text_of(model)
