"""Whoever reads many models in one process keeps none of them."""

import gc
from weakref import ref

import pytest

from amalthea_uros._internal import garbage
from amalthea_uros._internal.garbage import paused_garbage_collection


class Knot:
    """Something that only the garbage collection frees."""

    def __init__(self):
        self.itself = self


def made(count):
    """A reference to the first one of some objects that nothing else refers to."""
    with paused_garbage_collection():
        knots = [Knot() for _ in range(count)]
        return ref(knots[0])


@pytest.fixture
def few_objects(monkeypatch):
    gc.collect()  # what other tests have left
    threshold = gc.get_threshold()
    gc.set_threshold(10)
    monkeypatch.setattr(garbage, "FEW_OBJECTS", 1000)
    monkeypatch.setattr(garbage._Collected, "left", len(gc.get_objects()))
    monkeypatch.setattr(garbage._Collected, "made", 0)
    yield
    gc.set_threshold(*threshold)


@pytest.mark.usefixtures("few_objects")
def test_garbage_is_collected_once_there_is_a_quarter_more_than_is_in_use():
    first, before = made(1), garbage._Collected.left
    with paused_garbage_collection():
        many = [[] for _ in range(before)]
    left = garbage._Collected.left
    assert first() is None
    assert left > 1.5 * before
    with paused_garbage_collection():
        many += [[] for _ in range(before // 4)]
    assert garbage._Collected.left == left


@pytest.mark.usefixtures("few_objects")
@pytest.mark.parametrize(("frozen", "is_collected"), [(375, True), (100_000, False)], ids=["by Python 3.12", "by the process"])
def test_objects_that_a_process_has_frozen_stay_so(monkeypatch, frozen, is_collected):
    monkeypatch.setattr(garbage.gc, "get_freeze_count", lambda: frozen)
    before = garbage._Collected.left
    with paused_garbage_collection():
        many = [[] for _ in range(before)]
    assert many
    assert (garbage._Collected.left != before) == is_collected
