"""What mkdocs calls while it builds the site: pages of findings and notebooks, lists that follow the code, links out of docs/."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from itertools import chain
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from site_api import OTHERS, PAGES, api_list
from site_commands import command_lists
from site_notebooks import LINK, notebook_pages
from site_rules import rule_pages

from amalthea_uros._internal.addresses import REPOSITORY

#: Pages that end with what is generated from the code when the site is built, so that it is never stale.
GENERATED: dict[str, Callable[[], str]] = {
    **{f"api/{page}.md": partial(api_list, page) for page in (*PAGES, OTHERS)},
    "commands.md": command_lists,
}

_FINDING = re.compile(r"^\| ([A-Z][\w/.-]+) (?=\| (?:error|warning|info) \|)", re.MULTILINE)
_GRAPH = re.compile(r"```mermaid\n(.*?)```", re.DOTALL)
_ARROW = re.compile(r"(\w+) --> (\w+)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages of the findings, and those of the notebooks in place of their files."""
    for path, text in chain(rule_pages(), notebook_pages(Path(config.docs_dir))):
        files.append(File.generated(config, path, content=text))
    return Files(file for file in files if not file.src_uri.endswith(".ipynb"))


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Complete a page, and lead ids of findings to their pages, and links to files outside of docs/ to the repository."""
    path = page.file.src_uri
    if path in GENERATED:
        markdown = f"{markdown.rstrip()}\n\n{GENERATED[path]()}"
    if page.file.generated_by:
        return markdown
    top = "../" * path.count("/")
    markdown = _FINDING.sub(rf"| [\1]({top}rules/\1.md) ", markdown)
    markdown = LINK.sub(r"](\1.md)", markdown)
    markdown = _GRAPH.sub(lambda found: _arrows(found[1]), markdown)
    return re.sub(rf"\]\({re.escape(top)}\.\./([^)]+)\)", rf"]({REPOSITORY}/blob/main/\1)", markdown)


def _arrows(graph: str) -> str:
    """A graph as a list: the theme would load the script that draws it from another host."""
    arrows = sorted(_ARROW.findall(graph))
    ends = {start: ", ".join(f"`{end}`" for source, end in arrows if source == start) for start, _ in arrows}
    return "\n".join(f"- `{start}` \N{RIGHTWARDS ARROW} {found}" for start, found in ends.items()) + "\n"
