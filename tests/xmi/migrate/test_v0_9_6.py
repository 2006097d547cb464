"""Event chains and conditions about modes."""

import pytest

from amalthea_uros.xmi.tree.notes import NoteKind

EVENTS = '<eventModel><events t="ProcessEvent" name="a"/><events t="ProcessEvent" name="b"/></eventModel>'
ENDS = 'stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"'


def chains(content):
    return f"{EVENTS}<constraintsModel>{content}</constraintsModel>"


def test_segments_and_strands_of_one_chain_become_a_sequence_that_ends_with_the_strands(models):
    before = f"""<eventChains name="c" {ENDS}>
        <strands t="EventChainReference" eventChain="x?type=EventChain"/>
        <segments t="EventChainReference" eventChain="y?type=EventChain"/>
      </eventChains><eventChains name="x" {ENDS}/><eventChains name="y" {ENDS}/>"""
    after = f"""<eventChains name="c" {ENDS} itemType="sequence">
        <items t="EventChainReference" eventChain="y?type=EventChain"/>
        <items t="EventChainContainer"><eventChain {ENDS} itemType="parallel">
          <items t="EventChainReference" eventChain="x?type=EventChain"/>
        </eventChain></items>
      </eventChains><eventChains name="x" {ENDS}/><eventChains name="y" {ENDS}/>"""
    assert models.migrate("0.9.5", "0.9.6", chains(before)) == models.read("0.9.6", chains(after))
    assert any("segments and strands" in message for message in models.messages(NoteKind.CONVERTED))


def test_parallel_chains_with_a_latency_constraint_are_to_be_checked(models):
    constraint = '<timingConstraints t="EventChainLatencyConstraint" name="l" scope="c?type=EventChain"/>'
    strands = '<strands t="EventChainReference" eventChain="x?type=EventChain"/>'
    chain = f'<eventChains name="c" {ENDS}>{strands}</eventChains><eventChains name="x" {ENDS}/>'
    models.migrate("0.9.5", "0.9.7", chains(chain + constraint))
    assert ["latency constraint" in message for message in models.messages(NoteKind.TO_CHECK)] == [True]
    models.migrate("0.9.5", "0.9.7", chains(chain))
    assert models.messages(NoteKind.TO_CHECK) == []


@pytest.mark.parametrize("scope", ["c", "outer", "outermost"])
def test_parallel_chains_are_to_be_checked_also_as_parts_of_chains_with_a_latency_constraint(models, scope):
    constraint = f'<timingConstraints t="EventChainLatencyConstraint" name="l" scope="{scope}?type=EventChain"/>'
    segment = '<segments t="EventChainReference" eventChain="{}?type=EventChain"/>'
    strands = '<strands t="EventChainReference" eventChain="x?type=EventChain"/>'
    inner = f'<segments t="EventChainContainer"><eventChain {ENDS}>{segment.format("c")}</eventChain></segments>'
    chain = f"""<eventChains name="c" {ENDS}>{strands}</eventChains><eventChains name="x" {ENDS}>{segment.format("x")}</eventChains>
        <eventChains name="outer" {ENDS}>{inner}</eventChains>
        <eventChains name="outermost" {ENDS}>{segment.format("outer")}</eventChains>"""
    models.migrate("0.9.5", "0.9.7", chains(chain + constraint))
    assert ["latency constraint" in message for message in models.messages(NoteKind.TO_CHECK)] == [True]


def test_chains_without_ends_are_to_be_checked_once(models):
    models.migrate("0.9.5", "0.9.7", chains('<eventChains name="c"/>'))
    assert len(models.messages(NoteKind.TO_CHECK)) == 2


@pytest.mark.parametrize("version", ["0.9.5", "0.9.6", "0.9.7"])
def test_what_is_in_the_new_form_stays(models, version):
    content = f"""<eventChains name="c" {ENDS} itemType="parallel" minItemsCompleted="2">
        <items t="EventChainReference" eventChain="c?type=EventChain"/></eventChains>"""
    assert models.migrate(version, "0.9.8", chains(content)) == models.read("0.9.8", chains(content))


def test_conditions_of_isrs_and_stimuli_are_converted_and_entries_of_switches_are_not(models):
    text = """<swModel><isrs name="I"><{graph}><items t="ModeSwitch"><entries name="e">
        <condition><entries {kind} value="on"/></condition></entries></items></{graph}></isrs></swModel>
      <stimuliModel><stimuli t="InterProcessStimulus" name="S">
        <executionCondition><entries {kind} value="on"/></executionCondition></stimuli></stimuliModel>"""
    before = text.format(graph="callGraph", kind='t="ModeCondition"')
    after = text.format(graph="activityGraph", kind='t="ModeValueCondition"')
    assert models.migrate("0.9.5", "0.9.7", before) == models.read("0.9.7", after)
