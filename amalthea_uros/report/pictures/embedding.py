"""Several pictures in one page."""

from __future__ import annotations

import re

from amalthea_uros.report.pictures.svg import Markup

# Text has no angle brackets: they are escaped.
_TAG = re.compile(r"<[^>]*>")
_STYLE = re.compile(r"<style>.*?</style>\n?", re.DOTALL)


def embedded(picture: str, prefix: str) -> Markup:
    """A picture for a page that has other ones and, once, `style.style_sheet`.

    Parameters
    ----------
    prefix : of the ids of the picture, another one for each picture of the page; ASCII letters, digits and hyphens
    """
    return Markup(_TAG.sub(lambda tag: _with_prefix(tag[0], prefix), _STYLE.sub("", picture)))


def _with_prefix(tag: str, prefix: str) -> str:
    return tag.replace(' id="amuros-', f' id="{prefix}-').replace("url(#amuros-", f"url(#{prefix}-")
