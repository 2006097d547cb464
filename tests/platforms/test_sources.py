"""Each figure of a board or an operating system that comes with amuros has a source, and each source is that of a figure."""

import pytest

from amalthea_uros._internal.resources import PLATFORMS, RTOSES, known_platforms, known_rtoses
from amalthea_uros.spec.platforms import Platform, Rtos
from amalthea_uros.spec.read import read_section

#: A source for the whole file, or no figure that is about something real.
WITHOUT_SOURCES = {"bodas-rc18-12-40", "generic", "single-core"}
FILES = [
    *((PLATFORMS / f"{name}.yaml", Platform) for name in known_platforms() if name not in WITHOUT_SOURCES),
    *((RTOSES / f"{name}.yaml", Rtos) for name in known_rtoses()),
]


@pytest.mark.parametrize(("path", "kind"), FILES, ids=lambda value: getattr(value, "stem", ""))
def test_each_figure_has_a_source(path, kind):
    section = read_section(path, kind)
    # The figures of a port have their sources in its own file.
    figures = {*section.os.model_fields_set, *section.middleware.model_fields_set} - {"rtos", "port"}
    if kind is Platform:
        figures |= section.hardware.model_fields_set & {"frequency", "memories"}
    named = [key.removeprefix("os.").partition(".")[0] for key in section.sources]
    assert figures <= {*named}
    assert {*named} <= figures | {"cores", "core_type"}


@pytest.mark.parametrize("name", known_rtoses())
def test_an_operating_system_has_the_name_of_its_file(name):
    assert read_section(RTOSES / f"{name}.yaml", Rtos).rtos == name
