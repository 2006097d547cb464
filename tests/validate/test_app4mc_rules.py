"""The rules of the profile app4mc about names, values and chains, and what holds for all of them."""

import pytest
from excerpts import ECU, assert_said, cases, messages, module, port

from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile

CLOCK = '<stimuliModel><clocks t="ClockFunction" name="C">{}</clocks></stimuliModel>'
VALUES = [
    ("AM-Basic-Data-Size", '<swModel><labels name="L"><size unit="B"/></labels></swModel>', ["the size of 'L' is 0"]),
    (
        "AM-Basic-Data-Size",
        '<swModel><labels name="L"><size value="-1" unit="B"/></labels></swModel>',
        ["the size of 'L' is -1"],
    ),
    ("AM-Basic-Data-Size", '<swModel><labels name="L"/></swModel>', []),
    (
        "AM-Basic-Data-Size",
        '<hwModel><definitions t="MemoryDefinition" name="D"><size value="0" unit="B"/></definitions></hwModel>',
        [],
    ),
    (
        "AM-Basic-Frequency",
        '<hwModel><domains t="FrequencyDomain" name="c"><defaultValue unit="MHz"/></domains></hwModel>',
        ["0"],
    ),
    ("AM-Basic-Frequency", CLOCK.format('<yOffset value="0.0" unit="Hz"/>'), ["0"]),
    ("AM-Basic-Frequency", CLOCK.format('<yOffset value="-1.0" unit="Hz"/>'), ["-1.0"]),
    (
        "AM-Basic-Frequency",
        CLOCK.format('<entries><frequency value="0.0" unit="Hz"/></entries>').replace("ClockFunction", "ClockStepList"),
        [],
    ),
    ("AM-Basic-Frequency", CLOCK.format('<peakToPeak value="0.0" unit="Hz"/>'), []),
]

CHAIN = """<eventModel><events t="CustomEvent" name="a"/><events t="CustomEvent" name="b"/></eventModel>
<constraintsModel><eventChains name="C" stimulus="a?type=CustomEvent" response="b?type=CustomEvent" itemType="{}">{}</eventChains>
</constraintsModel>"""
PART = '<items t="EventChainContainer"><eventChain stimulus="{}?type=CustomEvent" response="{}?type=CustomEvent"/></items>'
CHAINS = [
    ("AM-Constraints-EventChain", CHAIN.format("sequence", PART.format("a", "b") * 2), ["segment 2"]),
    ("AM-Constraints-EventChain", CHAIN.format("sequence", PART.format("b", "a")), ["first segment", "last segment"]),
    ("AM-Constraints-EventChain", CHAIN.format("parallel", PART.format("b", "a")), []),
    ("AM-Constraints-EventChain", CHAIN.format("sequence", ""), []),
    (
        "AM-Constraints-EventChain",
        CHAIN.format("sequence", '<items t="EventChainReference" eventChain="gone?type=EventChain"/>'),
        [],
    ),
    ("AM-Constraints-EventChain", CHAIN.format("sequence", '<items t="EventChainReference"/>'), []),
]


@cases(VALUES, CHAINS)
def test_a_case(rule, excerpt, said, tmp_path):
    assert_said(messages(tmp_path, rule, excerpt), said)


ARGUMENT = '<arguments name="a" parameter="S/p?type=RunnableParameter"/>'
CALLS = f"""<swModel><runnables name="S"><parameters name="p"/></runnables><runnables name="R"><activityGraph>
{f'<items t="RunnableCall" runnable="S?type=Runnable">{ARGUMENT}</items>' * 2}</activityGraph></runnables></swModel>"""


@pytest.mark.parametrize(
    ("excerpts", "count"),
    [
        (['<swModel><tasks name="T"/></swModel>', '<swModel><tasks name="T"/></swModel>'], 2),
        (['<swModel><tasks name="T"/><tasks name="T"/></swModel>', '<swModel><tasks name="T"/></swModel>'], 3),
        (['<swModel><tasks name="T"/></swModel>', '<swModel><isrs name="T"/></swModel>'], 0),
        (['<swModel><tasks/><tasks name=""/></swModel>'], 0),
        ([ECU.format("", module("Memory", "a", port("p")) + module("Memory", "b", port("p")))], 0),
        ([ECU.format("", module("Memory", "a", port("p"), port("p")))], 2),
        ([CALLS], 2),
        ([CALLS.replace(' name="a"', "")], 0),
    ],
)
def test_each_object_of_a_name_is_reported(excerpts, count, tmp_path):
    assert len(messages(tmp_path, "AM-EMF-SCOPE", *excerpts)) == count


def test_documented_constraints_are_not_said_to_be_reported():
    for identifier in registry.ids([RuleProfile.APP4MC]):
        rationale = registry.kind(identifier).rationale
        assert rationale.endswith("APP4MC's validation also reports it.") is identifier.startswith("AM-")
        assert ("The APP4MC documentation requires" in rationale) is identifier.startswith("DOC-")
