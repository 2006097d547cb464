"""0.7.2 -> 0.8.0: what the pairs of models do not show."""

import pytest
from inline_models import migrate

KEY = "hwConstraint (element removed during Migration of Model to 0.8.0 version)"


@pytest.fixture
def up(tmp_path):
    def run(*contents, root="Amalthea", source="0.7.2", target="0.8.0"):
        return migrate(tmp_path, source, target, *contents, root=root)

    return run


def test_common_elements_can_be_a_root(up):
    assert up('<tags name="t"/>', root="CommonElements").lines[1:] == ["Amalthea", "commonElements", "tags name='t'"]


def test_a_mapping_keeps_its_address(up):
    result = up(
        '<mappingModel><mapping t="AbstractElementMapping" memoryPositionAddress="8"><customProperties key="k"/>'
        "</mapping></mappingModel>"
    )
    assert result.lines[3:] == ["memoryMapping memoryPositionAddress='8'", "customProperties key='k'"]


UNITS = """
<swModel><labels name="l"><size value="1" unit="kB"/></labels><channels name="c"><size value="1" unit="byte"/></channels>
<runnables name="r"><runnableItems t="LabelAccess"><transmissionPolicy><chunkSize value="1" unit="kibit"/>
</transmissionPolicy></runnableItems>
<rate value="1" unit="bytePerSecond"/><rate value="1" unit="kibitPerSecond"/></runnables></swModel>
"""


def test_all_units_of_data_are_renamed(up):
    result = up(UNITS)
    assert "size unit='kB' value='1'" in result.lines
    assert "size unit='B' value='1'" in result.lines
    assert "chunkSize unit='Kibit' value='1'" in result.lines
    assert "rate unit='BPerSecond' value='1'" in result.lines
    assert "rate unit='KibitPerSecond' value='1'" in result.lines


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


MODES = """
<swModel><modes name="m"><literals name="a"/></modes>
<modeLabels name="x" mode="m?type=Mode" initialValue="m/a?type=ModeLiteral"/><modeLabels name="y" mode="m?type=Mode"/></swModel>
"""


def test_a_mode_without_initial_value_is_set_aside_for_later_versions(up):
    result = up(MODES)
    assert "mode ->" not in result.text
    [((label, name), [mode])] = result.models.set_aside.items()
    assert (label.name, name, mode.name) == ("y", "mode", "m")
    assert result.of("LOST") == ["reference 'mode': this version has no place for it"]


def test_a_mode_that_is_not_that_of_the_initial_value_is_lost(up):
    literal = '<modes name="m"><literals name="a"/></modes><modes name="n"/>'
    result = up(f'<swModel>{literal}<modeLabels name="x" mode="n?type=Mode" initialValue="m/a?type=ModeLiteral"/></swModel>')
    assert result.notes == [("LOST", "mode of a mode label: that of its initial value is another one", "n")]
    result = up('<swModel><modeLabels name="x" mode="n?type=Mode" initialValue="n/a?type=ModeLiteral"/></swModel>')
    assert result.of("LOST") == []


CONSISTENCY = (
    '<osModel><osDataConsistency mode="automaticProtection"><dataStability level="process"/></osDataConsistency>{}</osModel>'
)


def test_every_operating_system_gets_its_own_consistency(up):
    result = up(
        CONSISTENCY.format(
            '<operatingSystems name="a"/><operatingSystems t="VendorOperatingSystem" name="b"><osDataConsistency/></operatingSystems>'
        )
    )
    assert result.lines[3:] == [
        "operatingSystems name='a'",
        "osDataConsistency mode='automaticProtection'",
        "dataStability level='process'",
        "operatingSystems [VendorOperatingSystem] name='b'",
        "osDataConsistency",
    ]


def test_consistency_without_operating_system_is_lost(up):
    result = up(CONSISTENCY.format(""))
    assert result.lines[2:] == ["osModel"]
    assert result.notes[0] == (
        "LOST",
        "osDataConsistency: there is no operating system",
        "mode=automaticProtection, dataStability (level=process)",
    )
    assert up("<osModel><osDataConsistency/></osModel>").notes == []


