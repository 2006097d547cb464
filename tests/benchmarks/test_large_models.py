"""The benchmark of large models compares models that differ, and measures each step."""

import pytest
from large_models import measured, write_models

from amalthea_uros import diff


def test_each_step_of_models_that_differ_is_measured(tmp_path):
    model, other = write_models(1, tmp_path)
    assert model.stat().st_size == pytest.approx(10**6, rel=0.1)
    assert diff(model, other).changes
    for what in ("load", "diff"):
        seconds, megabytes = measured(what, model, other)
        assert seconds > 0
        assert megabytes > 10
