"""Commands start fast: they import no library that they do not use."""

import subprocess
import sys

import pytest
from support import ROOT

SAMPLES = ROOT / "samples"
MODEL, YAML = SAMPLES / "executor.amxmi", SAMPLES / "bodas-test-simple.yaml"

#: Of the libraries and of the package, what takes long to import.
HEAVY = {
    *("numpy", "numba", "scipy", "pandas", "networkx", "pydantic", "yaml", "xmlschema", "lxml", "jinja2", "dask"),
    *(
        "asyncio",
        "concurrent.futures",
        "multiprocessing",
        "email",
        "http",
        "socket",
        "logging",
        "tomllib",
        "importlib.metadata",
    ),
    *("amalthea_uros.metamodel.classes", "amalthea_uros.findings.catalogue", "amalthea_uros.validate", "amalthea_uros.xmi"),
    *(
        "amalthea_uros.bridge",
        "amalthea_uros.perf",
        "amalthea_uros.timing",
        "amalthea_uros.analyze",
        "amalthea_uros.analyze.host.releases",
        "amalthea_uros.analyze.chains.message_chains",
        "amalthea_uros.executors.bounds.evaluate",
        "amalthea_uros.simulate.kernel",
    ),
}
MODELS = {"amalthea_uros.metamodel.classes", "amalthea_uros.xmi"}
SYSTEMS = {"amalthea_uros.perf", "amalthea_uros.timing"}
DESCRIPTIONS = {"yaml"}
#: Rules of users are looked for in the distributions that are installed; the settings of a project are TOML, the texts of rules YAML.
RULES = {
    "yaml",
    "amalthea_uros.validate",
    "amalthea_uros.findings.catalogue",
    "tomllib",
    "lxml",
    "email",
    "socket",
    "importlib.metadata",
}


@pytest.mark.parametrize(
    ("command", "needed"),
    [
        (["--help"], set()),
        (["--version"], set()),
        (["info", MODEL], MODELS),
        (["analyze", MODEL], MODELS | SYSTEMS | {"amalthea_uros.bridge", "amalthea_uros.analyze", "numpy"}),
        (["analyze", YAML], DESCRIPTIONS | SYSTEMS | {"amalthea_uros.analyze", "numpy"}),
        (["check", MODEL], MODELS | SYSTEMS | RULES | {"amalthea_uros.bridge"}),
    ],
    ids=lambda value: " ".join(str(getattr(word, "name", word)) for word in value) if isinstance(value, list) else "",
)
def test_a_command_imports_only_what_it_needs(command, needed):
    assert imported_by(*map(str, command)) & HEAVY <= needed


def test_a_report_imports_no_large_library_but_numpy_and_that_of_its_template(tmp_path):
    imported = imported_by("report", str(YAML), "-o", str(tmp_path / "report.html"))
    assert imported & {"networkx", "numba", "scipy", "pandas", "pydantic", "xmlschema", "dask"} == set()


def imported_by(*arguments):
    code = (
        "import sys; from amalthea_uros.cli.main import main\n"
        f"sys.argv = {['amuros', *arguments]}\n"
        "try: main()\nexcept SystemExit as end: assert end.code == 0, end.code\n"
        "print(*sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.splitlines()[-1].split())


def test_imports_are_not_scanned_for_garbage():
    # `run` is the command as a process of its own; a threshold of a library would be that of its users.
    code = (
        "import gc, os, sys; from amalthea_uros.cli.process import run\n"
        "sys.argv = ['amuros', '--version']; os._exit = lambda code: print(gc.get_threshold()[0]); run()"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(run.stdout.split()[-1]) > 10_000


@pytest.mark.parametrize("command", ["analyze", "simulate"])
def test_verbose_commands_say_whether_machine_code_is_used(command):
    code = "from amalthea_uros.cli.main import main; main()"
    run = subprocess.run([sys.executable, "-c", code, command, str(MODEL), "-v"], capture_output=True, text=True, check=False)
    lines = [line for line in run.stderr.splitlines() if line.startswith("machine code of ")]
    assert len(lines) == 1
    assert ": not used, 0." in lines[0]


@pytest.mark.parametrize("jobs", [1, 2])
def test_verbose_campaigns_say_once_in_each_process_whether_machine_code_is_used(jobs):
    arguments = ["simulate", str(MODEL), "--runs", "6", "--jobs", str(jobs), "--duration", "10ms", "-v"]
    command = [sys.executable, "-m", "amalthea_uros", *arguments]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    lines = [line for line in run.stderr.splitlines() if line.startswith("machine code of the simulation: not used, 0.")]
    assert 1 <= len(lines) <= jobs
    assert len(lines) == len(run.stderr.splitlines())
