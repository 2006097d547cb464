"""Give mutated files to every reader in one process: whatever is in them, there is a result or a refusal in words, soon.

Usage: python tools/fuzz_readers.py [--cases N] [--seed S] [--out FOLDER] [READER]...

Each cause of failures is reported once, with the file. `tools/fuzz.py` examines whole commands, with few cases a second; this one has
hundreds. The exit code is 1 if something fails.
"""

from __future__ import annotations

import argparse
import re
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

from templating import ROOT

sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "trace")]

from fuzzing.seeds import seeds

import amalthea_uros
from amalthea_uros.errors import AmurosError, InvalidArgumentError
from amalthea_uros.findings.accepted import read_baseline
from amalthea_uros.services.build import describe
from amalthea_uros.services.check import check_files
from amalthea_uros.services.generate import check_colcon_meta
from amalthea_uros.services.import_code import import_code
from amalthea_uros.services.import_recording import import_recording
from amalthea_uros.services.subject import open_system

_SECONDS = 20
_NUMBER = re.compile(rb"\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_HOSTILE = (
    b"", b"-1", b"0", b"1e30", b"1e400", b"nan", b"inf", b"-inf", b"9" * 25, b"18446744073709551615", b"-9223372036854775808",
    b"4294967296", b"1e-400", b"0x7fffffffffffffff", b"0.5", b"9" * 5000, b"\xc2\xb2", b"null", b"[]", b"{}", b"true", b"\x00", b'"',
)  # fmt: skip
_BYTES = (
    b"\x00",
    b"\xff",
    b"\x7f",
    b"\x80",
    b"\xff\xff\xff\xff",
    b"\x00\x00\x00\x80",
    b"\n",
    b",",
    b":",
    b"(",
    b")",
    b"<",
    b"{",
    b"}",
)


def main() -> None:
    options = _options()
    known: set[str] = set()
    signal.signal(signal.SIGALRM, _late)
    with tempfile.TemporaryDirectory() as folder:
        for name in options.readers or READERS:
            failed = 0
            for number in range(options.cases):
                target = _case(name, Random(f"{options.seed}:{name}:{number}"), Path(folder) / "case")
                cause = _failure(READERS[name], target)
                if cause is not None and f"{name}: {cause}" not in known:
                    known.add(f"{name}: {cause}")
                    failed += 1
                    print(f"{name}: {cause}: {_kept(target, options.out / f'{name}-{number}')}", flush=True)
            print(f"{name}: {options.cases} cases, {failed} failures", flush=True)
    sys.exit(1 if known else 0)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000, help="for each reader")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("build/fuzz"), help="folder for the files that fail")
    parser.add_argument("readers", nargs="*", metavar="READER", help="default: all")
    return parser.parse_args()


def _case(name: str, rng: Random, folder: Path) -> Path:
    """The files of a seed, of which one is mutated, and what is given to the reader: the folder, or its only file."""
    shutil.rmtree(folder, ignore_errors=True)
    files = rng.choice(seeds(name))
    victim = rng.choice(sorted(files))
    for path, content in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(_mutated(rng, content) if path == victim else content)
    return folder / victim if len(files) == 1 else folder


def _mutated(rng: Random, content: bytes) -> bytes:
    for _ in range(rng.choice((1, 1, 2, 3, 6))):
        content = rng.choice((_number, _number, _bytes, _bytes, _line, _cut))(rng, content)
    return content


def _number(rng: Random, content: bytes) -> bytes:
    found = list(_NUMBER.finditer(content))
    if not found:
        return content
    place = rng.choice(found)
    return content[: place.start()] + rng.choice(_HOSTILE) + content[place.end() :]


def _bytes(rng: Random, content: bytes) -> bytes:
    at, new = rng.randrange(len(content) + 1), rng.choice((*_BYTES, bytes([rng.randrange(256)])))
    return content[:at] + new + content[at + rng.choice((0, 1, len(new))) :]


def _line(rng: Random, content: bytes) -> bytes:
    lines = content.split(b"\n")
    lines.insert(
        rng.randrange(len(lines) + 1), lines.pop(rng.randrange(len(lines))) if rng.random() < 0.5 else rng.choice(lines)
    )
    return b"\n".join(lines)


def _cut(rng: Random, content: bytes) -> bytes:
    start = rng.randrange(len(content) + 1)
    return content[:start] + content[start + rng.choice((1, 4, 40, 4000)) :]


def _failure(read: Callable[[Path], object], path: Path) -> str | None:
    """Why a reader failed, and where in the code; None if it did as it should."""
    signal.alarm(_SECONDS)
    try:
        read(path)
    except (AmurosError, InvalidArgumentError):
        pass
    except Exception as error:
        frame = [each for each in extract_tb(error.__traceback__) if "amalthea_uros" in each.filename][-1]
        return f"{type(error).__name__} at {Path(frame.filename).name}:{frame.lineno}: {str(error)[:100]}"
    finally:
        signal.alarm(0)
    return None


def _late(_number: int, _frame: FrameType | None) -> NoReturn:
    raise TimeoutError(f"no result after {_SECONDS} s")


def _kept(path: Path, target: Path) -> Path:
    target.parent.mkdir(parents=True, exist_ok=True)
    return Path(
        shutil.copytree(path, target, dirs_exist_ok=True) if path.is_dir() else shutil.copy(path, f"{target}{path.suffix}")
    )


def _baseline(path: Path) -> None:
    try:
        read_baseline(path)
    except ValueError as error:
        raise InvalidArgumentError(str(error)) from None


def _can_log(path: Path) -> object:
    return amalthea_uros.measure(path, start="0x1", end="0x2", counter="byte 0")


def _with_dbc(path: Path) -> object:
    return amalthea_uros.measure(path / "run.log", markers=path / "markers.yml", dbc=path / "bus.dbc")


def _trace(path: Path) -> object:
    return amalthea_uros.measure(path).to_records(full=True)


def _table(path: Path) -> object:
    return amalthea_uros.measure(path, columns=["start_us=A.execution_time", "end_us - start_us=B"])


#: What is done with the files of `fuzzing.seeds` of the same name.
READERS: dict[str, Callable[[Path], object]] = {
    "amxmi": lambda path: open_system([path]),
    "baseline": _baseline,
    "can": _can_log,
    "dbc": _with_dbc,
    "description": describe,
    "description-checked": lambda path: check_files(path),
    "iprx": lambda path: open_system([path]),
    "meta": lambda path: check_colcon_meta(ROOT / "samples" / "drive-and-lift.yaml", path),
    "older-amxmi": lambda path: open_system([path]),
    "recording": import_recording,
    "sources": import_code,
    "table": _table,
    "trace": _trace,
}

if __name__ == "__main__":
    main()
