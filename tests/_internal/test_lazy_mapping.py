"""Mappings that are made once somebody looks at them."""

import pickle

from amalthea_uros._internal.lazy_mapping import LazyMapping


def test_it_is_made_once_and_only_if_somebody_looks():
    calls = []
    found = LazyMapping(lambda: calls.append(1) or {"a": 1, "b": 2})
    assert calls == []
    assert (len(found), found["b"], list(found), "c" in found) == (2, 2, ["a", "b"], False)
    assert found == {"a": 1, "b": 2}
    assert calls == [1]


def test_it_is_sent_as_a_dictionary():
    assert pickle.loads(pickle.dumps(LazyMapping(lambda: {"a": 1}))) == {"a": 1}
