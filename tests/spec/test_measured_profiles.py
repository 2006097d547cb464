"""Profiles of measured times: what they add to a description, what overrides them, and that they are named in assumptions."""

import pytest
from support import ROOT

from amalthea_uros import describe
from amalthea_uros._internal.resources import MEASURED, known_measured
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.docstrings import field_docstrings
from amalthea_uros.spec.measured import MeasuredProfile
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.read import read_description, read_section
from amalthea_uros.spec.transports import Agent, TransportSection
from amalthea_uros.units import MICROSECOND, MILLISECOND

APPLICATION = """amuros: 1
name: app
hardware: {}
middleware: {{executor: {{loop: {{spin_some: 1 ms}}, execution_time: 1 us}}, {}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {{name: Echo, topic: ping, message_size: 8 B, reliability: best-effort, rate: 10 Hz, execution_time: 1 us}}
"""
PROFILE = """amuros: 1
profile: mine
title: a board of ours
source: our laboratory
measured: 10 round trips
basis: measured
{}
"""
PLATFORM = """amuros: 1
platform: board
hardware: {{frequency: 100 MHz}}
middleware: {{{}}}
"""


class Author:
    """Writes an application with what it names."""

    def __init__(self, folder):
        self.folder = folder

    def write(self, middleware, hardware="single-core", profile="", platform=""):
        (self.folder / "app.yaml").write_text(APPLICATION.format(hardware, middleware))
        (self.folder / "mine.yaml").write_text(PROFILE.format(profile))
        (self.folder / "board.yaml").write_text(PLATFORM.format(platform))
        return self.folder / "app.yaml"

    def complete(self, *args, **kwargs):
        return complete(read_description(self.write(*args, **kwargs)), self.folder)

    def middleware(self, *args, **kwargs) -> Middleware:
        return self.complete(*args, **kwargs).description.middleware

    def findings(self, *args, **kwargs):
        with pytest.raises(ReadError) as caught:
            describe(self.write(*args, **kwargs))
        return caught.value.findings


@pytest.fixture
def author(tmp_path):
    return Author(tmp_path)


def test_an_agent_and_a_transport_have_the_times_of_their_profile(author):
    middleware = author.middleware("agent: {profile: pico2w-usb}, transport: {profile: pico2w-usb}")
    agent, usb = middleware.agent, middleware.transport.usb_cdc
    assert [(each.min, each.max) for each in (agent.to_controller, agent.to_host)] == [(300 * MICROSECOND, MILLISECOND)] * 2
    assert (agent.acknowledgement, usb.latency.max) == (None, MILLISECOND)


def test_what_is_stated_beside_the_name_overrides_it(author):
    found = author.complete(
        "agent: {profile: pico2w-usb, to_host: 5 ms}, transport: {profile: pico2w-usb, usb_cdc: {latency: 2 ms}}"
    )
    middleware = found.description.middleware
    assert (middleware.agent.to_controller.max, middleware.agent.to_host.max) == (MILLISECOND, 5 * MILLISECOND)
    assert middleware.transport.usb_cdc.latency.max == 2 * MILLISECOND
    # Nothing of the transport is from the profile any more.
    (sentence,) = found.assumptions
    assert sentence.startswith("'to_controller' of the agent is that of profile 'pico2w-usb', chosen to fit 30,000 round trips")


def test_a_profile_counts_before_the_platform_and_after_what_names_it(author):
    file = "agent: {to_host: 3 ms, to_controller: 4 ms}"
    named = author.middleware(
        "agent: {profile: ./mine.yaml}", "./board.yaml", file, "agent: {to_host: 9 ms, acknowledgement: 8 ms}"
    )
    assert [named.agent.to_host.max, named.agent.to_controller.max] == [3 * MILLISECOND, 4 * MILLISECOND]
    assert named.agent.acknowledgement.max == 8 * MILLISECOND
    by_platform = author.middleware(
        "agent: {to_host: 1 ms}", "./board.yaml", file, "agent: {profile: ./mine.yaml, to_controller: 2 ms}"
    )
    assert [by_platform.agent.to_host.max, by_platform.agent.to_controller.max] == [MILLISECOND, 2 * MILLISECOND]


def test_an_application_with_another_wire_does_not_get_that_of_a_profile_of_its_platform(author):
    found = author.complete("transport: {serial: {}}", "./board.yaml", platform="transport: {profile: pico2w-usb}")
    assert found.description.middleware.transport.usb_cdc is None
    assert found.assumptions == ()


def test_the_assumption_says_how_the_times_follow_from_what(author):
    text = "agent: {profile: ./mine.yaml}, transport: {profile: ra6m5-uart}"
    sentences = author.complete(text, profile="agent: {to_host: 3 ms}").assumptions
    assert sentences[0] == "'to_host' of the agent is that of profile 'mine', measured in 10 round trips"
    assert sentences[1].startswith(
        "'serial.baud_rate', 'serial.driver.write' and 'serial.driver.read' of the transport are those of"
    )
    assert "profile 'ra6m5-uart', with which its times follow from the latencies of an Int64" in sentences[1]


@pytest.mark.parametrize(
    ("middleware", "profile", "message", "advice"),
    [
        (
            "agent: {profile: pico2w-usp}",
            "",
            "unknown profile of measured times 'pico2w-usp'",
            "Did you mean 'pico2w-usb'?",
        ),
        (
            "transport: {profile: pico2w-usb, serial: {}}",
            "",
            "the profile 'pico2w-usb' describes 'usb_cdc', not 'serial'",
            "Remove 'profile', and state the values of the transport.",
        ),
        (
            "transport: {profile: ./mine.yaml}",
            "agent: {to_host: 1 ms}",
            "the profile 'mine' has no times of the transport",
            "Remove 'profile', and state the values of the transport.",
        ),
    ],
)
def test_a_wrong_name_is_reported_where_it_is(middleware, profile, message, advice, author):
    (finding,) = author.findings(middleware, profile=profile)
    assert (finding.message, finding.help, finding.location.line) == (message, advice, 4)


def test_a_profile_does_not_refer_to_another_one(author):
    (finding,) = author.findings("agent: {profile: ./mine.yaml}", profile="agent: {profile: pico2w-usb}")
    assert (finding.message, finding.location.line) == ("the profile 'mine' refers to another profile, 'pico2w-usb'", 7)


@pytest.mark.parametrize("name", known_measured())
class TestKnownProfile:
    def test_it_has_the_name_of_its_file(self, name):
        assert read_section(MEASURED / f"{name}.yaml", MeasuredProfile).profile == name

    def test_each_figure_has_a_source(self, name):
        profile = read_section(MEASURED / f"{name}.yaml", MeasuredProfile)
        sources = [key for key in profile.sources if key.partition(".")[0] in profile.model_fields_set]
        assert sources == [*profile.sources]
        assert {key.partition(".")[0] for key in sources} == {"agent", "transport"} & profile.model_fields_set

    def test_it_is_documented(self, name):
        for section in (Agent, TransportSection):
            assert f"`{name}`" in field_docstrings(section)["profile"]
        assert f"`{name}`" in (ROOT / "docs" / "boards.md").read_text()
