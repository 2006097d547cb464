"""`amuros fmt`: canonical form, as APP4MC writes it."""

from __future__ import annotations

import sys
from difflib import unified_diff
from pathlib import Path

import click

from amalthea_uros.metamodel.model import Document
from amalthea_uros.xmi.load import load, model_files
from amalthea_uros.xmi.save import save
from amalthea_uros.xmi.writer import document_text


@click.command("fmt")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL...")
@click.option("--check", is_flag=True, help="Write nothing, exit 1 if a file is not in canonical form.")
@click.option("--diff", "show_diff", is_flag=True, help="Write nothing, show what would change, exit 1 if something would.")
def command(paths: tuple[Path, ...], check: bool, show_diff: bool) -> None:
    """Rewrite models in canonical form: as Eclipse APP4MC would save them.

    Order, indentation, number formats, explicit defaults and ids follow APP4MC; the AMALTHEA version, comments and unknown
    content stay. MODEL is a file or a folder with .amxmi files.
    """
    changed = 0
    for path in model_files(paths):
        model = load(path)
        (document,) = model.documents
        if not _differs(document):
            continue
        changed += 1
        if show_diff:
            _show_diff(document)
        elif check:
            click.echo(f"{path}: would be rewritten")
        else:
            save(model, canonical=True)
            click.echo(f"{path}: rewritten")
    sys.exit(1 if changed and (check or show_diff) else 0)


def _differs(document: Document) -> bool:
    assert document.source
    return document_text(document, canonical=True) != document.source.text


def _show_diff(document: Document) -> None:
    assert document.source
    old, new = document.source.text, document_text(document, canonical=True)
    lines = unified_diff(
        old.splitlines(), new.splitlines(), str(document.path), f"{document.path} (canonical)", lineterm="", n=1
    )
    for line in lines:
        click.echo(line)
