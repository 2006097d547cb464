"""Profiles: those that come with amuros, and files that change one of them."""

import pytest

from amalthea_uros.errors import ReadError
from amalthea_uros.spec.content import nodes_of
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.nodes import plain
from amalthea_uros.units import MILLISECOND
from amalthea_uros.uros.application.messages import MessageKind
from amalthea_uros.uros.profiles import KNOWN, known_data, profile_of

TEXT = """
amuros: 1
name: app
hardware: {{platform: generic, frequency: 160 MHz}}
middleware:
  profile: {profile}
  executor: {{loop: {{spin_some: 100 ms}}}}
  tasks: [{tasks}]
application:
  nodes:
    - name: node
      publishers:
        - {{topic: state, message_size: 8 B}}
      timers:
        - {{name: Report, period: 10 ms, execution_time: 4 us, publishes: [state]}}
"""
OWN = """
amuros: 1
profile: my-middleware
base: xrce-dds
title: a port that acknowledges quickly
waiting: {stored_data_ends_wait: true}
options: {RMW_UXRCE_MAX_HISTORY: 3, RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT: 20}
sizes: {acknowledgement: 9 B}
"""


def middleware(**content):
    return Middleware.model_validate(plain(nodes_of(content)[0]))


def mistakes(folder, profile):
    with pytest.raises(ReadError) as caught:
        profile_of(Middleware(profile=str(folder / profile) if folder else profile))
    return [(finding.rule, finding.message, finding.help) for finding in caught.value.findings]


@pytest.mark.parametrize("name", KNOWN)
def test_a_profile_states_its_sources(name):
    data, profile = known_data(name), profile_of(Middleware(profile=name))
    assert (profile.name, profile.title, profile.source) == (name, data.title, data.source)
    assert all((data.title, data.source))
    sections = {key.partition(".")[0] for key in data.sources}
    assert {"waiting", "sending", "sizes"} <= sections
    # Each source is one of a figure that is there.
    for key in data.sources:
        section, _, figure = key.partition(".")
        value = getattr(data, section)
        assert not figure or figure in (value if isinstance(value, dict) else value.model_fields_set)


def test_a_file_changes_what_it_states(tmp_path):
    (tmp_path / "own.yaml").write_text(OWN)
    own, base = profile_of(middleware(profile=str(tmp_path / "own.yaml"))), profile_of(Middleware())
    assert own.title == "a port that acknowledges quickly"
    assert own.waiting.slots == 3
    assert own.waiting.stored_data_ends_wait
    assert own.waiting.default_timeout == base.waiting.default_timeout
    assert own.sending.timeout == 20 * MILLISECOND
    (part,) = own.parts(MessageKind.PUBLICATION, 4, reliable=True)
    assert (part.length, part.acknowledgement) == (16, 9)


def test_a_file_is_relative_to_the_description(author):
    author.path.with_name("own.yaml").write_text(OWN)
    (executor,) = author.describe(TEXT.format(profile="own.yaml", tasks="")).system.executors
    assert executor.waiting.slots == 3
    (publication,) = executor.handles[0].publications
    assert (publication.waits, publication.timeout) == (True, 20 * MILLISECOND)


@pytest.mark.parametrize(
    ("profile", "message", "advice"),
    [
        ("zenoh-pica", "unknown profile 'zenoh-pica'", "Did you mean 'zenoh-pico'?"),
        ("dds", "unknown profile 'dds'", "Known profiles: xrce-dds, zenoh-pico; or give a file, e.g. ./my-middleware.yaml."),
        ("none.yaml", "profile file 'none.yaml' not found", "Give a path relative to the directory of this file."),
    ],
)
def test_an_unknown_profile(tmp_path, monkeypatch, profile, message, advice):
    monkeypatch.chdir(tmp_path)
    assert mistakes(None, profile) == [("APP001", message, advice)]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("base: xrce", "unknown profile 'xrce'"),
        ("title: without a base", "the profile 'own' does not name the one that it changes"),
        ("base: xrce-dds\nsizes: {acknowledgment: 9 B}", "unknown size 'acknowledgment'"),
        ("base: xrce-dds\nsizes: {message_header: 1 GB}", "message_header: must not be greater than 64 KiB"),
        ("base: xrce-dds\nsending: {timout: 9 ms}", "unknown key 'timout'"),
        ("base: xrce-dds\noptions: {RMW_UXRCE_MTU: 3}", "unknown build option 'RMW_UXRCE_MTU'"),
        ("base: xrce-dds\nwaiting: {resolution: -1 ms}", "must not be negative"),
        ("base: [xrce-dds]", "base"),
    ],
)
def test_a_file_with_a_mistake(tmp_path, wrong, message):
    (tmp_path / "own.yaml").write_text(f"amuros: 1\nprofile: own\n{wrong}\n")
    ((_, found, _),) = mistakes(tmp_path, "own.yaml")
    assert message in found


def test_the_mistake_of_a_profile_is_reported_with_the_others(author):
    text = TEXT.format(profile="zenoh-pica", tasks="").replace("platform: generic", "platform: generic, label_memory: none")
    assert ("APP001", "unknown profile 'zenoh-pica'") in [(rule, message) for _, rule, message in author.findings(text)]


def test_the_priority_of_a_thread_of_the_middleware_has_to_be_stated(author):
    ((line, rule, message),) = author.findings(TEXT.format(profile="zenoh-pico", tasks=""))
    assert (line, rule) == (7, "APP003")
    assert message.startswith("the priority of the thread 'zenoh_read' of zenoh-pico is not specified")
    assert author.describe(TEXT.format(profile="zenoh-pico", tasks="{name: zenoh_read, priority: 7}"))


def test_threads_are_those_of_the_profile_and_of_the_port():
    described = middleware(
        profile="zenoh-pico", tasks=[{"name": "zenoh_read", "priority": 7, "stack": "4 kB"}, {"name": "Receive", "priority": 9}]
    )
    read, receive = profile_of(described).threads
    assert (read.name, read.priority, read.stack, read.calls_subscribers) == ("zenoh_read", 7, 4000, False)
    assert (receive.name, receive.priority, receive.stack, receive.period) == ("Receive", 9, None, None)
    # FreeRTOS: 5120 words of 4 B.
    assert profile_of(Middleware(profile="zenoh-pico")).threads[0].stack == 20480
    assert profile_of(Middleware()).threads == ()


@pytest.mark.parametrize("name", KNOWN)
def test_a_message_that_cannot_be_sent_is_not_cut(name):
    described = Middleware(profile=name)
    content = 2**60
    (part,) = profile_of(described).parts(MessageKind.PUBLICATION, content, reliable=True)
    assert part.length > content
