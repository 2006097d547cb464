"""0.7.1 -> 0.7.2: what the pairs of models do not show."""

import pytest

#: The versions.
STEP = ("0.7.1", "0.7.2")


DEVIATION = (
    '<stimuliModel><stimuli t="Periodic" name="p">'
    '<stimulusDeviation samplingType="WorstCase">{}</stimulusDeviation></stimuli></stimuliModel>'
)


@pytest.mark.parametrize(
    ("distribution", "kept"),
    [
        ('<distribution t="Boundaries"/>', True),
        ('<distribution t="UniformDistribution"/>', False),
        ("", True),
        ("<distribution/>", False),
    ],
)
def test_a_sampling_type_needs_boundaries(up, distribution, kept):
    result = up(DEVIATION.format(distribution))
    assert ("distribution [Boundaries] samplingType='WorstCase'" in result.lines) is kept
    assert bool(result.of("LOST")) is not kept


CONDITIONS = """
<propertyConstraintsModel>
  <allocationConstraints t="ProcessAllocationConstraint"><hwConstraint t="HwCoreConjunction">
    <firstConstraint t="HwCoreProperty"><core name="{core}" coreType="ct?type=CoreType"><memories name="inner"/></core>
    </firstConstraint>
    <secondConstraint t="HwCoreProperty"><core name="{core}"/></secondConstraint>
  </hwConstraint></allocationConstraints>
  <mappingConstraints t="AbstractElementMappingConstraint">
    <hwConstraint t="HwMemoryProperty"><memory name="inner"/></hwConstraint>
  </mappingConstraints>
  <coreTypeDefinitions name="ct" instructionsPerCycle="2"/>
</propertyConstraintsModel>
<mappingModel><coreAllocation core="{core}?type=Core"/></mappingModel>
"""


def test_new_cores_are_apart_from_those_of_the_system(up):
    hardware = '<hwModel><system name="s"><ecus name="e"><microcontrollers name="m"/></ecus></system></hwModel>'
    result = up(CONDITIONS.format(core="c"), hardware)
    assert "coreAllocation core -> m1.amxmi/hwModel.0/system.0/ecus.1/microcontrollers.0/cores.0" in result.lines
    assert "hwModel" not in result.text.split("== 0.7.2")[1].replace("/hwModel", "")


def test_a_condition_without_name_means_nothing(up):
    result = up(CONDITIONS.format(core=""))
    assert "firstConstraint [HwCoreProperty]" in result.lines
    assert len([message for message in result.of("LOST") if message.startswith("unnamed core")]) == 2


def test_damaged_files_are_no_problem(up):
    up(
        '<osModel><osBuffering/><osBuffering/></osModel><osModel/><target t="TargetProcess"/><core/><core name="x"/><tags/>'
        '<swModel><tags/><tags/><runnables><runnableItems t="Group"><items><runnableItem/><runnableItem/></items></runnableItems>'
        '<runnableItems t="ProbabilityGroup"><items/><items><runnableItem/></items></runnableItems></runnables></swModel>'
        '<propertyConstraintsModel><coreTypeDefinitions/><memoryTypeDefinitions name="m"/><memoryTypeDefinitions name="m"/>'
        '<allocationConstraints><hwConstraint t="HwCoreProperty"><core name="a"/><core name="b"/></hwConstraint>'
        "</allocationConstraints>"
        '</propertyConstraintsModel><configModel><eventsToTrace/><eventsToTrace t="EventConfigElement" event="x"/></configModel>'
        '<constraintsModel><affinityConstraints/><affinityConstraints t="DataPairingConstraint"/></constraintsModel>',
    )
