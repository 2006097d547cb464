"""The advice about the storage for messages fits the memory of the board, wherever it is given.

Without stacks the middleware takes 5120 B and 432 B for the session, 4448 B for entities, and 512 B x 4 + 64 B = 2112 B for each slot.
"""

import json

import pytest

from amalthea_uros import analyze
from amalthea_uros.services.generate import check_colcon_meta, generate

APP = """\
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz{hardware}}}
middleware:
  executor: {{period: 1 ms}}
  transport: {{serial: {{}}}}
  limits: {{RMW_UXRCE_MAX_HISTORY: {slots}}}
application:
  nodes:
    - name: node
      subscriptions:
{subscriptions}
"""
SUBSCRIPTION = "        - {{name: {name}, topic: {name}, message_size: {size} B, interval: 10 ms, execution_time: 2 us{more}}}"
REST = 5120 + 432 + 4448
SLOT = 512 * 4 + 64


def app(ram=None, names="ABC", slots=1, size=4, more=""):
    hardware = "" if ram is None else f", memories: [{{name: RAM, kind: SRAM, size: {ram} B}}]"
    rows = "\n".join(SUBSCRIPTION.format(name=name, size=size, more=more) for name in names)
    return APP.format(hardware=hardware, slots=slots, subscriptions=rows)


def help_of(author, rule, text):
    (finding,) = (each for each in author.describe(text).findings if each.rule == rule)
    return finding.help


def test_the_slots_that_fit_are_advised(author):
    text = help_of(author, "UR120", app(REST + 4 * SLOT))
    assert "Set RMW_UXRCE_MAX_HISTORY to the number that 'amuros generate' computes" in text
    assert f"A slot takes {SLOT} B, and 4 slots fit in the {REST + 4 * SLOT} B of the board" in text
    assert "the stacks of A, B, C and Executor_Task are not stated" in text
    assert "3 slots fit" in help_of(author, "UR120", app(REST + 4 * SLOT - 1))


def test_no_value_is_advised_that_does_not_fit(author):
    # Half the MTU takes 256 B x 10 less for the session, and 256 B x 4 + 64 B for a slot: 2559 B more and 6335 B are room for 8 slots.
    ram = REST + 3 * SLOT - 1
    text = help_of(author, "UR120", app(ram))
    assert "Set RMW_UXRCE_MAX_HISTORY" not in text
    assert f"No value of RMW_UXRCE_MAX_HISTORY is enough: at least 3 slots of {SLOT} B are needed, but 2 slots fit" in text
    assert "Set UCLIENT_CUSTOM_TRANSPORT_MTU to 256, with which 8 slots fit" in text
    assert "smaller 'depth'" in text


def test_with_long_messages_a_smaller_mtu_is_no_remedy(author):
    # Best-effort messages are not cut into fragments: 496 B and 12 B of headers need nearly all of the 512 B.
    text = help_of(author, "UR120", app(REST + 2 * SLOT, size=496, more=", reliability: best-effort"))
    assert "No value" in text
    assert "UCLIENT_CUSTOM_TRANSPORT_MTU" not in text


def test_memory_that_is_not_known_is_said_to_be_so(author):
    text = help_of(author, "UR120", app())
    assert f"A slot takes {SLOT} B, and the memory of the board is not stated" in text


@pytest.mark.parametrize(("ram", "advice"), [(REST + 20 * SLOT, "20 slots fit"), (REST + 4 * SLOT, "at least 11 slots")])
def test_a_deep_history(author, ram, advice):
    assert advice in help_of(author, "UR125", app(ram, "A", more=", depth: 11"))


def test_too_many_slots_are_reduced_to_those_that_fit(author):
    assert "2 slots fit" in help_of(author, "UR129", app(REST + 2 * SLOT, "AB", slots=8))


def test_a_file_of_build_options(tmp_path):
    description, meta = tmp_path / "app.yaml", tmp_path / "colcon.meta"
    description.write_text(app(REST + 2 * SLOT))
    arguments = ["-DRMW_UXRCE_MAX_HISTORY=1"]
    meta.write_text(json.dumps({"names": {"rmw_microxrcedds": {"cmake-args": arguments}}}))
    (finding,) = (each for each in check_colcon_meta(description, meta).findings if "MAX_HISTORY" in each.message)
    assert "No value of RMW_UXRCE_MAX_HISTORY is enough" in finding.help


def test_generated_options_that_do_not_fit(tmp_path):
    description = tmp_path / "app.yaml"
    description.write_text(app(5552 + 1000 + 2 * SLOT))
    (finding,) = (each for each in generate(description).findings if each.rule == "UR129")
    assert "No value of RMW_UXRCE_MAX_HISTORY is enough" in finding.help
    description.write_text(app(5552 + 1500 + 3 * SLOT, slots=8))
    assert [each for each in generate(description).findings if each.rule == "UR129"] == []


LOOP = """\
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz, memories: [{{name: RAM, kind: SRAM, size: {ram} B}}]}}
middleware:
  executor: {{loop: {{spin_some: 100 ms}}}}
  limits: {{RMW_UXRCE_MAX_HISTORY: 1}}
application:
  nodes:
    - name: node
      publishers: [{{topic: out, message_size: 4 B}}]
      timers: [{{name: T, period: 100 ms, execution_time: 1 ms, publishes: [out]}}]
      subscriptions:
        - {{name: A, topic: a, message_size: 4 B, interval: 50 ms, execution_time: 1 ms}}
        - {{name: B, topic: b, message_size: 4 B, interval: 50 ms, execution_time: 1 ms}}
"""


@pytest.mark.parametrize(("slots", "advice"), [(1, "No value of RMW_UXRCE_MAX_HISTORY is enough"), (60, "60 slots fit")])
def test_messages_that_the_analysis_finds_to_be_dropped(slots, advice):
    found = {each.help for each in analyze(LOOP.format(ram=REST + slots * SLOT)).findings if each.rule == "EXE014"}
    assert len(found) == 1
    assert advice in found.pop()
