"""3.0.0 -> 2.2.0."""

import pytest

from amalthea_uros.xmi.tree.notes import NoteKind


def semaphore(attributes, kept=""):
    value = f'<value t="BooleanObject" value="{kept}"/>'
    content = f'<customProperties key="AMALTHEA 3.0.0: ownership">{value}</customProperties>' if kept else ""
    return f'<osModel><semaphores name="S" maxValue="1" {attributes}>{content}</semaphores></osModel>'


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
