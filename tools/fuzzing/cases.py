"""Cases: the content of a file, made from another one by a number."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from random import Random
from zipfile import ZIP_DEFLATED, ZipFile

from templating import ROOT

from fuzzing import description_mutations, model_mutations, source_mutations
from fuzzing.descriptions import make_description
from fuzzing.models import make_model

_DESCRIPTIONS = (".yaml", ".yml")
_MODELS = (".amxmi",)
_PROJECTS = (".iprx",)
#: What else commands read: sources to import, build options to check, databases of CAN frames.
_SOURCES = (".c", ".cpp", ".ino")
_OTHERS = (*_SOURCES, ".meta", ".dbc")
#: Kinds of files, and how often each is taken; there are many more models to start from than others.
_KINDS = ((_DESCRIPTIONS, 0.3), (_MODELS, 0.25), (_OTHERS, 0.1))
#: Random models with limits that they break.
_MADE_MODELS = 0.1
#: Of the rest of the cases, which are made by chance, that of those that are not mutated.
_UNCHANGED = 0.6
#: In bytes; larger files take too long to tell anything more.
_MAX_SIZE = 60_000
_ENCODINGS = ("utf-16", "utf-8-sig", "latin-1", "cp1252", "utf-32")


@dataclass(frozen=True, slots=True)
class Case:
    """A file to read.

    Attributes
    ----------
    name : file name, whose suffix says what it is
    """

    name: str
    content: bytes


def starting_points(folders: list[Path]) -> list[Path]:
    """The files that cases are made from: samples, hostile files, and those in further folders."""
    own = [path for name in ("samples", "samples/sources", "tests/hostile") for path in sorted((ROOT / name).iterdir())]
    files = [*own, *(path for folder in folders for path in sorted(folder.rglob("*")))]
    known = (*_DESCRIPTIONS, *_MODELS, *_OTHERS)
    return [path for path in files if path.suffix in known and path.is_file() and path.stat().st_size <= _MAX_SIZE]


def make_case(number: int, seed: int, files: list[Path]) -> Case:
    """The case of a number; the same for the same seed and files."""
    rng = Random(f"{seed}:{number}")
    share = rng.random()
    for suffixes, part in _KINDS:
        if share < part:
            path = rng.choice([path for path in files if path.suffix in suffixes])
            return Case(f"case{path.suffix}", _mutated(rng, path, path.read_bytes()))
        share -= part
    if share < _MADE_MODELS:
        return Case("case.amxmi", make_model(rng))
    path, content = Path("case.yaml"), make_description(rng).encode()
    return Case(path.name, content if rng.random() < _UNCHANGED else _mutated(rng, path, content))


def _mutated(rng: Random, path: Path, content: bytes) -> bytes:
    try:
        text = content.decode()
    except UnicodeDecodeError:
        return _flipped(rng, content)
    mutations = mutations_of(path.suffix)
    for _ in range(rng.choice((1, 1, 1, 2, 3, 8))):
        if text:
            text = rng.choice(mutations)(rng, text)
    return _encoded(rng, path, text)


def mutations_of(suffix: str) -> Sequence[Callable[[Random, str], str]]:
    """The mutations of texts that know what such files consist of."""
    if suffix in _DESCRIPTIONS:
        return description_mutations.MUTATIONS
    if suffix in (*_MODELS, *_PROJECTS):
        return model_mutations.MUTATIONS
    return source_mutations.MUTATIONS


def _encoded(rng: Random, path: Path, text: str) -> bytes:
    if rng.random() < 0.97:
        return text.encode(errors="surrogatepass")
    match rng.choice(("encoding", "zip", "bytes")):
        case "encoding":
            return text.encode(rng.choice(_ENCODINGS), errors="replace")
        case "zip":
            archive = BytesIO()
            with ZipFile(archive, "w", ZIP_DEFLATED) as target:
                for name in rng.choice((("ResourceContents",), (path.name,), ("../x",), ("a", "b"), ())):
                    target.writestr(name, text)
            return archive.getvalue() if rng.random() < 0.7 else _flipped(rng, archive.getvalue())
    return _flipped(rng, text.encode())


def _flipped(rng: Random, content: bytes) -> bytes:
    if not content:
        return content
    at = rng.randrange(len(content))
    return content[:at] + bytes([rng.randrange(256)]) + content[at + 1 :]
