"""A report as one HTML page, which needs nothing outside of itself."""

from __future__ import annotations

from typing import IO

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from amalthea_uros._internal.addresses import DOCUMENTATION
from amalthea_uros._internal.resources import resource_folder
from amalthea_uros._version import __version__
from amalthea_uros.report.basics.document import Figure
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.documents.opening import facts, opening
from amalthea_uros.report.documents.page import page_sections
from amalthea_uros.report.pictures.page import embedded, style_sheet
from amalthea_uros.services.report import ReportContent


def write(content: ReportContent, stream: IO[str]) -> None:
    """Write the page of a report."""
    template = _environment().get_template("page.html.jinja")
    page = template.render(
        title=content.title,
        date=content.date,
        facts=facts(content),
        verdict=opening(content),
        sections=page_sections(content),
        picture_style=Markup(style_sheet()),
        version=__version__,
        documentation=DOCUMENTATION,
    )
    stream.write(page)


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(resource_folder("templates/report")),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=_finalized,
    )
    environment.filters |= {"file": _file, "picture": _picture}
    return environment


def _finalized(value: object) -> object:
    """Text of models without hidden characters, which could pretend to be other text; a number and its sign stay in one line."""
    if isinstance(value, Markup) or not isinstance(value, str):
        return value
    return visible(value).replace(" %", "\N{NO-BREAK SPACE}%")


def _file(name: str) -> Markup:
    """A file of ours, to be a part of the page."""
    return Markup((resource_folder("templates/report") / name).read_text(encoding="utf-8"))


def _picture(figure: Figure) -> Markup:
    """A picture as a part of a page; its text is escaped already."""
    return Markup(embedded(figure.picture, figure.name))
