"""Any model that the facts allow is saved and loaded without loss."""

from pathlib import Path
from tempfile import TemporaryDirectory

import strategies
from hypothesis import given
from hypothesis import strategies as st
from strategies import models

import amalthea_uros as amuros
from amalthea_uros import Document, Model
from amalthea_uros.am import Amalthea


def meaning(model):
    version = model.documents[0].facts_version
    return strategies.meaning(*(document.root for document in model.documents), version=version)


def saved(model, path, **options):
    amuros.save(model, path, **options)
    return path.read_bytes()


def reload(model, first, change):
    """The bytes of a saved model, and of the same model loaded, put through a change, and saved again."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.amxmi"
        before = saved(model, path)
        loaded = amuros.load(path)
        first(loaded)
        return before, change(loaded, path)


def nothing(_model):
    pass


@given(model=models())
def test_a_saved_model_is_read_as_the_same_model(model):
    def same(loaded):
        # The names of objects to which nothing refers may be alike.
        assert [f for f in loaded.findings if f.rule != "XMI021"] == []
        assert meaning(loaded) == meaning(model)

    before, after = reload(model, same, saved)
    assert before == after


@given(model=models())
def test_canonical_form_is_that_of_every_saved_model(model):
    before, after = reload(model, nothing, lambda loaded, path: saved(loaded, path, canonical=True))
    assert before == after


@given(model=models())
def test_a_touched_object_that_says_the_same_is_written_as_it_stands(model):
    before, after = reload(model, lambda loaded: loaded.documents[0].changes.modified.update(loaded.walk()), saved)
    assert before == after


def split(model, random, folder):
    """The same content in two files."""
    root = model.root
    second = Amalthea()
    for name, value in list(root.__dict__.items()):
        if name != "custom_properties" and value is not None and random.random() < 0.5:
            setattr(second, name, value)
    version = model.documents[0].version
    return Model(Document(r, version, Path(folder) / f"{name}.amxmi") for name, r in (("a", root), ("b", second)))


@given(model=models(), random=st.randoms(use_true_random=False))
def test_a_rename_reaches_every_reference_also_in_the_sibling_file(model, random):
    with TemporaryDirectory() as folder:
        amuros.save(split(model, random, folder))
        loaded = amuros.load(folder)
        named = [element for element in loaded.walk() if element.is_referable]
        if not named:
            return
        random.choice(named).name = "a new / name"
        amuros.save(loaded)
        again = amuros.load(folder)
        assert [f for f in again.findings if f.rule != "XMI021"] == []
        assert meaning(again) == meaning(loaded)


@given(model=models(), random=st.randoms(use_true_random=False))
def test_an_edited_model_is_saved_as_it_is(model, random):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.amxmi"
        amuros.save(model, path)
        loaded = amuros.load(path)
        for _ in range(3):
            edit(loaded, random)
        amuros.save(loaded, path)
        assert meaning(amuros.load(path)) == meaning(loaded)


def edit(model, random):
    """Reorder or remove parts, unset a value, whatever the random object has."""
    element = random.choice(list(model.walk()))
    features = [name for name, value in element.__dict__.items() if value not in (None, []) and name != "name"]
    if not features:
        return
    name = random.choice(features)
    value = getattr(element, name)
    if isinstance(value, list) and random.random() < 0.5:
        value.reverse()
        return
    gone = value if isinstance(value, list) else [value]
    parts = {part for item in gone if isinstance(item, amuros.Element) and item.container is element for part in item.walk()}
    if not any(reference.holder not in parts for part in parts for reference in model.references_to(part)):
        delattr(element, name)
