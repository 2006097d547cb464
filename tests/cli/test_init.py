"""`amuros init`: a description that works at once, and never a file lost."""

import json
import re

import pytest
from command import amuros
from effort import every
from support import ROOT

from amalthea_uros._internal.resources import known_platforms
from amalthea_uros.cli.main import COMMANDS
from amalthea_uros.services.init import example_names


@pytest.mark.parametrize("board", every(3, known_platforms()))
def test_what_is_written_for_a_board_is_built_checked_and_schedulable(board, tmp_path):
    assert amuros("init", "--board", board, cwd=tmp_path).returncode == 0
    assert f"platform: {board} #" in (tmp_path / "app.yaml").read_text()
    build = amuros("build", "app.yaml", cwd=tmp_path)
    assert (build.returncode, build.stderr.count("error"), build.stderr.count("warning")) == (0, 0, 0)
    check = amuros("check", "app.yaml", cwd=tmp_path)
    assert (check.returncode, check.stdout.count("warning"), check.stdout.count("error")) == (0, 0, 0)
    analysis = amuros("analyze", "app.yaml", "--output", "json", cwd=tmp_path)
    assert analysis.returncode == 0
    assert json.loads(analysis.stdout)["summary"]["schedulable"] == "yes"


@pytest.mark.parametrize(
    ("board", "lines"),
    [
        # As in the examples of micro-ROS for the board.
        ("esp32", ["loop: {spin_some: 100 ms, sleep: 10 ms}", "serial: {baud_rate: 115200}"]),
        (
            "teensy41",
            ["loop: {spin_some: 100 ms, sleep: 100 ms}", "usb_cdc: {latency: {min: 0, max: 1 ms}} # until the host polls"],
        ),
        ("rp2040", ["loop: {spin_some: 100 ms}"]),
        ("olimex-stm32-e407", ["loop: {spin: 1 s}", "serial: {baud_rate: 115200}"]),
        ("tc389", ["transport: {can: {bitrate: 500 kbit/s}}"]),
    ],
)
def test_a_board_has_the_loop_and_the_transport_of_its_examples(board, lines):
    written = [line.strip() for line in amuros("init", "-", "--board", board).stdout.splitlines()]
    assert [line for line in lines if line not in written] == []


def test_its_comments_teach_every_part():
    text = amuros("init", "-").stdout
    lines = text.splitlines()
    for key in ("task_periods", "executor", "execution_time: {min", "chains", "requirements"):
        index = next(i for i, line in enumerate(lines) if key in line)
        assert "#" in lines[index] or "#" in lines[index - 1], key


def test_standard_output_has_nothing_but_the_file():
    run = amuros("init", "-")
    assert run.stderr == ""
    assert amuros("check", "-", given=run.stdout).stdout.endswith("no findings\n")


@pytest.mark.parametrize("example", example_names())
def test_an_example_is_copied_as_it_is(example, tmp_path):
    assert amuros("init", "--example", example, cwd=tmp_path).returncode == 0
    assert (tmp_path / "app.yaml").read_bytes() == (ROOT / "samples" / f"{example}.yaml").read_bytes()


def test_an_example_has_its_measurement_beside_it(tmp_path):
    run = amuros("init", "new/my.yaml", "--example", "bodas-test-measured", cwd=tmp_path)
    files = ["bodas-test-measured.log", "bodas-test-measured.markers.yml"]
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == [*files, "my.yaml"]
    assert all((tmp_path / "new" / name).read_bytes() == (ROOT / "samples" / name).read_bytes() for name in files)
    (command,) = re.findall("amuros (calibrate .*?) +#", run.stdout)
    assert amuros(*command.split(), "--quiet", cwd=tmp_path).returncode == 0


def test_a_measurement_that_exists_is_not_replaced_and_nothing_is_written(tmp_path):
    log = tmp_path / "bodas-test-measured.log"
    log.write_text("mine")
    run = amuros("init", "--example", "bodas-test-measured", cwd=tmp_path)
    assert (run.returncode, run.stderr.partition("\n")[0]) == (2, f"{log.name}: XMI101 error: the file exists already")
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]


