"""`amuros optimize`: what it shows, writes and refuses, and how it ends."""

import json
import re
import sys

import pytest
from command import amuros
from support import ROOT

from amalthea_uros import diff
from amalthea_uros.cli.main import main
from amalthea_uros.cli.patience import Progress

SAMPLE = ROOT / "samples" / "bodas-test-advanced.yaml"
LIMIT = ("--limit", "factor-to-output.max_reduced_reaction_time<11ms")


def test_the_smallest_change_that_meets_a_limit():
    run = amuros("optimize", SAMPLE, *LIMIT, "--proposals", "1")
    assert run.returncode == 0
    assert "Message_Factor.period: 20 ms -> 1 ms" in run.stdout
    # Thesis, table 6.5: 20.029 ms; with the callback every 1 ms, 1.016 ms (design.json).
    assert re.search(r"20\.03 ms +1\.016 ms +< 11 ms +9\.984 ms +missed -> met", run.stdout)
    assert f"amuros analyze {SAMPLE} --set Message_Factor.task_period=1ms" in run.stdout
    assert run.stdout.splitlines()[-1].startswith("Optimal: ")


def test_that_none_exists_is_proved_and_is_a_failure():
    run = amuros("optimize", SAMPLE, *LIMIT, "--keep", "Message_Factor")
    assert run.returncode == 1
    assert run.stdout.splitlines()[-1].startswith("None exists: ")


def test_nothing_needs_to_change():
    run = amuros("optimize", SAMPLE)
    assert run.returncode == 0
    assert "Nothing needs to change" in run.stdout.splitlines()[-1]


def test_what_is_unknown_now_is_shown_with_its_cause_and_not_at_full_length(tmp_path):
    path = tmp_path / "app.amxmi"
    tasks = "".join(f"  - {{name: T{number}, period: 1 ms, execution_time: 1 us}}\n" for number in range(9))
    path.with_suffix(".yaml").write_text(f"amuros: 1\nname: one\nhardware: single-core\ntasks:\n{tasks}")
    amuros("build", path.with_suffix(".yaml"), "-o", path)
    path.write_text(re.sub("<taskAllocation .*?</taskAllocation>", "", path.read_text(), flags=re.DOTALL))
    question = amuros("optimize", path).stdout.partition("\n\n")[0]
    assert "may change  nothing: allow more with --vary or --offer\n" in question
    assert (
        "now         unknown: T0.response time, period; T1.response time, period; T2.response time, period and 6 more\n"
        in question
    )
    assert question.endswith("Not proved schedulable: 9 of 9 are unknown, because of 'T0': it is not allocated to a scheduler")


def test_where_nothing_but_deadlines_is_demanded_the_option_for_more_is_named(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text("amuros: 1\nname: one\nhardware: single-core\ntasks:\n  - {name: A, period: 1 ms, execution_time: 1 us}\n")
    run = amuros("optimize", path)
    assert run.returncode == 0
    assert "nothing else is demanded (add what must hold with --limit)" in run.stdout.splitlines()[-1]


def test_a_search_that_is_cut_off_proves_nothing():
    run = amuros("optimize", SAMPLE, *LIMIT, "--keep", "Message_Factor.period", "--designs", "2")
    assert run.returncode == 1
    assert run.stdout.splitlines()[-1].startswith("None found, which proves nothing: ")


@pytest.mark.parametrize("name", ["better.yaml", "better.amxmi"])
def test_the_written_proposal_is_what_was_proved(name, tmp_path):
    target, result = tmp_path / name, tmp_path / "result.json"
    run = amuros("optimize", SAMPLE, *LIMIT, "--output", f"json={result}", "-o", target)
    assert run.returncode == 0
    (proposal, *_) = json.loads(result.read_text())["proposals"]
    assert proposal["changes"] == [
        {"key": "Message_Factor.period", "from": "20 ms", "to": "1 ms", "consequence": False},
    ]
    changes = [str(difference) for change in diff(SAMPLE, target).timing for difference in change.differences]
    assert changes == ["Message_Factor.period: 20 ms -> 1 ms"]


def test_a_description_keeps_its_comments(tmp_path):
    target = tmp_path / "better.yaml"
    amuros("optimize", SAMPLE, *LIMIT, "-o", target)
    assert [line for line in target.read_text().splitlines() if line.startswith("#")] == [
        line for line in SAMPLE.read_text().splitlines() if line.startswith("#")
    ]


def test_the_pareto_front_is_drawn(tmp_path):
    target = tmp_path / "front.svg"
    run = amuros("optimize", SAMPLE, "--vary", "periods", "--goal", "latency", "--goal", "load", "--pareto", target)
    assert run.returncode == 0
    assert "3 on the front" in target.read_text()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--limit", "factor-to-output<11ms"), "does not name an object and a key"),
        (("--limit", "factor-to-output.max_reduced_reaction_time"), "is not of the form OBJECT.QUANTITY<=VALUE"),
        (("--limit", "factor-to-output.latency<11ms"), "has no 'latency'; expected one of max_reaction_time"),
        (("--limit", "factor.max_reaction_time<11ms"), "unknown chain, process or core 'factor'"),
        (("--limit", "Core_0.load<=0.5"), "is not a percentage"),
        (("--goal", "speed"), "unknown goal 'speed'; expected one of latency, load, balance, jitter, changes"),
        (("--vary", "colours"), "colours"),
        (("--keep", "Nobody.period"), "unknown object to keep 'Nobody'"),
        (("--offer", "Nobody.period=1ms"), "unknown object 'Nobody'"),
        (("--offer", "Message_Factor.period=1ms", "--keep", "Message_Factor"), "is both on offer and kept"),
        (("-o", "none/better.yaml"), "none"),
    ],
)
def test_wrong_use_is_explained(arguments, words):
    run = amuros("optimize", SAMPLE, *arguments)
    assert run.returncode == 2
    assert words in run.stderr
    assert "Traceback" not in run.stderr


