"""However a command ends, it says why in words, and by its exit code."""

import os
import resource
import signal
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from random import Random

import pytest
from click.testing import CliRunner
from support import DATA, ROOT

from amalthea_uros.cli.main import COMMANDS, cli

BRAKE = DATA / "brake.amxmi"
YAML = ROOT / "samples" / "bodas-test-advanced.yaml"

#: What each command is given after its name; {} is a file that cannot be read.
WITH_A_FILE = {
    "analyze": ["{}"],
    "build": ["{}"],
    "calibrate": ["{}", "run.btf"],
    "chains": ["{}", "--from", "a", "--to", "b"],
    "check": ["{}"],
    "compare": ["{}", "{}"],
    "diff": ["{}", str(BRAKE)],
    "export": ["{}", "-o", "-"],
    "fmt": ["{}"],
    "generate": [str(YAML), "--check", "{}"],
    "import": ["{}"],
    "info": ["{}"],
    "measure": ["{}", "--start", "1", "--end", "2"],
    "migrate": ["{}"],
    "optimize": ["{}"],
    "report": ["{}", "--output", "markdown"],
    "simulate": ["{}", "--duration", "1ms"],
    "sweep": ["{}", "--sweep", "a.period=1ms"],
}
#: Those that read no file.
WITHOUT = {"completion": ["bash"], "explain": ["XMI001"], "init": ["--list"], "lsp": ["--help"], "rules": [], "schema": []}


def test_every_command_is_in_a_table():
    assert {*WITH_A_FILE, *WITHOUT} == set(COMMANDS)


def places(folder):
    loop = folder / "loop.amxmi"
    loop.symlink_to(loop)
    (folder / "folder.yaml").mkdir()
    zero = folder / "zero.yaml"
    zero.symlink_to("/dev/zero")
    return {
        "a circle of links": loop,
        "a directory": folder / "folder.yaml",
        "a name that is too long": folder / ("x" * 300 + ".amxmi"),
        "a name with commands": folder / "x\n::error::\x1b[31m\u202e.amxmi",
        "a name that is no text": folder / os.fsdecode(b"\xff.amxmi"),
        "an endless device": zero,
    }


@pytest.mark.parametrize("command", WITH_A_FILE)
def test_what_is_no_file_is_refused_in_words(command, tmp_path):
    for name, path in places(tmp_path).items():
        run = CliRunner().invoke(in_main, [command, *(argument.format(path) for argument in WITH_A_FILE[command])])
        assert run.exit_code == 2, (name, run.output)
        assert run.output, name
        assert_plain(run.output)


def assert_plain(output):
    """Nothing in a text acts on a terminal or on a CI system."""
    for line in output.split("\n"):
        assert line.isprintable(), repr(line)
        assert not line.lstrip().startswith("::"), line


class InMain:
    """The command line with the messages of `main`, for a runner of click."""

    name = "amuros"

    def main(self, args, prog_name=None, **_more):
        from amalthea_uros.cli import main

        sys.argv = ["amuros", *args]
        main.main()


in_main = InMain()


def process(*arguments, **more):
    return subprocess.run(
        [sys.executable, "-m", "amalthea_uros", *map(str, arguments)], check=False, capture_output=True, timeout=60, **more
    )


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))


@pytest.mark.parametrize("setting", ["baseline", "rules"])
def test_an_endless_device_is_read_up_to_the_limit(setting, tmp_path):
    run = process("check", BRAKE, f"--{setting}", "/dev/zero", preexec_fn=limited)
    assert run.returncode == 2
    assert b"larger than" in run.stderr
    assert b"AMUROS_LIMITS=4" in run.stderr


def test_a_baseline_that_settings_name_is_read_up_to_the_limit(tmp_path):
    (tmp_path / "amuros.toml").write_text('[check]\nbaseline = "/dev/zero"\n')
    (tmp_path / "m.amxmi").write_bytes(BRAKE.read_bytes())
    run = process("check", tmp_path / "m.amxmi", preexec_fn=limited)
    assert run.returncode == 2
    assert b"larger than 128 MiB" in run.stderr


@pytest.mark.parametrize("factor", ["0", "x", "-1", "99999"])
def test_a_wrong_factor_of_the_limits_is_refused(factor):
    run = process("info", BRAKE, env={**os.environ, "AMUROS_LIMITS": factor})
    assert run.returncode == 2
    assert b"AMUROS_LIMITS must be a whole number from 1 to 9999" in run.stderr
    assert b"Traceback" not in run.stderr


