"""Results as records, data frames, text, and HTML."""

import json
import pickle
from copy import deepcopy
from html.parser import HTMLParser
from io import StringIO

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.report import formats
from amalthea_uros.units import Duration

YAML = ROOT / "samples" / "bodas-test-advanced.yaml"
#: The worst phase of the message: its chain is analysed much faster, and no form of a result is another one.
PHASE = amuros.Settings(phases={"Message_Factor": "1 ms"})
MODEL = ROOT / "samples" / "executor.amxmi"


@pytest.fixture(scope="module")
def analysis():
    return amuros.analyze(YAML, PHASE)


@pytest.fixture(scope="module")
def simulation():
    return amuros.simulate(YAML, "100 ms")


def written(result, name):
    stream = StringIO()
    formats.write(name, result, stream)
    return stream.getvalue()


def test_records_have_the_names_and_values_of_the_json_output(analysis):
    content = json.loads(written(amuros.analyze_files(YAML, PHASE), "json"))
    for record, process in zip(analysis.to_records(full=True), content["processes"], strict=True):
        plain = {key: value for key, value in process.items() if not isinstance(value, dict | list)}
        assert record.items() >= plain.items()
        assert record["terms.own_ps"] == process["terms"]["own_ps"]
        assert record["metrics.response_time.max_ps"] == process["metrics"]["response_time"]["max_ps"]
    for record, requirement in zip(analysis.requirements.to_records(), content["requirements"], strict=True):
        assert record == requirement


def test_a_chain_has_a_row_for_each_latency(analysis):
    rows = {row["quantity"]: row for row in analysis.chains.to_records()}
    assert rows["max_reduced_reaction_time"]["value_ps"] == amuros.parse_time("20.029 ms")
    assert {row["name"] for row in rows.values()} == {"factor-to-output"}


def test_a_chain_without_values_has_a_row_with_the_reason():
    system = amuros.taskset([(5, 6), (10, 1)], unit="ms", chains={"c": ["T1", "T2"]})
    (row,) = amuros.analyze(system).chains.to_records()
    assert (row["name"], row["value_ps"]) == ("c", None)
    assert row["reason"]


def test_tables_are_small_unless_all_columns_are_asked_for(analysis, simulation):
    for result in (analysis, analysis.processes[0], simulation.processes, simulation.chains):
        small, full = result.to_records(), result.to_records(full=True)
        assert len(small[0]) < 12 < len(full[0])
        assert all(row.items() <= every.items() for row, every in zip(small, full, strict=True))


def test_unknown_values_have_the_same_columns():
    # A needs 6 ms every 5 ms.
    rows = amuros.analyze(amuros.taskset([(1, 0.1), (5, 6)], unit="ms", priorities="rate monotonic")).to_records()
    assert [list(row) for row in rows] == [list(rows[0])] * 2
    assert [(row["wcrt_ps"], row["claim"]) for row in rows] == [(10**8, "bound"), (None, "bound")]


def test_why_as_a_table(analysis):
    # The parts add up to the value: thesis, section 6.1: 12 + 13 of the executor, 4 of its own
    parts = amuros.explain(analysis, "Control_Function").to_records()
    assert sum(part["time_ps"] for part in parts) == amuros.parse_time("29 us")
    # In this phase, a message is taken just after Message_Factor.
    parts = amuros.explain(analysis, "factor-to-output").to_records()
    assert sum(part["time_ps"] for part in parts) == amuros.parse_time("20.029 ms")
    for quantity in ("max_data_age", "max_reaction_time"):
        parts = amuros.explain(analysis, "factor-to-output", amuros.LatencyQuantity(quantity)).to_records()
        assert sum(part["time_ps"] for part in parts) == analysis.chains[0].value(amuros.LatencyQuantity(quantity)).value


def test_what_cannot_be_explained(analysis):
    for ask in (amuros.explain, amuros.improvements):
        with pytest.raises(amuros.InvalidArgumentError, match=r"unknown .*'factor'"):
            ask(analysis, "factor")
        with pytest.raises(
            amuros.InvalidArgumentError, match="cannot explain 'max_first_to_last'; expected one of max_reaction"
        ):
            ask(analysis, "factor-to-output", amuros.LatencyQuantity.MAX_FIRST_TO_LAST)


