"""Tables of results as files: CSV, JSON or Parquet, by the suffix of the path."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Sequence
from io import StringIO
from pathlib import Path
from typing import TypeAlias

from amalthea_uros._internal.csv_cells import safe_cell
from amalthea_uros._internal.file_writing import result_path, write_bytes
from amalthea_uros._internal.files import STANDARD_OUTPUT, FileError, is_file
from amalthea_uros.design.campaign.run import Record, Value
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.xmi.emf.files import not_writable

#: The content of a file with a table: columns, rows -> bytes.
TableFormat: TypeAlias = Callable[[Sequence[str], Sequence[Record]], bytes]


def table_format(path: Path) -> TableFormat:
    """The format for a path; CSV for standard output.

    Raises
    ------
    InvalidArgumentError : no format has the suffix, or it needs a package that is not installed.
    """
    if path == STANDARD_OUTPUT:
        return _csv
    if path.suffix.lower() not in _FORMATS:
        known = ", ".join(_FORMATS)
        raise InvalidArgumentError(f"{str(path)!r}: unknown kind of table; expected one of {known}, e.g. runs.csv")
    found = _FORMATS[path.suffix.lower()]
    if found is _parquet:
        _require_pyarrow()
    return found


def write_table(path: Path, rows: Sequence[Record], *, is_complete: bool = True) -> Path | None:
    """Write a table whole or not at all; a column for each name in any of the rows.

    A table that is not complete, as after an interruption, never replaces a former one: it is written beside it, as `runs.partial.csv`.
    Without rows, a former table stays what it is.

    Returns
    -------
    Path | None
        What was written; None if there was nothing to write.

    Raises
    ------
    InvalidArgumentError : as for `table_format`.
    WriteError : the file cannot be written.
    """
    if not rows and (is_file(path) or not is_complete):
        return None
    target = result_path(path, is_complete=is_complete)
    columns = list(dict.fromkeys(name for row in rows for name in row))
    try:
        write_bytes(target, table_format(path)(columns, rows))
    except FileError as error:
        raise not_writable(error) from None
    return target


def _csv(columns: Sequence[str], rows: Sequence[Record]) -> bytes:
    stream = StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(map(safe_cell, columns))
    writer.writerows([_cell(row.get(column)) for column in columns] for row in rows)
    return stream.getvalue().encode()


def _cell(value: Value) -> Value:
    return safe_cell(value) if isinstance(value, str) else value


def _json(columns: Sequence[str], rows: Sequence[Record]) -> bytes:
    """A list of objects, of which each has all columns."""
    lines = (json.dumps({column: row.get(column) for column in columns}, ensure_ascii=False) for row in rows)
    return ("[\n" + ",\n".join(lines) + "\n]\n").encode()


def _parquet(columns: Sequence[str], rows: Sequence[Record]) -> bytes:
    import pyarrow
    from pyarrow import parquet

    def array(values: list[Value]) -> object:
        try:
            return pyarrow.array(values)
        except (pyarrow.ArrowException, OverflowError):  # texts among numbers, or numbers beyond 64 bits
            return pyarrow.array([None if value is None else str(value) for value in values])

    table = pyarrow.table({column: array([row.get(column) for row in rows]) for column in columns})
    stream = pyarrow.BufferOutputStream()
    parquet.write_table(table, stream)
    content: bytes = stream.getvalue().to_pybytes()
    return content


def _require_pyarrow() -> None:
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        raise InvalidArgumentError("Parquet needs the package 'pyarrow'; install it with: pip install amuros[pandas]") from None


_FORMATS: dict[str, TableFormat] = {".csv": _csv, ".json": _json, ".parquet": _parquet}