def test_standard_output_has_no_measurement(tmp_path):
    run = amuros("init", "-", "--example", "bodas-test-measured", cwd=tmp_path)
    assert run.stdout == (ROOT / "samples" / "bodas-test-measured.yaml").read_text()
    assert list(tmp_path.iterdir()) == []


def test_examples_share_the_database_of_their_bus(tmp_path):
    for name in ("drive", "lift"):
        run = amuros("init", f"{name}.yaml", "--example", f"two-controllers-{name}", cwd=tmp_path)
        assert (run.returncode, "two-controllers.dbc: foreign frames on its bus\n" in run.stdout) == (0, True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drive.yaml", "lift.yaml", "two-controllers.dbc"]
    (tmp_path / "two-controllers.dbc").write_text("mine")
    run = amuros("init", "again.yaml", "--example", "two-controllers-lift", cwd=tmp_path)
    assert (run.returncode, run.stderr.partition("\n")[0]) == (2, "two-controllers.dbc: XMI101 error: the file exists already")


def test_every_example_is_in_the_wheel():
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    included = project["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"]
    samples = {source: target for source, target in included.items() if source.startswith("samples/")}
    examples = [f"{name}{suffix}" for name in example_names() for suffix in (".yaml", ".log", ".markers.yml")]
    examples += [path.name for path in (ROOT / "samples").glob("*.dbc")]
    assert samples == {
        f"samples/{name}": f"amalthea_uros/samples/{name}" for name in examples if (ROOT / "samples" / name).exists()
    }


@pytest.mark.parametrize(
    ("target", "path"), [("my.yaml", "my.yaml"), ("new/folder", "new/folder/app.yaml"), (".", "app.yaml"), ("a.yml", "a.yml")]
)
def test_a_file_or_a_folder_is_named(target, path, tmp_path):
    run = amuros("init", target, cwd=tmp_path)
    assert run.stdout.startswith(f"{path}: written from board generic\n")
    assert [str(file.relative_to(tmp_path)) for file in tmp_path.rglob("*.y*ml")] == [path]


def test_a_file_that_exists_is_replaced_only_with_force(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text("mine")
    run = amuros("init", cwd=tmp_path)
    assert run.returncode == 2
    assert run.stderr == (
        "app.yaml: XMI101 error: the file exists already\n  help: Use --force to replace it, or name another file.\n"
    )
    assert path.read_text() == "mine"
    assert amuros("init", "--force", cwd=tmp_path).returncode == 0
    assert path.read_text().startswith("# The timing")


@pytest.mark.parametrize(
    ("option", "name", "advice"),
    [
        ("--board", "generik", "did you mean 'generic'?"),
        ("--board", "?", f"known names: {', '.join(known_platforms())}; for another controller omit --board"),
        ("--example", "drive-and-left", "did you mean 'drive-and-lift'?"),
    ],
)
def test_a_wrong_name_gets_a_suggestion(option, name, advice, tmp_path):
    run = amuros("init", option, name, cwd=tmp_path)
    assert run.returncode == 2
    assert f"there is no {name!r}; {advice}" in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_help_and_list_name_all_boards_and_examples():
    names = [*known_platforms(), *example_names()]
    words = amuros("init", "--list").stdout.split()
    assert [word for word in words if word in names] == names
    text = "".join(amuros("init", "--help").stdout.split())
    assert [name for name in names if name not in text] == []


def test_it_ends_with_commands_that_exist(tmp_path):
    lines = amuros("init", cwd=tmp_path).stdout.partition("Next:\n")[2].splitlines()
    named = [line.split()[1] for line in lines]
    assert named == ["check", "analyze", "report", "build"]
    for line in lines:
        words = line.partition("#")[0].split()[1:]
        if words[0] in COMMANDS:
            assert amuros(*words, cwd=tmp_path).returncode == 0
