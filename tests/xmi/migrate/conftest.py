"""What the tests of migrations share."""

import pytest
from inline_models import InlineModels


@pytest.fixture
def models(tmp_path):
    """Models inside of tests, as files of a new folder."""
    return InlineModels(tmp_path)
