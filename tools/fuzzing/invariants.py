"""What must hold for every file, whatever it contains. An invariant gets a file and a folder for what it writes."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import NamedTuple, NoReturn
from unittest.mock import patch

from lxml import etree

from amalthea_uros.analyze.verdicts import Verdict
from amalthea_uros.cli.main import main
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import AmurosError, WriteError
from amalthea_uros.metamodel.model import Model
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.check import check_files
from amalthea_uros.services.diff import diff
from amalthea_uros.services.fix import fix_files
from amalthea_uros.services.format import format_files
from amalthea_uros.services.paths import is_description
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save

Invariant = Callable[[Path, Path], None]


class InvariantError(Exception):
    """Something that must hold does not."""


class Ended(NamedTuple):
    """How a command ended."""

    code: object
    out: str
    err: str


def require(holds: bool, message: str) -> None:
    """Fail unless something holds."""
    if not holds:
        raise InvariantError(message)


def run(*arguments: str | Path) -> Ended:
    """A command in this process; with the guarantees that all commands give."""
    out, err = StringIO(), StringIO()
    code: object = 0
    with patch.object(sys, "argv", ["amuros", *map(str, arguments)]), redirect_stdout(out), redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            code = end.code or 0
    ended = Ended(code, out.getvalue(), err.getvalue())
    require(code in (0, 1, 2), f"exit code {code}")
    require(code != 2 or bool(ended.err.strip() or ended.out.strip()), "exit code 2 without a message")
    return ended


def _no_constant(text: str) -> NoReturn:
    raise InvariantError(f"{text} is not JSON")


def _check_json(path: Path) -> None:
    json.loads(path.read_text(encoding="utf-8"), parse_constant=_no_constant)


def _check_xml(path: Path) -> None:
    etree.parse(path)


def check(path: Path, folder: Path) -> None:
    """Rules end with a report that parses in each format."""
    parsers = {"json": _check_json, "sarif": _check_json, "junit": _check_xml}
    outputs = [part for name in parsers for part in ("--output", f"{name}={folder / name}")]
    run("check", path, "--output", "text", *outputs)
    for name, parse in parsers.items():
        if (folder / name).exists():
            parse(folder / name)


def analyze(path: Path, folder: Path) -> None:
    """The exit code follows the closing line, and no verdict is better than what is known."""
    report = folder / "analysis.json"
    ended = run("analyze", path, "--output", "text", "--output", f"json={report}")
    closing = [line for line in (ended.out + ended.err).splitlines() if line.startswith("Schedulable: ")]
    if ended.code == 2:
        return
    if not closing:
        require(ended.code == 1 and "error: " in ended.err, "neither a closing line nor an error in the description")
        return
    require(len(closing) == 1, f"{len(closing)} closing lines")
    require((ended.code == 1) == closing[0].startswith("Schedulable: no"), f"exit code {ended.code} after {closing[0]!r}")
    _check_json(report)


def verdicts(path: Path, _folder: Path) -> None:
    """Nothing is met that depends on something unknown."""
    try:
        analysis = analyze_files(path).analysis
    except AmurosError:
        return
    for process in analysis.processes:
        known = process.response is not None and process.response.worst is not None
        require(process.verdict is not Verdict.MET or known, f"{process.name} meets its deadline with an unknown response time")
    for requirement in analysis.requirements:
        known = requirement.verdict is not Verdict.MET or requirement.limit is None or requirement.value is not None
        require(known, f"{requirement.name} is met with an unknown value")


def simulate(path: Path, folder: Path) -> None:
    """A short simulation ends, with a result that parses."""
    report = folder / "simulation.json"
    if run("simulate", path, "--duration", "20ms", "--output", f"json={report}").code != 2 and report.exists():
        _check_json(report)


def build(path: Path, folder: Path) -> None:
    """What is built can be read without findings; what cannot be built leaves no file."""
    target = folder / "built.amxmi"
    ended = run("build", path, "-o", target)
    require(
        target.exists() == (ended.code == 0),
        f"exit code {ended.code}, but the file {'exists' if target.exists() else 'is missing'}",
    )
    if target.exists():
        require(not load(target).findings, "the model that was built has findings")


def info(path: Path, folder: Path) -> None:
    """A summary parses."""
    report = folder / "info.json"
    if run("info", "--schema", path, "--output", f"json={report}").code != 2:
        _check_json(report)


def migrate(path: Path, folder: Path) -> None:
    """What is migrated can be read again."""
    target = folder / "migrated.amxmi"
    if run("migrate", path, "-o", target).code != 2:
        load(target)


def load_and_save(path: Path, folder: Path) -> None:
    """A model that is written as it was read is the same file."""
    model = _loaded(path)
    if model is None or any(document.migrated_from for document in model.documents):
        return
    target = folder / path.name
    try:
        save(model, target)
    except WriteError:
        require(not target.exists(), "an error left a file")
        return
    _require_equal(path, target)
    # A ZIP is compressed again.
    is_same = _is_zip(path) or target.read_bytes() == path.read_bytes()
    require(is_same, "a model that nobody changed is written differently")


def canonical(path: Path, folder: Path) -> None:
    """Canonical form means the same, and is its own canonical form."""
    target = folder / path.name
    shutil.copyfile(path, target)
    if format_files(target).findings:
        require(target.read_bytes() == path.read_bytes(), "an error changed the file")
        return
    _require_equal(path, target)
    require(not format_files(target).changed, "canonical form changes when it is formatted again")


def fix(path: Path, folder: Path) -> None:
    """Repairs are done in one run, and leave no more errors than there were."""
    target = folder / path.name
    shutil.copyfile(path, target)
    before = _errors(target)
    try:
        fix_files(target)
    except AmurosError:
        require(target.read_bytes() == path.read_bytes(), "an error changed the file")
        return
    after = _errors(target)
    require(after <= before, f"{after} errors after repairs, {before} before")
    require(not any(model.repaired for model in fix_files(target).models), "repairs need a second run")


def _errors(path: Path) -> int:
    return sum(finding.severity is Severity.ERROR for finding in check_files(path).findings)


def _loaded(path: Path) -> Model | None:
    try:
        return load(path)
    except AmurosError:
        return None


def _is_zip(path: Path) -> bool:
    return path.read_bytes().startswith(b"PK")


def _require_equal(old: Path, new: Path) -> None:
    changes = diff(old, new).changes
    require(not changes, f"the model changed: {changes[:1]}")


_OF_BOTH: tuple[Invariant, ...] = (check, analyze, verdicts, simulate)
_OF_DESCRIPTIONS: tuple[Invariant, ...] = (build, *_OF_BOTH)
_OF_MODELS: tuple[Invariant, ...] = (info, load_and_save, canonical, fix, migrate, *_OF_BOTH)


def invariants_of(path: Path) -> Iterator[Invariant]:
    """What must hold for a file."""
    yield from _OF_DESCRIPTIONS if is_description(path) else _OF_MODELS
