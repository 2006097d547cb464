"""The platforms that come with amuros."""

import pytest
from support import ROOT

from amalthea_uros import build
from amalthea_uros._internal.resources import PLATFORMS, known_platforms
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.docstrings import field_docstrings
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.platforms import Platform, complete
from amalthea_uros.spec.read import read_section


@pytest.mark.parametrize("name", known_platforms())
class TestPlatform:
    def test_it_has_the_name_of_its_file(self, name):
        assert read_section(PLATFORMS / f"{name}.yaml", Platform).platform == name

    def test_an_application_can_be_built_for_it(self, name):
        system = build(ROOT / "samples" / "bodas-test-advanced.yaml", platform=name).assembly.system
        assert system.cores
        assert all(clock.frequency for clock in system.hardware.clocks)

    def test_it_is_documented(self, name):
        assert f"`{name}`" in field_docstrings(HardwareSection)["platform"]
        assert f"`{name}`" in (ROOT / "docs" / "app-yaml.md").read_text()


def test_a_platform_file_describes_the_whole_hardware(tmp_path):
    (tmp_path / "mine.yaml").write_text("amuros: 1\nplatform: mine\nhardware: {platform: generic, cores: 2}\n")
    with pytest.raises(ReadError) as error:
        complete(Description(amuros=1, name="a", hardware=HardwareSection(platform="./mine.yaml")), tmp_path)
    (finding,) = error.value.findings
    assert finding.message == "the platform 'mine' refers to another platform, 'generic'"
    assert (finding.location.path, finding.location.line) == (tmp_path / "mine.yaml", 3)
