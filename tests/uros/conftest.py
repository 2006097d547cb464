"""Descriptions as text, and the systems assembled from them."""

import textwrap

import pytest

from amalthea_uros import describe
from amalthea_uros.errors import ReadError


class Author:
    """Writes an app.yaml and assembles it."""

    def __init__(self, folder):
        self.path = folder / "app.yaml"

    def describe(self, text, platform=None):
        self.path.write_text(textwrap.dedent(text).lstrip("\n"))
        return describe(self.path, platform)

    def findings(self, text):
        """The errors of an invalid description: (line, rule, message) each."""
        with pytest.raises(ReadError) as caught:
            self.describe(text)
        return [(f.location.line, f.rule, f.message) for f in caught.value.findings if f.severity == "error"]

    def reported(self, text, *rules):
        """The messages of some rules about a description that is valid."""
        return [finding.message for finding in self.describe(text).findings if finding.rule in rules]


@pytest.fixture
def author(tmp_path):
    return Author(tmp_path)
