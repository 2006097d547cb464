"""Give mutated files to every reader in one process: whatever is in them, there is a result or a refusal in words, soon.

Usage: python tools/fuzz_readers.py [--cases N] [--seed S] [--out FOLDER] [READER]...

Each cause of failures is reported once, with the file. `tools/fuzz.py` examines whole commands, with few cases a second; this one has
hundreds. The exit code is 1 if something fails.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from random import Random
from traceback import extract_tb
from types import FrameType
from typing import NoReturn

from lsprotocol import types
from templating import ROOT

sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "trace")]

from fuzzing import byte_mutations
from fuzzing.cases import mutations_of
from fuzzing.seeds import Files, seeds

import amalthea_uros
from amalthea_uros.diagnostics import Finding
from amalthea_uros.editor.diagnostics import diagnostics_of
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.editor.keys import completions, key_hover
from amalthea_uros.editor.names import definition_of, symbols_of
from amalthea_uros.editor.quick_fixes import quick_fixes
from amalthea_uros.errors import AmurosError, InvalidArgumentError
from amalthea_uros.findings.accepted import read_baseline
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.build import describe
from amalthea_uros.services.check import check_files
from amalthea_uros.services.diff import diff
from amalthea_uros.services.first_answer import first_answer
from amalthea_uros.services.generate import check_colcon_meta
from amalthea_uros.services.import_code import import_code
from amalthea_uros.services.import_recording import import_recording
from amalthea_uros.services.importer_registration import register
from amalthea_uros.services.migrate import migrate
from amalthea_uros.services.subject import open_system
from amalthea_uros.validate.settings import project_settings
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save

#: Of processor time, so that it does not matter what else the computer does.
_SECONDS = 10
#: Files of text whose structure is known.
_STRUCTURED = (".amxmi", ".iprx", ".yaml", ".yml", ".c", ".cpp", ".ino", ".dbc", ".idl", ".msg", ".meta")
_GENTLE = 0.6
#: What is compared with, and checked against, mutated files.
_DESCRIPTION, _MODEL = ROOT / "samples" / "drive-and-lift.yaml", ROOT / "samples" / "pump-1.2.0.amxmi"
_MEMORY = 3 * 2**30
_ACCEPTED, _REFUSED = "read", "refused"
#: Findings about an error of amuros, which has ended neither a rule, nor a migration, nor the evaluation of a limit as an exception.
_OWN_ERRORS = {"CHK001", "CHN006", "XMI105"}


def main() -> None:
    options = _options()
    known: set[str] = set()
    signal.signal(signal.SIGPROF, _late)
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    with tempfile.TemporaryDirectory() as folder:
        for name in options.readers or READERS:
            failed, accepted = 0, 0
            for number in range(options.cases):
                target = _case(name, Random(f"{options.seed}:{name}:{number}"), Path(folder) / "case")
                cause = _outcome(READERS[name], target)
                accepted += cause == _ACCEPTED
                if cause not in (_ACCEPTED, _REFUSED) and f"{name}: {cause}" not in known:
                    known.add(f"{name}: {cause}")
                    failed += 1
                    print(f"{name}: {cause}: {_kept(target, options.out / f'{name}-{number}')}", flush=True)
            print(f"{name}: {options.cases} cases, {accepted} read, {failed} failures", flush=True)
    sys.exit(1 if known else 0)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000, help="for each reader")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("build/fuzz"), help="folder for the files that fail")
    parser.add_argument("readers", nargs="*", metavar="READER", help="default: all")
    return parser.parse_args()


def _case(name: str, rng: Random, folder: Path) -> Path:
    """What is given to a reader: the files of a seed, of which one is mutated."""
    files, others = rng.choice(seeds(name)), rng.choice(seeds(name))
    victim = rng.choice(sorted(files))
    other = others[rng.choice(sorted(others))]
    return place(files | {victim: _mutated(rng, Path(victim).suffix, files[victim], other)}, folder)


def place(files: Files, folder: Path) -> Path:
    """Write files, and nothing else, into a folder; the folder, or the only file."""
    shutil.rmtree(folder, ignore_errors=True)
    for path, content in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
    return target if len(files) == 1 else folder


def _mutated(rng: Random, suffix: str, content: bytes, other: bytes) -> bytes:
    """Most files stay near to what is read, so that the mutations reach what comes after the first checks."""
    if rng.random() < _GENTLE:
        if rng.random() < 0.5 and suffix in _STRUCTURED and content:
            text = content.decode(errors="surrogateescape")
            return rng.choice(mutations_of(suffix))(rng, text).encode(errors="surrogateescape")
        return byte_mutations.number(rng, content, other)
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        content = rng.choice(byte_mutations.MUTATIONS)(rng, content, other)
    return content


def _outcome(read: Callable[[Path], object], path: Path) -> str:
    """Whether a file was read or refused; else why the reader failed, and where in the code."""
    signal.setitimer(signal.ITIMER_PROF, _SECONDS)
    try:
        outcome, findings = _ACCEPTED, getattr(read(path), "findings", ())
    except (AmurosError, InvalidArgumentError) as error:
        outcome, findings = _REFUSED, getattr(error, "findings", ())
    except Exception as error:
        frame = [each for each in extract_tb(error.__traceback__) if "amalthea_uros" in each.filename][-1]
        return f"{type(error).__name__} at {Path(frame.filename).name}:{frame.lineno}: {str(error)[:100]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return next((_described(finding) for finding in findings if finding.rule in _OWN_ERRORS), outcome)


def _described(finding: Finding) -> str:
    return f"{finding.rule}: {finding.message[:160]}"


def _late(_number: int, _frame: FrameType | None) -> NoReturn:
    raise TimeoutError(f"no result after {_SECONDS} s")


def _kept(path: Path, target: Path) -> Path:
    target.parent.mkdir(parents=True, exist_ok=True)
    return Path(
        shutil.copytree(path, target, dirs_exist_ok=True) if path.is_dir() else shutil.copy(path, f"{target}{path.suffix}")
    )


def _analyzed(path: Path) -> object:
    """What `amuros analyze` finds."""
    result = analyze_files(path, with_missing=True)
    first_answer(result)
    return result


def _baseline(path: Path) -> None:
    try:
        read_baseline(path)
    except ValueError as error:
        raise InvalidArgumentError(str(error)) from None


def _can_log(path: Path) -> object:
    return amalthea_uros.measure(path, start="0x1", end="0x2", counter="byte 0")


def _with_dbc(path: Path) -> object:
    return amalthea_uros.measure(path / "run.log", markers=path / "markers.yml", dbc=path / "bus.dbc")


def _editor(path: Path) -> None:
    """What an editor asks while somebody writes, at each place of a line."""
    document = TextDocument(path.as_uri(), path, path.read_bytes().decode(errors="replace"), 1)
    diagnostics = diagnostics_of(document)
    quick_fixes(document, diagnostics, None)
    symbols_of(document)
    rng = Random(len(document.text))
    line = rng.randrange(len(document.lines))
    for column in {0, rng.randrange(len(document.lines[line]) + 1), len(document.lines[line])}:
        position = types.Position(line, column)
        for ask in (completions, key_hover, definition_of):
            ask(document, position)


def _importers(path: Path) -> None:
    os.environ["XDG_CONFIG_HOME"] = str(path.parent.parent)
    register(Path("amuros"))


def _trace(path: Path) -> object:
    return amalthea_uros.measure(path).to_records(full=True)


def _table(path: Path) -> object:
    return amalthea_uros.measure(path, columns=["start_us=A.execution_time", "end_us - start_us=B"])


def _calibrated(path: Path) -> object:
    return amalthea_uros.calibrate(path / "app.yaml", path / "run.csv")


def _written(path: Path) -> None:
    save(load(path), path.with_name("written.amxmi"), canonical=True)


#: What is done with the files of `fuzzing.seeds` of the same name.
READERS: dict[str, Callable[[Path], object]] = {
    "amxmi": lambda path: open_system([path]),
    "amxmi-analyzed": _analyzed,
    "amxmi-checked": check_files,
    "amxmi-compared": lambda path: diff(path, _MODEL),
    "amxmi-written": _written,
    "baseline": _baseline,
    "calibration": _calibrated,
    "can": _can_log,
    "dbc": _with_dbc,
    "description": describe,
    "description-analyzed": _analyzed,
    "description-checked": check_files,
    "editor": _editor,
    "importers": _importers,
    "iprx": lambda path: open_system([path]),
    "meta": lambda path: check_colcon_meta(_DESCRIPTION, path),
    "older-amxmi": lambda path: open_system([path]),
    "older-amxmi-migrated": migrate,
    "own-files": lambda path: describe(path / "app.yaml"),
    "recording": import_recording,
    "ros-report": amalthea_uros.measure,
    "settings": lambda path: project_settings(path / "model.amxmi"),
    "sources": import_code,
    "table": _table,
    "trace": _trace,
    "trace-compared": lambda path: amalthea_uros.compare(_DESCRIPTION, path, by=["analysis"]),
    "zip": lambda path: open_system([path]),
}

if __name__ == "__main__":
    main()
