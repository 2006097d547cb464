"""The page of a report, and its summary: the verdict first, every result of the analysis in it, and nothing from elsewhere."""

import re
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest
from effort import every
from hand_made_systems import Proc, system, ticks
from lxml import html
from support import ROOT, analysis_of

from amalthea_uros import Settings, am, load, report, save
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.perf.activities import Migrate
from amalthea_uros.perf.constraints import Bound, Constraints, Requirement, TimeLimit, TimeMetric
from amalthea_uros.report.basics.document import table
from amalthea_uros.report.wording.chains import value_text
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.units import MILLISECOND, Duration, Rounding, rounded_time_text

SAMPLES = ROOT / "samples"
ADVANCED = SAMPLES / "bodas-test-advanced.yaml"
#: The worst phase of the message: the page is the same, but for that it is assumed, and made in no time.
PHASE = Settings(phases={"Message_Factor": "1 ms"})
EXECUTOR = SAMPLES / "executor.amxmi"
ALL = every(3, sorted([*SAMPLES.glob("*.yaml"), EXECUTOR]))
#: Elements of HTML that have no end tag.
VOID = {"meta", "link", "br", "hr", "img", "input"}


@cache
def page_of(path, **options):
    return report(path, **{"duration": "100 ms"} | options).html


def parsed(page):
    return html.document_fromstring(page)


def text(node):
    return " ".join(node.text_content().split())


def section(page, anchor):
    (found,) = parsed(page).xpath(f"//section[@id='{anchor}']")
    return found


def rows(page, anchor, caption):
    (found,) = section(page, anchor).xpath(f".//table[starts-with(normalize-space(caption), '{caption}')]")
    heads = [text(cell) for cell in found.xpath("./thead/tr/*")]
    shown, name = {}, ""
    for row in found.xpath("./tbody/tr"):
        # A long remark has a row of its own below the others.
        if row.get("class") == "remark":
            shown[name][heads[-1]] = text(row)
        else:
            name = text(row[0])
            shown[name] = dict(zip(heads, map(text, row), strict=True))
    return shown


@pytest.mark.parametrize("path", ALL, ids=lambda path: path.name)
def test_the_verdict_is_the_first_section(path):
    first = parsed(page_of(path)).xpath("//main/section")[0]
    assert first.get("id") == "verdict"
    answer, line = map(text, first.xpath("./p"))
    # The answer is about what the closing line names, or about its chain.
    assert " limit " in answer
    assert line == closing_line(analysis_of(path).summary)


@pytest.mark.parametrize("path", ALL, ids=lambda path: path.name)
def test_every_requirement_and_response_time_is_there_as_analysed(path):
    analysis = analysis_of(path)
    judged = rows(page_of(path), "requirements", "Deadlines")
    for requirement in analysis.requirements:
        row = judged[requirement.name]
        assert row["verdict"].endswith(requirement.verdict)
        if requirement.value is None:
            assert row["value"] == "unknown"
            continue
        rounding = Rounding.UP if requirement.is_upper else Rounding.DOWN
        # Where the verdict is unknown, the least possible value is shown, too.
        assert row["value"].split(" to ")[-1] == rounded_time_text(requirement.value, rounding, requirement.limit)
        is_judged = requirement.verdict != "unknown"
        assert row["margin"] == (rounded_time_text(requirement.margin, Rounding.DOWN) if is_judged else "-")
    shown = rows(page_of(path), "response-times", "Response times by core")
    for process in analysis.processes:
        assert shown[process.name]["worst"] == rounded_time_text(process.response.worst, Rounding.UP, process.deadline)


@pytest.mark.parametrize("path", ALL, ids=lambda path: path.name)
def test_every_chain_is_there_as_analysed(path):
    chains = analysis_of(path).chains
    if chains:
        shown = rows(page_of(path), "requirements", "Latencies")
        for chain in chains:
            value = chain.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)
            # Of a way, the page says in words that it is unknown.
            assert shown[chain.name]["reaction time"] in {value_text(value), *(["unknown"] if value is None else [])}


def test_the_reaction_time_of_the_thesis_is_explained_hop_by_hop():
    # The thesis has at most 19.978 ms for what was measured; by hand: 20 ms until the next message, and 25 us and 4 us to execute.
    hops = rows(page_of(ADVANCED), "chains", "Hops of factor-to-output")
    # The last row is their sum.
    assert [float(hop["wait"].split()[0]) for hop in hops.values()] == [0, 19.0, 1.007, 20.0]
    assert rows(page_of(ADVANCED), "requirements", "Latencies")["factor-to-output"]["limit"] == "reaction ≤ 25 ms"


@pytest.mark.parametrize("path", ALL, ids=lambda path: path.name)
def test_nothing_is_loaded_from_elsewhere(path):
    page = page_of(path)
    tree = parsed(page)
    assert tree.xpath("//link | //img | //iframe | //script[@src] | //object | //embed | //base") == []
    assert re.findall(r"url\((?!#)|@import", page) == []
    addresses = re.findall(r"https?://[^\s\"'<)]+", page)
    assert {address for address in addresses if "www.w3.org" not in address} <= set(tree.xpath("//a/@href"))


