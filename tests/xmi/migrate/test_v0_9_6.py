"""Event chains and conditions about modes."""

import pytest

from amalthea_uros.xmi.tree.notes import NoteKind

EVENTS = '<eventModel><events t="ProcessEvent" name="a"/><events t="ProcessEvent" name="b"/></eventModel>'
ENDS = 'stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"'


def chains(content):
    return f"{EVENTS}<constraintsModel>{content}</constraintsModel>"


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


@pytest.mark.parametrize("version", ["0.9.5", "0.9.6", "0.9.7"])
def test_what_is_in_the_new_form_stays(models, version):
    content = f"""<eventChains name="c" {ENDS} itemType="parallel" minItemsCompleted="2">
        <items t="EventChainReference" eventChain="c?type=EventChain"/></eventChains>"""
    assert models.migrate(version, "0.9.8", chains(content)) == models.read("0.9.8", chains(content))
