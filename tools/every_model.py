"""Run commands over every model of a folder: no traceback, and what each file needs of time and memory.

Usage: python tools/every_model.py [--corpus FOLDER] [--commands C,...] [--every N] [--seconds S] [--out RESULT.jsonl] [FILE]...

Each command runs in a copy of this process, which has loaded the package, so that the times are those after start-up. The exit code is
1 if an exception escapes, or if a command takes longer than is allowed. With --out, each outcome is appended at once, as a line of
JSON, so that a run that is cut short has its results.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import sys
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from templating import ROOT

from amalthea_uros.cli.main import COMMANDS, cli, main

_CORPUS = ROOT.parent / "shared" / "corpus"
#: What each command is given; MODEL is the file, EDITED a copy of it with another value, OUT a folder for what it writes.
ARGUMENTS = {
    "info": "MODEL",
    "check": "MODEL",
    "analyze": "MODEL",
    "simulate": "MODEL --duration 10ms",
    "report": "MODEL -o OUT/report.html -o OUT/report.md -o OUT/report.dot -o OUT/report.mmd",
    "diff": "MODEL EDITED",
    "migrate": "MODEL -o OUT/migrated",
    "export": "MODEL -o OUT/exported.amxmi",
}
#: A number of a model, which is edited: a value, or a limit of an execution time.
_VALUE = re.compile(rb"(?<= value=\")(?=[1-9])")
#: What exit codes are for: success, findings, wrong use or unreadable input.
_CODES = (0, 1, 2)
_ESCAPED = 70


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a command ended on a file.

    Attributes
    ----------
    seconds : of the processor, after start-up
    megabytes : the largest memory, with what the package itself needs
    lines : of standard error
    cause : the exception that escaped and its place in the code; "" if none did
    """

    file: str
    command: str
    code: int
    seconds: float
    megabytes: int
    lines: int
    cause: str
    closing: str


def run(command: str, path: Path, limit: int) -> Outcome:
    """A command on a file, in a copy of this process."""
    with TemporaryDirectory(prefix="amuros-every-") as name:
        folder = Path(name)
        edited = folder / f"edited{path.suffix}"
        edited.write_bytes(_VALUE.sub(b"1", path.read_bytes(), count=1))
        given = {"MODEL": str(path), "EDITED": str(edited)}
        words = [given.get(word, word.replace("OUT", name)) for word in ARGUMENTS[command].split()]
        child = os.fork()
        if child == 0:
            _become([command, *words], folder, limit)
        _, status, used = os.wait4(child, 0)
        cause = folder / "cause"
        said = _lines(folder / "err")
        return Outcome(
            file=str(path),
            command=command,
            code=os.waitstatus_to_exitcode(status),
            seconds=round(used.ru_utime + used.ru_stime, 3),
            megabytes=used.ru_maxrss // 1024,
            lines=len(said),
            cause=cause.read_text() if cause.exists() else "",
            closing=_last(_lines(folder / "out") or said),
        )


def _lines(path: Path) -> list[str]:
    """The lines of a file; none if the command ended before it had one."""
    return path.read_text(errors="replace").splitlines() if path.exists() else []


def _last(lines: list[str]) -> str:
    return next((line for line in reversed(lines) if line.strip()), "")


def _become(words: list[str], folder: Path, limit: int) -> None:
    """Run a command with its streams in files, and end this process."""
    code = _ESCAPED
    try:
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
        sys.stdin = Path(os.devnull).open()  # noqa: SIM115 - open up to the end of the process
        sys.stdout, sys.stderr = (folder / "out").open("w"), (folder / "err").open("w")
        sys.argv = ["amuros", *words]
        main()
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 0
    except BaseException as error:
        (folder / "cause").write_text(_cause(error))
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _cause(error: BaseException) -> str:
    """The kind of an exception and the last place in the package."""
    own = [frame for frame in traceback.extract_tb(error.__traceback__) if "amalthea_uros" in frame.filename]
    place = f" {Path(own[-1].filename).name}:{own[-1].lineno}" if own else ""
    return f"{type(error).__name__}{place}: {error}"[:300]


def warm_up() -> None:
    """Load what commands load."""
    from click import Context

    for command in COMMANDS:
        cli.get_command(Context(cli), command)
    for command in ARGUMENTS:
        if command in ("analyze", "simulate", "check", "report"):
            _in_this_process(command, ROOT / "samples" / "bodas-test-advanced.amxmi")


def _in_this_process(command: str, path: Path) -> None:
    from click.testing import CliRunner

    with TemporaryDirectory() as name:
        words = [{"MODEL": str(path)}.get(word, word.replace("OUT", name)) for word in ARGUMENTS[command].split()]
        CliRunner().invoke(cli, [command, *words])


def outcomes(paths: Iterable[Path], commands: Iterable[str], limit: int) -> Iterator[Outcome]:
    """How each command ends on each file."""
    commands = tuple(commands)
    return (run(command, path, limit) for path in paths for command in commands)


def models(corpus: Path) -> list[Path]:
    """The models of a folder."""
    return sorted(path for path in corpus.rglob("*") if path.suffix.startswith(".amxmi") and path.is_file())


def main_of_tool() -> None:
    options = _options()
    paths = options.files or models(options.corpus)[:: options.every]
    warm_up()
    started = time.monotonic()
    found = []
    for outcome in outcomes(paths, options.commands.split(","), options.seconds):
        found.append(outcome)
        if options.out:
            with options.out.open("a") as written:
                print(json.dumps(asdict(outcome)), file=written)
        if outcome.cause or outcome.code not in _CODES:
            print(f"{outcome.command} {outcome.file}: {outcome.code} {outcome.cause}", flush=True)
    print(f"{len(paths)} models, {len(found)} runs, {time.monotonic() - started:.0f} s")
    for command in dict.fromkeys(outcome.command for outcome in found):
        _summarize(command, [outcome for outcome in found if outcome.command == command])
    sys.exit(any(outcome.code not in _CODES for outcome in found))


def _summarize(command: str, found: list[Outcome]) -> None:
    codes = Counter(outcome.code for outcome in found)
    times = sorted(outcome.seconds for outcome in found)
    slow = sum(seconds > 0.5 for seconds in times)
    print(
        f"{command}: exit codes {dict(sorted(codes.items()))}, escaped {sum(bool(each.cause) for each in found)}, median "
        f"{times[len(times) // 2]:.2f} s, longest {times[-1]:.2f} s, over 0.5 s: {slow}, largest {max(e.megabytes for e in found)} MB"
    )


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--corpus", type=Path, default=_CORPUS)
    parser.add_argument("--commands", default=",".join(ARGUMENTS))
    parser.add_argument("--every", type=int, default=1, metavar="N", help="each N-th file only")
    parser.add_argument("--seconds", type=int, default=120, help="processor time that a command may need")
    parser.add_argument("--out", type=Path)
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    return parser.parse_args()


if __name__ == "__main__":
    main_of_tool()