@pytest.mark.parametrize("path", ALL, ids=lambda path: path.name)
def test_elements_are_nested_and_references_lead_somewhere(path):
    page = page_of(path)
    body = re.sub(r"<(script|style)>.*?</\1>", "", page, flags=re.DOTALL)
    opened = []
    for end, name, empty in re.findall(r"<(/?)([a-zA-Z][\w]*)\b[^>]*?(/?)>", body):
        if end:
            assert opened.pop() == name
        elif not empty and name.lower() not in VOID:
            opened.append(name)
    assert opened == []
    tree = parsed(page)
    ids = tree.xpath("//@id")
    assert len(ids) == len(set(ids))
    assert {link[1:] for link in tree.xpath("//a/@href") if link.startswith("#")} <= set(ids)
    assert set(re.findall(r"url\(#([^)]*)\)", page)) <= set(ids)
    levels = [int(heading.tag[1]) for heading in tree.xpath("//h1 | //h2 | //h3")]
    assert levels[0] == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))
    assert all(picture.get("role") == "img" for picture in tree.xpath("//*[local-name()='svg']"))


HOSTILE = "</script><b>\"&'\n😀]]>" + "x" * 200


def test_names_are_text_wherever_they_are(tmp_path):
    model = load(EXECUTOR)
    plain = parsed(report(model, duration="100 ms").html)
    for kind in (am.EventChain, am.Label, am.Runnable, am.Task, am.ProcessRequirement, am.PeriodicStimulus, am.ProcessingUnit):
        for number, each in enumerate(model.all(kind)):
            each.name = f"{number}{HOSTILE}{kind.__name__}"
    path = tmp_path / "a\"&'<b>😀.amxmi"
    save(model, path)
    hostile = parsed(report(path, duration="100 ms", title=HOSTILE).html)
    for tag in ("script", "b", "table", "h2", "details"):
        assert len(hostile.xpath(f"//{tag}")) == len(plain.xpath(f"//{tag}"))
    assert "</script><b>" in text(hostile.xpath("//h1")[0])


def test_a_distribution_of_one_value_is_a_sentence():
    # The taking of messages depends on nothing: each job of it is delayed by 16 us, and takes 2 us.
    shown = section(page_of(ADVANCED), "histograms")
    assert "The response time of Message_Factor was 18 us in all" in text(shown)


def test_what_would_shorten_the_worst_chain_is_told_if_its_limit_is_missed():
    shown = text(
        section(report(ADVANCED, changes={"factor-to-output.reaction": "10 ms"}, with_simulation=False).html, "chains")
    )
    assert "What would shorten it" in shown
    assert "analysed, one at a time" in shown


def test_no_change_is_tried_while_all_limits_are_met():
    shown = text(section(page_of(ADVANCED), "chains"))
    assert "What would shorten the latency is tried by amuros analyze --explain factor-to-output." in shown


def test_a_percentage_stays_in_one_line():
    cells = [cell.text_content() for cell in parsed(page_of(EXECUTOR)).xpath("//td")]
    assert any("\N{NO-BREAK SPACE}%" in cell for cell in cells)
    assert [cell for cell in cells if " %" in cell] == []


def test_hidden_characters_are_shown():
    content = report(SAMPLES / "bodas-test-simple.yaml", with_simulation=False, title="a\u202eb")
    assert "a\\u202eb" in content.html
    assert "\u202e" not in content.html


def test_a_model_without_anything_is_unknown(tmp_path):
    path = tmp_path / "empty.amxmi"
    path.write_text(
        '<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0"/>'
    )
    page = report(path).html
    assert "Not proved schedulable" in text(section(page, "verdict"))


def test_what_fails_and_what_is_unknown_comes_first():
    page = report(
        ADVANCED.with_suffix(".amxmi"), PHASE, changes=("Control_Function.execution_time=2ms",), duration="100 ms"
    ).html
    verdict = text(section(page, "verdict"))
    assert "Not schedulable" in verdict
    # 2 ms in each ms, and 12 us, and now and then 13 us more.
    assert "need 201.3 %" in verdict
    shown = [row["verdict"].split()[-1] for row in rows(page, "requirements", "Deadlines").values()]
    assert shown == ["overload", "missed", "unknown", "met"]
    assert rows(page, "changes", "Changed values")["Control_Function.execution_time"]["after"] == "2 ms"
    assert rows(page, "changes", "Results before")["system"]["after"] == "no"


def test_a_reason_that_several_limits_have_is_told_once():
    unknown = Proc("I", (Migrate(scheduler="s0"),), 10, priority=9)
    tasks = (Proc(f"T{number}", (ticks(1),), 50, priority=number) for number in range(1, 7))
    opening = text(section(page_of(system(unknown, *tasks)), "verdict"))
    assert opening.count("depends on 'I', which could not be analysed") == 1
    assert "T1, T2, T3, T4 and 2 more" in opening


