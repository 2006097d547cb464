"""What the tests of migrations share."""

from functools import partial

import pytest
from inline_models import InlineModels, check_step, migrate, written


@pytest.fixture
def models(tmp_path):
    """Models inside of tests, as files of a new folder."""
    return InlineModels(tmp_path)


@pytest.fixture
def files(tmp_path):
    """Write files of a version."""
    return partial(written, tmp_path)


@pytest.fixture
def same(tmp_path, request):
    """Assert what some files become in the step of the module."""
    return partial(check_step, tmp_path, *request.module.STEP)


@pytest.fixture
def up(tmp_path, request):
    """Take contents through the step of the module, or another one."""

    def run(*contents, root="Amalthea", source=request.module.STEP[0], target=request.module.STEP[1]):
        return migrate(tmp_path, source, target, *contents, root=root)

    return run
