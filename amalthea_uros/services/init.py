"""The first `app.yaml` of a user: a commented one for a board, or a copy of an example."""

from __future__ import annotations

import re
from pathlib import Path

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros._internal.files import is_stream
from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.resources import PLATFORMS, known_platforms, resource_folder
from amalthea_uros.services.files import save_new

#: The board of somebody who names none.
DEFAULT_BOARD = "generic"
FILE_NAME = "app.yaml"
_SUFFIXES = (".yaml", ".yml")
#: A comment at the start of a file explains the file; its first sentence is enough in a list.
_COMMENT = re.compile(r"\A(?:#.*\n)+")
_SENTENCE_END = re.compile(r"[.:](?:\s|$)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Offered:
    """Something that a description can begin with.

    Attributes
    ----------
    summary : what it is, in one line
    """

    name: str
    summary: str


@dataclass(frozen=True, slots=True, kw_only=True)
class InitResult:
    """A description that was written.

    Attributes
    ----------
    path : the file
    origin : the board or the example that it is for, as people say it
    measurement : what was measured of the example: a log of a CAN bus and its markers, in the same folder
    database : the DBC file that the example names, in the same folder
    """

    path: Path
    origin: str
    measurement: tuple[Path, ...] = ()
    database: Path | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Catalogue:
    """Everything that a description can begin with."""

    boards: tuple[Offered, ...]
    examples: tuple[Offered, ...]


def example_names() -> list[str]:
    """The names of the examples that come with this package."""
    return sorted(path.stem for path in _samples().glob("*.yaml"))


def catalogue() -> Catalogue:
    """All boards and examples, each with what its file says first."""
    return Catalogue(
        boards=tuple(_offered(PLATFORMS / f"{name}.yaml") for name in known_platforms()),
        examples=tuple(_offered(_samples() / f"{name}.yaml") for name in example_names()),
    )


def init_from_board(target: Path, board: str = DEFAULT_BOARD, *, force: bool = False) -> InitResult:
    """Write a commented description for a board.

    Parameters
    ----------
    target : a file; or a folder, which is created if it does not exist
    board : the name of a platform
    force : replace a file that exists

    Raises
    ------
    WriteError : the file exists, or cannot be written.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from amalthea_uros.services.board_values import looping_values

    folder = resource_folder("templates/init")
    environment = Environment(loader=FileSystemLoader(folder), undefined=StrictUndefined, keep_trailing_newline=True)
    looping = looping_values(board)
    text = environment.get_template(FILE_NAME if looping is None else "looping.yaml").render(
        board=board, summary=_offered(PLATFORMS / f"{board}.yaml").summary, documentation=DOCUMENTATION, **(looping or {})
    )
    path = _place(target)
    save_new({path: text}, force=force)
    return InitResult(path=path, origin=f"board {board}")


def init_from_example(target: Path, example: str, *, force: bool = False) -> InitResult:
    """Write a copy of an example, and of its measurement and its DBC file if it has one.

    A DBC file that is there already with the same text remains: several examples share it.

    Parameters
    ----------
    target, force : as for `init_from_board`
    example : its name

    Raises
    ------
    WriteError : a file exists, or cannot be written.
    """
    path = _place(target)
    origins = {path: _samples() / f"{example}.yaml"}
    measurement, database = {}, {}
    if not is_stream(path):
        measurement = {path.parent / origin.name: origin for origin in _measurement(example)}
        database = {path.parent / origin.name: origin for origin in _databases(example)}
    texts = {place: origin.read_text(encoding="utf-8") for place, origin in (origins | measurement | database).items()}
    save_new({place: text for place, text in texts.items() if not (place in database and _has(place, text))}, force=force)
    return InitResult(
        path=path, origin=f"example {example}", measurement=tuple(measurement), database=next(iter(database), None)
    )


def _has(path: Path, text: str) -> bool:
    try:
        return path.read_text(encoding="utf-8") == text
    except (OSError, ValueError):
        return False


def _databases(example: str) -> list[Path]:
    """Named like the example, or like the first part of the names of several."""
    return [path for path in _samples().glob("*.dbc") if example == path.stem or example.startswith(f"{path.stem}-")]


def _measurement(example: str) -> list[Path]:
    found = (_samples() / f"{example}{suffix}" for suffix in (".log", ".markers.yml"))
    return [path for path in found if path.exists()]


def _samples() -> Path:
    return resource_folder("samples")


def _offered(path: Path) -> Offered:
    comment = _COMMENT.match(path.read_text(encoding="utf-8"))
    text = " ".join(line.lstrip("# ") for line in comment[0].splitlines()) if comment else ""
    return Offered(name=path.stem, summary=_SENTENCE_END.split(text)[0])


def _place(target: Path) -> Path:
    return target if is_stream(target) or (target.suffix in _SUFFIXES and not target.is_dir()) else target / FILE_NAME