def test_a_proposal_that_does_not_exist_is_not_written(tmp_path):
    target = tmp_path / "better.yaml"
    run = amuros("optimize", SAMPLE, *LIMIT, "-o", target, "--proposal", "7")
    assert run.returncode == 2
    assert "there is no proposal 7" in run.stderr
    assert not target.exists()


@pytest.fixture
def interrupted(monkeypatch, capsys):
    """Calls the command in this process, and interrupts it after some designs; gives the exit code, and what it wrote."""

    def call(designs, *arguments):
        def reach(_progress, done):
            if done == designs:
                raise KeyboardInterrupt

        monkeypatch.setattr(Progress, "reach", reach)
        monkeypatch.setattr(sys, "argv", ["amuros", "optimize", *map(str, arguments), "--jobs", "1"])
        with pytest.raises(SystemExit) as ending:
            main()
        return ending.value.code, *capsys.readouterr()

    return call


def test_an_interrupted_search_replaces_no_file_of_a_finished_one(interrupted, tmp_path):
    json_file, svg, yaml = files = [tmp_path / name for name in ("r.json", "front.svg", "better.yaml")]
    for path in files:
        path.write_text("of a finished search")
    periods = ("--vary", "periods", "--goal", "latency")
    to_files = ("--output", f"json={json_file}", "--output", "text", "--pareto", svg, "-o", yaml)
    code, output, errors = interrupted(3, SAMPLE, *periods, *to_files)
    assert (code, [path.read_text() for path in files]) == (130, 3 * ["of a finished search"])
    partial = {path: path.with_suffix(f".partial{path.suffix}") for path in files}
    assert json.loads(partial[json_file].read_text())["ended"] == "interrupted"
    assert "<svg" in partial[svg].read_text()
    assert "amuros: 1" in partial[yaml].read_text().splitlines()
    assert f"the result is not complete; it is in '{partial[json_file]}'" in errors
    assert "interrupted" in output


def test_an_interrupted_search_does_not_replace_what_it_reads(interrupted, tmp_path):
    model = tmp_path / "better.partial.yaml"
    model.write_text(SAMPLE.read_text())
    code, _, errors = interrupted(3, model, "--vary", "periods", "--goal", "latency", "-o", tmp_path / "better.yaml")
    assert code == 2
    assert "would replace a file that is read" in errors
    assert model.read_text() == SAMPLE.read_text()


def test_a_search_that_is_interrupted_before_it_finds_anything_writes_no_proposal(interrupted, tmp_path):
    code, _, errors = interrupted(1, SAMPLE, *LIMIT, "-o", tmp_path / "better.yaml")
    assert code == 130
    assert "Error" not in errors
    assert list(tmp_path.iterdir()) == []
