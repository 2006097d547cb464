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


@given(model=models())
def test_a_saved_model_is_read_as_the_same_model_and_written_as_it_was(model):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.amxmi"
        before = saved(model, path)
        loaded = amuros.load(path)
        # The names of objects to which nothing refers may be alike.
        assert [f for f in loaded.findings if f.rule != "XMI021"] == []
        assert meaning(loaded) == meaning(model)
        assert saved(loaded, path) == before
        assert saved(loaded, path, canonical=True) == before
        touched = amuros.load(path)
        touched.documents[0].changes.modified.update(touched.walk())
        assert saved(touched, path) == before


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
