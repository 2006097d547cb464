"""0.7.2 -> 0.8.0: what the pairs of models do not show."""

import pytest
from inline_models import migrate


@pytest.fixture
def up(tmp_path):
    def run(*contents, root="Amalthea", source="0.7.2", target="0.8.0"):
        return migrate(tmp_path, source, target, *contents, root=root)

    return run


def test_common_elements_can_be_a_root(up):
    assert up('<tags name="t"/>', root="CommonElements").lines[1:] == ["Amalthea", "commonElements", "tags name='t'"]


TIMES = """
<stimuliModel>
  <stimuli t="Periodic" name="p"><customProperties key="k"><value t="SignedTimeObject" value="1"/></customProperties>
    <stimulusDeviation><lowerBound t="SignedTime" value="2"/></stimulusDeviation></stimuli>
  <clocks t="ClockSinusFunction" name="c"><shift t="SignedTime" value="3"/></clocks>
</stimuliModel>
<constraintsModel><requirements><limit t="TimeRequirementLimit"><limitValue t="SignedTime" value="4"/></limit>
</requirements></constraintsModel>
"""


def test_signed_times_are_times_everywhere(up):
    result = up(TIMES)
    assert "Signed" not in result.text
    assert "value [TimeObject] value='1'" in result.lines
    assert "limitValue [Time] value='4'" in result.lines


def test_damaged_files_are_no_problem(up):
    up(
        '<mappingModel><mapping t="Unknown"/><mapping/></mappingModel><swModel><modeLabels mode="x"/>'
        '<modeLabels mode="y" initialValue="z"/></swModel>'
        "<osModel><osDataConsistency/><osDataConsistency/><operatingSystems/></osModel>"
        "<propertyConstraintsModel><mappingConstraints/><allocationConstraints><hwConstraint/><hwConstraint/></allocationConstraints>"
        "</propertyConstraintsModel>",
    )
