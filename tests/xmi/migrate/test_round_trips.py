"""A model that is taken back to an older version and migrated again says the same, or is refused."""

from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
import strategies
from effort import every, examples
from hypothesis import given
from hypothesis import strategies as st
from migration import MAX_SIZE
from support import ROOT, corpus, meaning
from system_strategies import systems

from amalthea_uros import describe
from amalthea_uros.bridge.build import build_model
from amalthea_uros.errors import ReadError, WriteError
from amalthea_uros.metamodel.model import Model
from amalthea_uros.xmi.emf.files import read_text
from amalthea_uros.xmi.emf.references import resolve
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.migrate.chain import migrate
from amalthea_uros.xmi.save import save
from amalthea_uros.xmi.schema import validate
from amalthea_uros.xmi.tree.link import read_set
from amalthea_uros.xmi.tree.notes import NoteKind, StepNotes
from amalthea_uros.xmi.tree.results import read_trees

SAMPLES = sorted((ROOT / "samples").glob("*.yaml"))
OLDER = ("2.2.0", "2.0.0", "1.2.0")

#: Content that the version does not know.
UNKNOWN = {"XMI010", "XMI011", "XMI012", "XMI013", "XMI014"}


def taken(path, version):
    """The model of a file in another version, and what was lost."""
    notes = StepNotes()
    models = read_set([(path, read_text(path))], MAX_SIZE, notes)
    migrate(models, version, notes)
    results, linked = read_trees(models, [version])
    model = Model(result.document for result in results)
    model.findings = tuple(resolve(results, linked))
    lost = [note for note in notes.all if note.kind is NoteKind.LOST]
    unknown = [finding for result in results for finding in result.findings if finding.rule in UNKNOWN]
    return model, [*lost, *unknown]


def there_and_back(path, version):
    """Whether a model came back; it says the same then."""
    source = load(path)
    older, refused = taken(path, version)
    if refused:
        return False
    between = path.with_name("older.amxmi")
    try:
        save(older, between, canonical=True)
    except WriteError:
        return False
    back, lost = taken(between, source.documents[0].version)
    assert lost == []
    assert meaning(back) == meaning(source)
    return True


@pytest.mark.parametrize(
    ("sample", "version"), every(2, list(product(SAMPLES, OLDER))), ids=lambda value: getattr(value, "stem", value)
)
def test_a_sample_comes_back(sample, version, tmp_path):
    path = tmp_path / "model.amxmi"
    save(build_model(describe(sample).system), path)
    assert there_and_back(path, version)
    assert validate((tmp_path / "older.amxmi").read_bytes(), version) == []


@given(model=strategies.models(versions=("3.0.0", "3.3.0")), version=st.sampled_from(OLDER))
@examples(8)
def test_a_random_model_comes_back_or_is_refused(model, version):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.amxmi"
        save(model, path)
        there_and_back(path, version)


@given(system=systems(most=1), version=st.sampled_from(OLDER))
@examples(8)
def test_a_random_system_comes_back_or_is_refused(system, version):
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.amxmi"
        save(build_model(system), path)
        there_and_back(path, version)


@pytest.mark.parametrize("path", corpus())
def test_a_published_model_comes_back_or_is_refused(path, tmp_path):
    try:
        declared = load(path).documents[0].version
    except ReadError:
        return
    copy = tmp_path / "model.amxmi"
    copy.write_bytes(path.read_bytes())
    for version in OLDER:
        if tuple(map(int, version.split("."))) < tuple(map(int, declared.split("."))):
            there_and_back(copy, version)