def everything(analysis, simulation):
    yield from (amuros.sensitivity(analysis), *amuros.propose_priorities(analysis), amuros.build(YAML))
    yield from (amuros.explain(analysis, "Control_Function"), amuros.explain(analysis, "factor-to-output"))
    shorter = amuros.improvements(analysis, "factor-to-output")
    assert all(row["after_ps"] < row["before_ps"] == amuros.parse_time("20.029 ms") for row in shorter.to_records())
    yield from (shorter, amuros.migrate(MODEL, "3.3.0"))
    yield from (analysis, analysis.processors, analysis.processes, analysis.callbacks, analysis.chains, analysis.requirements)
    yield from (analysis.processes[0], analysis.chains[0], amuros.analyze_files(YAML, PHASE))
    yield from (simulation, simulation.processes, simulation.chains, simulation.cores, simulation.requirements)
    yield from (amuros.check_files(MODEL), amuros.diff(MODEL, ROOT / "samples" / "bodas-test-advanced.amxmi"))
    yield amuros.simulate_campaign(YAML, amuros.Options(duration=Duration(10**9)), repetitions=2, workers=1)


class Tags(HTMLParser):
    """Refuses tags that do not close each other."""

    def __init__(self):
        super().__init__()
        self.open, self.seen = [], set()

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        self.seen.add(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_every_result_is_plain_rows_a_text_and_a_page(analysis, simulation):
    for result in everything(analysis, simulation):
        rows = result.to_records()
        assert all(isinstance(value, str | int | float | None) for row in rows for value in row.values())
        json.dumps(rows)
        assert str(result)
        assert len(repr(result)) < 700 or not isinstance(result, amuros.Analysis | amuros.Simulation)
        page = Tags()
        page.feed(result._repr_html_())
        assert not page.open
        assert page.seen <= {"div", "p", "b", "table", "thead", "tbody", "tr", "th", "td"}


def test_data_frames(analysis):
    pytest.importorskip("pandas")
    frame = analysis.to_dataframe().set_index("name")
    assert frame.loc["Control_Function", "wcrt_ps"] == amuros.parse_time("29 us")


def test_without_pandas_the_message_says_what_to_install(analysis, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pip install amuros\[pandas\]"):
        analysis.to_dataframe()


def test_print_gives_what_the_command_line_prints(analysis):
    assert str(analysis) == written(amuros.analyze_files(YAML, PHASE), "text").strip("\n")


def test_names_are_escaped():
    task = amuros.task("<script>alert(1)</script>", period="1 ms", wcet="1 us", priority=1)
    analysis = amuros.analyze(amuros.taskset([task]))
    for result in (analysis, analysis.processes, analysis.processes[0]):
        page = result._repr_html_()
        assert "<script" not in page
        assert "&lt;script&gt;" in page


def test_findings_are_shown():
    model = amuros.load(MODEL)
    model[amuros.am.Task, "Message_Factor"].stimuli = [amuros.am.CustomStimulus(name="elsewhere")]
    analysis = amuros.analyze(model)
    assert analysis.findings[0].message in str(analysis)


def test_settings_are_not_changes(analysis):
    with pytest.raises(TypeError, match=r"expected Settings, not dict; changes of values are given as changes=\.\.\."):
        amuros.analyze(YAML, {"Control_Function.period": "2 ms"})


def test_results_of_other_processes():
    # multiprocessing passes them on
    analysis = amuros.analyze(amuros.taskset([(5, 1), (10, 2)], unit="ms", priorities="rate monotonic"))
    for copy in (pickle.loads(pickle.dumps(analysis)), deepcopy(analysis)):
        assert copy == analysis
        assert str(copy) == str(analysis)


def test_short_texts(analysis, simulation):
    assert repr(analysis) == "<Analysis of 3 processes, 1 chain, 2 requirements; schedulable: yes>"
    assert repr(analysis.processes) == "<Results: Executor_Task, Message_Factor, Control_Function>"
    assert repr(analysis["Control_Function"]) == "<ProcessResult Control_Function: response time 29 us, deadline 1 ms, met>"
    assert "max reduced reaction time 20.029 ms (exact)" in repr(analysis.chains[0])
    assert repr(amuros.analyze(amuros.taskset([])).processes) == "<Results: none>"