@pytest.mark.parametrize("body", [(ticks(100),), ()], ids=["one of two", "both"])
def test_a_task_that_cannot_be_simulated_is_named(body):
    limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=5 * MILLISECOND)
    constraints = Constraints(requirements=(Requirement(name="R", process="B", limit=limit),))
    left_out = replace(system(Proc("A", body, 10_000, priority=2), Proc("B", (), 10_000, priority=1)), constraints=constraints)
    assert "'B' is not simulated: it has no execution time" in text(parsed(report(left_out).html))


def test_the_same_input_gives_the_same_page():
    assert report(EXECUTOR, duration="100 ms").html == page_of(EXECUTOR)
    assert "2026-01-31" in report(EXECUTOR, with_simulation=False, date="2026-01-31").html


def test_the_pools_of_an_app_are_ready_to_copy():
    (listing,) = section(page_of(ADVANCED), "pools").xpath(".//pre")
    # One node with one subscription and one timer; the executor has a wait set.
    counts = {"SESSIONS": 1, "NODES": 1, "TOPICS": 1, "PUBLISHERS": 0, "SUBSCRIPTIONS": 1}
    counts |= {"SERVICES": 0, "CLIENTS": 0, "WAIT_SETS": 1, "GUARD_CONDITION": 1, "HISTORY": 1}
    assert re.findall(r"-DRMW_UXRCE_MAX_(\w+)=(\d+)", listing.text_content()) == [
        (name, str(count)) for name, count in counts.items()
    ]


def test_long_tables_are_folded():
    rows = [(f"thing {number}", str(number), "") for number in range(180)]
    long = table("Things", ("name", ">number", "nothing"), rows).compact
    assert [column.title for column in long.columns] == ["name", "number"]
    assert (len(long.shown), len(long.folded)) == (15, 165)
    assert len(table("Things", ("name",), [("x",)] * 30).folded) == 0


def test_a_system_and_a_model_are_reported_like_a_file():
    model = load(EXECUTOR)
    assert Path(model.documents[0].path).name in report(model, with_simulation=False).html
    assert "not systems of the library" in report(analysis_of(EXECUTOR).solution.context.system, with_simulation=False).html


def test_pictures_from_kept_events_are_those_of_repeated_runs():
    # Without a duration, the run keeps its events.
    chosen = report(ADVANCED, PHASE)
    stated = report(ADVANCED, PHASE, duration=Duration(chosen.content.simulation.options.duration))
    first, second = (section(each.html, "worst-observed") for each in (chosen, stated))
    assert html.tostring(first) == html.tostring(second)


#: What GitHub accepts.
MOST = 65_536


def test_it_fits_in_a_comment_whatever_the_names_are(tmp_path):
    model = load(EXECUTOR)
    for number, task in enumerate(model.all(am.Task)):
        task.name = "|" * 70_000 + str(number)
    save(model, tmp_path / "long.amxmi")
    assert len(report(tmp_path / "long.amxmi", with_simulation=False).markdown) < MOST


def test_names_are_no_markup(tmp_path):
    model = load(EXECUTOR)
    model[am.Task, "Executor_Task"].name = "a|b <i>`c`\n# d"
    save(model, tmp_path / "names.amxmi")
    shown = report(tmp_path / "names.amxmi", with_simulation=False).markdown
    (line,) = (line for line in shown.splitlines() if line.startswith("| a"))
    assert line.startswith(r"| a\|b \<i\>\`c\`\n# d |")


def test_a_summary_says_what_its_verdict_is_subject_to(tmp_path):
    # No data flow leads from the callback to the control function: the latency is unknown.
    text = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text().replace("reads: [memory_2, input]", "reads: [input]")
    (tmp_path / "gap.yaml").write_text(text)
    found = report(tmp_path / "gap.yaml").markdown
    verdict, requirements = found.index("Not proved schedulable: "), found.index("### 4 requirements")
    assert verdict < found.index("- CHN002 warning: ") < requirements
    (row,) = [line for line in found.splitlines() if line.startswith("| factor-to-output_reaction")]
    assert "| unknown | ≤ 25 ms |" in row


def test_executors_of_the_host_have_bounds_beside_observed_values_and_the_loads_of_their_cores():
    shown = section(page_of(SAMPLES / "robot-with-host.yaml", duration="2 s"), "host")
    threads, control, *_ = shown.xpath(".//table")
    perception = [text(each) for each in threads.xpath(".//tr")[-1].xpath("./*")]
    assert perception[:5] == ["perception", "multi-threaded", "3", "fifo, priority 60", "pc/core 1, pc/core 2, pc/core 3"]
    assert sum(float(each.removesuffix(" %")) for each in perception[5].split(", ")) < 100
    # On_Pose is called for each odometry: the bound is 4.8 ms, and what a run shows is less, and not lost.
    row = next(each for each in control.xpath(".//tr") if "On_Pose" in text(each))
    cells = [text(each) for each in row.xpath("./*")]
    assert cells[:5] == ["On_Pose", "subscription", "-", "300 us", "4.8 ms"]
    calls, longest, lost = cells[5:8]
    assert int(calls) > 10
    assert float(longest.split()[0]) < 4.8
    assert lost == "0"
