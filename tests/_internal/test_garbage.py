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


def made():
    with paused_garbage_collection():
        return ref(Knot())


@pytest.fixture
def few_objects(monkeypatch):
    gc.collect()
    monkeypatch.setattr(garbage, "FEW_OBJECTS", len(gc.get_objects()) + 1000)
    monkeypatch.setattr(garbage._Collected, "objects", 0)


@pytest.mark.usefixtures("few_objects")
def test_garbage_is_collected_once_there_is_much_of_it():
    kept = made()
    others = [made() for _ in range(2000)]
    assert kept() is None
    assert sum(each() is not None for each in others) < len(others)


@pytest.mark.usefixtures("few_objects")
def test_what_is_in_use_is_not_scanned_again_until_it_has_doubled():
    with paused_garbage_collection():
        many = [[] for _ in range(3000)]
    left = garbage._Collected.objects
    assert left > len(many)
    with paused_garbage_collection():
        many += [[] for _ in range(3000)]
    assert garbage._Collected.objects == left
