"""3.0.0 -> 2.2.0."""

import pytest

from amalthea_uros.xmi.tree.notes import NoteKind


def semaphore(attributes, kept=""):
    value = f'<value t="BooleanObject" value="{kept}"/>'
    content = f'<customProperties key="AMALTHEA 3.0.0: ownership">{value}</customProperties>' if kept else ""
    return f'<osModel><semaphores name="S" maxValue="1" {attributes}>{content}</semaphores></osModel>'


def test_a_type_that_refers_to_nothing_is_an_error(models):
    content = """<swModel><typeDefinitions t="DataTypeDefinition" name="D"><dataType t="TypeRef"/>
    </typeDefinitions></swModel>"""
    models.migrate("3.0.0", "2.2.0", content)
    assert models.messages(NoteKind.LOST) == ["data type that refers to nothing"]


@pytest.mark.parametrize(
    ("kind", "stated", "kept"),
    [
        ("CountingSemaphore", "false", ""),
        ("CountingSemaphore", "true", "true"),
        ("CountingSemaphore", None, "true"),
        ("Resource", "true", ""),
        ("Resource", None, ""),
        ("Spinlock", "false", "false"),
    ],
)
def test_ownership_is_kept_where_the_type_does_not_say_it(models, kind, stated, kept):
    attributes = f'semaphoreType="{kind}"'
    before = semaphore(attributes + (f' ownership="{stated}"' if stated else ""))
    assert models.migrate("3.0.0", "2.2.0", before) == models.read("2.2.0", semaphore(attributes, kept))
    assert len(models.messages(NoteKind.KEPT)) == bool(kept)
    restored = models.read("3.0.0", semaphore(attributes + (f' ownership="{kept}"' if kept else "")))
    if kept:
        assert models.migrate("2.2.0", "3.0.0", semaphore(attributes, kept)) == restored


def test_a_mutex_is_an_error(models):
    models.migrate("3.0.0", "2.2.0", semaphore('semaphoreType="Mutex"'))
    assert models.messages(NoteKind.LOST) == ["semaphore type Mutex: only AMALTHEA 3.0.0 and later have it"]


def test_a_property_that_was_never_restored_is_an_error(models):
    models.migrate("3.0.0", "2.2.0", semaphore('semaphoreType="Resource"', "false"))
    assert models.messages(NoteKind.LOST) == ["custom property of an earlier migration back that was never restored"]
