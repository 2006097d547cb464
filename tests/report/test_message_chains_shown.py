"""Chains over wires and executors in tables, pages and summaries."""

import pytest

import amalthea_uros as amuros

WAY = """
amuros: 1
name: way
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {name: Executor, loop: {spin_some: 100 ms, sleep: 10 ms}, execution_time: 10 us}
  transport: {serial: {baud_rate: 115200}}
  agent: {to_controller: LATENCY}
application:
  nodes:
    - name: node
      subscriptions: [{name: drive, topic: cmd_vel, rate: 4 Hz, message_size: 48 B, execution_time: 100 us}]
chains: [{name: command, path: [/cmd_vel, drive]}]
"""


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    path = tmp_path_factory.mktemp("way") / "way.yaml"
    path.write_text(WAY.replace("LATENCY", "1 ms"))
    return amuros.report(path, with_simulation=False)


def test_a_chain_has_a_row_for_each_hop(shown):
    (chain,) = shown.content.analysis.chains
    rows = chain.hops.to_records()
    assert [row["kind"] for row in rows] == ["agent", "wire", "executor"]
    assert sum(row["worst_ps"] for row in rows) == chain.worst
    assert sum(row["share"] for row in rows) == pytest.approx(1)


def test_the_handles_of_an_executor_are_rows(shown):
    (row,) = shown.content.analysis.executors.to_records()
    assert (row["executor"], row["name"], row["kind"]) == ("Executor", "drive", "subscription")
    assert "terms" not in row


def test_a_page_has_the_latency_and_the_hops(shown):
    page = shown.html
    assert page.index('id="message-chains"') < page.index("Latency of messages, end to end") < page.index("Hops of command")
    for text in ("agent: Agent", "wire: Serial", "executor: Executor", "sleep"):
        assert text in page


def test_a_summary_has_the_latency(shown):
    (line,) = [line for line in shown.markdown.splitlines() if line.startswith("| command | /cmd_vel |")]
    (chain,) = shown.content.analysis.chains
    assert amuros.units.rounded_time_text(chain.worst, amuros.units.Rounding.UP) in line
    assert "most of it: messages before it (executor Executor)" in line


def test_a_latency_that_is_unknown_is_none(tmp_path):
    path = tmp_path / "way.yaml"
    path.write_text(WAY.replace("  agent: {to_controller: LATENCY}\n", ""))
    (chain,) = amuros.analyze(path).chains
    agent, *_ = chain.hops.to_records()
    assert (agent["kind"], agent["worst_ps"], agent["share"]) == ("agent", None, None)
    assert agent["reason"]
    assert agent["remedy"]
    report = amuros.report(path, with_simulation=False)
    assert agent["remedy"] in report.html.replace("&#39;", "'")
    assert "unknown" in next(line for line in report.markdown.splitlines() if line.startswith("| command |"))