@pytest.mark.parametrize("output", ["text", "json", "sarif", "junit", "github"])
def test_letters_that_the_encoding_lacks_are_escaped(output, tmp_path):
    path = tmp_path / os.fsdecode("größe-名-".encode() + b"\xff.amxmi")
    path.write_text(BRAKE.read_text().replace("Pedal", "Bremspedäl 名"))
    run = process("check", path, "--output", output, env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert run.returncode == 0, run.stderr
    assert run.stdout.isascii()
    if output == "json":
        import json

        assert json.loads(run.stdout)["model"] == str(path)
    if output == "junit":
        ElementTree.fromstring(run.stdout)


INTERRUPTED_AFTER = """
import signal, sys
left = {calls}
def count(*_event):
    global left
    left -= 1
    if left == 0:
        sys.setprofile(None)
        signal.raise_signal(signal.{name})
from amalthea_uros.cli.process import run
sys.argv = {arguments}
sys.setprofile(count)
run()
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
@pytest.mark.parametrize("calls", [30, 3_000, 20_000, 60_000])
def test_an_interrupt_at_any_moment_is_quiet_and_leaves_no_file(calls, name, tmp_path):
    arguments = ["amuros", "build", str(YAML), "-o", str(tmp_path / "a.amxmi")]
    code = INTERRUPTED_AFTER.format(calls=calls, name=name, arguments=arguments)
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False, text=True, timeout=60)
    number = getattr(signal, name)
    # Before the command handles signals, SIGTERM ends it as any process.
    assert run.returncode in (128 + number, *([-number] if calls < 100 else [])), run.stderr
    assert "Traceback" not in run.stderr
    assert "Exception" not in run.stderr
    assert list(tmp_path.iterdir()) == []


SAMPLES = ROOT / "samples"
MEASURED = ["bodas-test-measured.yaml", "bodas-test-measured.log", "--markers", "bodas-test-measured.markers.yml"]
#: What takes long, or can; workers are in a group of processes with the command.
LONG = {
    "analyze": [YAML, "--explain", "Control_Function", "--output", "json=FOLDER/a.json"],
    "calibrate": [*MEASURED, "-o", "FOLDER/calibrated.yaml"],
    "check": [YAML, "--output", "sarif=FOLDER/check.sarif"],
    "compare": [*MEASURED, "--output", "json=FOLDER/compare.json"],
    "export": [YAML, "-o", "FOLDER/project.iprx"],
    "import": ["sources/int32_publisher.c", "-o", "FOLDER/imported.yaml"],
    "migrate": ["pump-1.2.0.amxmi", "-o", "FOLDER/migrated.amxmi"],
    "optimize": [YAML, "--goal", "latency", "--jobs", "1", "--output", "json=FOLDER/best.json"],
    "report": [YAML, "-o", "FOLDER/report.html"],
    "simulate": [YAML, "--duration", "1h", "--trace", "FOLDER/run.btf"],
    "sweep": [YAML, "--sweep", "Control_Function.execution_time=1us..900us/1us", "--table", "FOLDER/table.csv"],
}


@pytest.mark.parametrize("command", LONG)
def test_an_interrupt_of_a_long_command_leaves_no_file_and_no_process(command, tmp_path):
    given = [str(word).replace("FOLDER", str(tmp_path)) for word in LONG[command]]
    # The moment is another one for each command, and the same in each run of the test.
    calls = Random(command).choice((5_000, 30_000, 60_000))
    code = INTERRUPTED_AFTER.format(calls=calls, name="SIGINT", arguments=["amuros", command, *given])
    words = [sys.executable, "-c", code]
    with subprocess.Popen(
        words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, cwd=SAMPLES, start_new_session=True
    ) as run:
        message = run.communicate(timeout=60)[1]
    assert run.returncode == 130, message
    assert "Traceback" not in message
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ProcessLookupError):
        os.killpg(run.pid, 0)


def test_the_command_line_ends_in_words_when_the_memory_is_short():
    code = "import amalthea_uros.cli.main as m\ndef main(): raise MemoryError\nm.main = main\n"
    code += "from amalthea_uros.cli.process import run; run()"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False, text=True)
    assert run.returncode == 2
    assert run.stderr.startswith("amuros: not enough memory")


BROKEN = (
    "import amalthea_uros.cli.main as m\ndef main(): raise KeyError('a\\x1bb')\nm.main = main\n"
    "from amalthea_uros.cli.process import run; run()"
)


@pytest.mark.parametrize("is_shown", [False, True])
def test_a_flaw_of_the_program_is_told_in_a_sentence_and_by_a_code_of_its_own(is_shown):
    environment = {name: value for name, value in os.environ.items() if name != "AMUROS_TRACEBACK"}
    environment |= {"AMUROS_TRACEBACK": "1"} if is_shown else {}
    run = subprocess.run([sys.executable, "-c", BROKEN], capture_output=True, check=False, text=True, env=environment)
    assert run.returncode == 70
    *before, sentence = run.stderr.splitlines()
    assert sentence.startswith(r"amuros: internal error, a flaw of amuros: KeyError('a\x1bb'); please report it at https://")
    assert tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["urls"]["Issues"] in sentence
    assert any("Traceback" in line for line in before) == is_shown
    assert ("AMUROS_TRACEBACK=1" in sentence) != is_shown


@pytest.mark.parametrize("command", WITHOUT)
def test_commands_without_files_end_with_0(command):
    assert CliRunner().invoke(cli, [command, *WITHOUT[command]]).exit_code == 0
