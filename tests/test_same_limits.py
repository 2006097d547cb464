"""All commands that judge limits judge the same ones, and none says that a limit is met where another one does not."""

import json

import pytest
from command import amuros
from support import SHARED

from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.simulate import simulate_files
from amalthea_uros.simulate.options import Options
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration

FOLDER = SHARED / "vectors" / "verdicts"
#: Their only stimulus has no minimum distance: the analysis says that this is unknown, although no limit is stated.
WITHOUT_LIMIT = ("zero-with-unit", "zero-without-unit")
MODELS = sorted(FOLDER.glob("*.amxmi")) or [pytest.param(None, marks=pytest.mark.skip("the files are not at hand"))]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path and path.stem)
def test_analysis_and_simulation_judge_the_same_limits(path):
    if path.stem in WITHOUT_LIMIT:
        return
    analysis = analyze_files(path).analysis
    simulation = simulate_files(path, Options(duration=Duration(MS))).simulation
    judged = [*(each for each in analysis.processes if each.verdict is not None), *analysis.requirements]
    assert sorted((each.name, each.quantity) for each in simulation.judged) == sorted(
        (each.name, each.quantity) for each in judged
    )


def last_line(*arguments):
    run = amuros(*arguments)
    return (run.stdout or run.stderr).rstrip().splitlines()[-1], run.returncode


@pytest.mark.parametrize(
    ("model", "found", "code"),
    [
        # Nothing is executed; nothing was missed, but neither was anything kept.
        (
            "no-priority",
            "not everything was simulated in 2: nothing was executed: 'A' is not simulated: it has no priority; 1 other error",
            1,
        ),
        ("zero-with-unit", "no deadline, requirement or constraint to judge", 0),
        ("order-across-tasks", "nothing missed", 0),
        ("trigger-before-end", "limits missed or activations lost in 2 (reaction.reaction)", 1),
    ],
)
def test_many_runs_praise_nothing_that_was_not_observed(model, found, code):
    path = FOLDER / f"{model}.amxmi"
    if not path.exists():
        pytest.skip("the file is not at hand")
    command = ("simulate", path, "--duration", "2ms", "--runs", "2", "--jobs", "1")
    line, returned = last_line(*command)
    assert line.startswith(f"Observed in 2 runs of 2 ms each: {found}")
    assert returned == code
    assert json.loads(amuros(*command, "--output", "json").stdout)["summary"]["text"] == line


HIGH = "{name: H, period: 20 ms, execution_time: 6 ms, priority: 2}"
LOW = "{name: U, period: 25 ms, execution_time: 15 ms, priority: 1, activation_limit: 2}"


def app_of(*tasks, isrs=(), requirements=()):
    sections = {"isrs": isrs, "tasks": tasks, "requirements": requirements}
    lists = (f"{name}: [{', '.join(entries)}]\n" for name, entries in sections.items() if entries)
    return "amuros: 1\nname: app\nhardware: {platform: single-core, frequency: 100 MHz}\n" + "".join(lists)


def low_with(more, old="}"):
    return LOW.replace(old, more)


#: The verdict on each system, and why: late, loses activations, overloaded; a lower limit that is met or missed.
APPS = {
    "yes": app_of(HIGH, low_with(", deadline: 30 ms}")),
    "no": app_of(HIGH, LOW),
    "no, twice stated": app_of(
        HIGH, LOW, requirements=[f"{{process: U, response_time: {{max: {limit} ms}}}}" for limit in (20, 26)]
    ),
    "no, lost": app_of(HIGH, low_with("deadline: 40 ms", "activation_limit: 2")),
    "no, overload": app_of(HIGH, low_with("20 ms", "15 ms")),
    "unknown": app_of(
        low_with(", deadline: 20 ms}"),
        isrs=["{name: I, sporadic: {min: 20 ms, max: 1 s}, execution_time: 6 ms, priority: 1}"],
    ),
    "yes, at least": app_of(HIGH, requirements=["{process: H, response_time: {min: 5 ms}}"]),
    "no, at least": app_of(HIGH, requirements=["{process: H, response_time: {min: 7 ms}}"]),
}
#: The exit code of each verdict with each value of --fail-on.
CODES = {
    "yes": {"missed": 0, "unknown": 0, "never": 0},
    "no": {"missed": 1, "unknown": 1, "never": 0},
    "unknown": {"missed": 0, "unknown": 1, "never": 0},
}


@pytest.fixture
def app(request, tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text(APPS[request.param])
    return path, request.param.partition(",")[0]


all_apps = pytest.mark.parametrize("app", APPS, indirect=True)


@all_apps
def test_all_commands_that_prove_agree(app, tmp_path):
    path, verdict = app
    document = tmp_path / "analysis.json"
    line, code = last_line("analyze", path, "--output", "text", "--output", f"json={document}")
    begin = "Not proved schedulable: " if verdict == "unknown" else f"Schedulable: {verdict}"
    assert (line.startswith(begin), code) == (True, CODES[verdict]["missed"])
    for fail_on in ("unknown", "never"):
        assert last_line("analyze", path, "-q", "--fail-on", fail_on) == (line, CODES[verdict][fail_on])
    assert last_line("report", path, "-o", tmp_path / "r.md", "--no-simulation", "-q") == (line, code)
    explained = amuros("analyze", path, "--explain", "H" if verdict != "unknown" else "U")
    assert (explained.returncode, line in explained.stderr) == (code, verdict != "yes")
    summary = json.loads(document.read_text())["summary"]
    assert (summary["text"], summary["schedulable"]) == (line, verdict)
    assert (summary["failures"] > 0, summary["unknown"] > 0) == (verdict == "no", verdict == "unknown")
    # The only variant is the system as it is.
    key = "U.priority=1" if "name: U" in path.read_text() else "H.priority=2"
    swept = last_line("sweep", path, "--sweep", key, "-q")
    count = {"yes": "yes in 1 of 1 variant", "no": "yes in 0 of 1 variant, no in 1"}.get(
        verdict, "yes in 0 of 1 variant, unknown in 1"
    )
    assert swept == (f"Schedulable: {count}", code)
    present = json.loads(amuros("optimize", path, "--designs", "1", "--output", "json").stdout)["present"]
    assert present["feasible"] == verdict


@all_apps
def test_a_simulation_contradicts_no_proof(app):
    path, verdict = app
    command, document = ("simulate", path, "--duration", "200ms", "--mode", "worst"), path.with_suffix(".json")
    line, code = last_line(*command, "--output", "text", "--output", f"json={document}")
    assert code == {"yes": 0, "no": 1}.get(verdict, code)
    summary = json.loads(document.read_text())["summary"]
    assert (summary["text"], summary["failures"] > 0) == (line, code == 1)
    assert last_line(*command, "--runs", "2", "--jobs", "1", "-q")[1] == code