def test_consistency_that_no_operating_system_takes_is_lost(up):
    result = up(CONSISTENCY.format('<operatingSystems name="a"><osDataConsistency mode="noProtection"/></operatingSystems>'))
    assert result.lines[2:] == ["osModel", "operatingSystems name='a'", "osDataConsistency mode='noProtection'"]
    assert [note[:2] for note in result.notes] == [("LOST", "osDataConsistency: every operating system has its own")]


def test_conditions_for_hardware_are_kept_as_text(up):
    result = up(
        '<hwModel><system name="s"><memories name="a 1"/></system></hwModel><propertyConstraintsModel>'
        '<mappingConstraints t="AbstractElementMappingConstraint"><customProperties key="first"/>'
        '<hwConstraint t="HwMemoryProperty" comparator="equal" memory="a+1?type=Memory"/></mappingConstraints>'
        '<allocationConstraints t="ProcessAllocationConstraint"><hwConstraint t="HwCoreConjunction" conjunction="and">'
        '<firstConstraint t="HwCoreProperty"/></hwConstraint></allocationConstraints></propertyConstraintsModel>',
    )
    xsi = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    [[first, condition], [conjunction]] = [
        constraint.all("customProperties") for constraint in result.models.nodes("mappingConstraints", "allocationConstraints")
    ]
    assert (first.get("key"), condition.get("key"), conjunction.get("key")) == ("first", KEY, KEY)
    assert condition.children[0].type == "StringObject"
    assert (
        condition.children[0].get("value")
        == f'<hwConstraint {xsi} xsi:type="am:HwMemoryProperty" comparator="equal" memory="a+1?type=Memory" />'
    )
    assert conjunction.children[0].get("value") == (
        f'<hwConstraint {xsi} xsi:type="am:HwCoreConjunction" conjunction="and">\r\n'
        '        <firstConstraint xsi:type="am:HwCoreProperty" />\r\n      </hwConstraint>'
    )
    assert "  hwConstraint" not in result.text
    assert result.of("LOST") == []


def test_a_misspelt_switch_of_a_later_version_is_repaired(up):
    switch = '<callGraph><graphEntries t="ProbabiltitySwitch"/></callGraph>'
    result = up(f'<swModel><isrs name="i">{switch}</isrs></swModel>', source="0.8.0")
    assert "graphEntries [ProbabilitySwitch]" in result.lines


def test_a_file_of_the_new_version_stays_as_it_is(up):
    content = (
        '<swModel><modeLabels name="x"/></swModel><osModel><operatingSystems name="o"><osDataConsistency/></operatingSystems></osModel>'
        '<mappingModel><memoryMapping memoryPositionAddress="8"/><mapping t="AbstractElementMapping"/></mappingModel>'
    )
    result = up(content, source="0.8.0")
    assert result.lines[2:] == [
        "mappingModel",
        "memoryMapping memoryPositionAddress='8'",
        "memoryMapping",
        "osModel",
        "operatingSystems name='o'",
        "osDataConsistency",
        "swModel",
        "modeLabels name='x'",
    ]


def test_damaged_files_are_no_problem(up):
    up(
        '<mappingModel><mapping t="Unknown"/><mapping/></mappingModel><swModel><modeLabels mode="x"/>'
        '<modeLabels mode="y" initialValue="z"/></swModel>'
        "<osModel><osDataConsistency/><osDataConsistency/><operatingSystems/></osModel>"
        "<propertyConstraintsModel><mappingConstraints/><allocationConstraints><hwConstraint/><hwConstraint/></allocationConstraints>"
        "</propertyConstraintsModel>",
    )


def test_the_text_of_a_condition_names_hardware_of_other_files_as_files_do(up):
    result = up(
        '<propertyConstraintsModel><mappingConstraints><hwConstraint t="HwMemoryProperty">'
        '<memory href="amlt:/#a+1?type=Memory"/></hwConstraint></mappingConstraints></propertyConstraintsModel>',
        '<hwModel><system name="s"><memories name="a 1"/></system></hwModel>',
    )
    assert '<memory href="amlt:/#a+1?type=Memory" />' in result.text
