"""The documentation as a site: it builds without a warning, loads nothing from elsewhere, and has what others point to."""

import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import unquote

import pytest
import yaml
from support import ROOT

import amalthea_uros
from amalthea_uros._internal.addresses import DOCUMENTATION, REPOSITORY
from amalthea_uros.cli.main import COMMANDS, cli
from amalthea_uros.findings import catalogue
from amalthea_uros.validate import registry

#: What makes a browser load something at once; a link in the text does not.
LOADING = {"script": "src", "img": "src", "iframe": "src", "source": "src", "object": "data", "embed": "src"}
LOADING_LINKS = {"stylesheet", "icon", "preload", "prefetch", "preconnect", "dns-prefetch", "modulepreload"}

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))

needs_mkdocs = pytest.mark.skipif(
    any(find_spec(name) is None for name in ("mkdocs", "material", "mkdocstrings")), reason="needs pip install amuros[docs]"
)


class Loads(HTMLParser):
    """The addresses that a page loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        of = dict(attrs)
        if tag in LOADING and of.get(LOADING[tag]):
            self.found.append(of[LOADING[tag]])
        if tag == "link" and LOADING_LINKS & set((of.get("rel") or "").split()):
            self.found.append(of["href"])


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    environment = os.environ | {"PYTHONPATH": str(ROOT), "NO_MKDOCS_2_WARNING": "1"}
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", folder]
    built = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    return folder


def text_of(site: Path, page: str) -> str:
    return (site / page / "index.html").read_text()


@needs_mkdocs
def test_the_site(site):
    """One test, so that the site is built once also with several workers."""
    is_page_of_every_finding(site)
    is_complete_for_commands(site)
    is_complete_for_the_library(site)
    shows_the_notebooks(site)
    loads_nothing_external(site)


def is_page_of_every_finding(site: Path) -> None:
    lists = "".join(page.read_text() for folder in ("rules", "findings") for page in (site / folder).glob("*/index.html"))
    for identifier in (*registry.ids(), *catalogue.ids()):
        assert f'href="../{identifier}/"' in lists or f'href="../../rules/{identifier}/"' in lists
        url = registry.rule_url(identifier)
        assert url is not None
        assert "<h1 id=" in text_of(site, unquote(url.removeprefix(DOCUMENTATION + "/")))


def is_complete_for_commands(site: Path) -> None:
    page = text_of(site, "commands")
    for name in COMMANDS:
        assert f"amuros {name}" in page
        command = cli.get_command(None, name)
        shown = (param for param in command.params if not getattr(param, "hidden", False))
        for option in (option for param in shown for option in param.opts if option.startswith("--")):
            assert option in page, f"{name} {option}"


def is_complete_for_the_library(site: Path) -> None:
    page = "".join(page.read_text() for page in (site / "api").glob("*/index.html"))
    shown = {found.rpartition(".")[2] for found in re.findall(r'<h3 id="([\w.]+)" class="doc', page)}
    assert set(amalthea_uros.__all__) - {"am", "errors", "perf", "units"} <= shown


def shows_the_notebooks(site: Path) -> None:
    for path in NOTEBOOKS:
        page = text_of(site, f"notebooks/{path.stem}")
        assert "amuros" in page
        assert f'href="../notebooks/{path.stem}/"' in text_of(site, "library")
        outputs = [output for cell in json.loads(path.read_text())["cells"] for output in cell.get("outputs", ())]
        tables = [table for output in outputs for table in output.get("data", {}).get("text/html", ())]
        assert tables
        assert all(table.strip() in page for table in tables)


def loads_nothing_external(site: Path) -> None:
    for page in site.rglob("*.html"):
        for address in Loads(page.read_text()).found:
            assert not re.match(r"(?:\w+:)?//", address), f"{page.relative_to(site)} loads {address}"
    for style in site.rglob("*.css"):
        assert not re.search(r"url\(\s*['\"]?(?:https?:)?//|@import", style.read_text()), style.name


def test_the_addresses_are_stated_alike():
    text = (ROOT / "mkdocs.yml").read_text()
    settings = yaml.safe_load(text)
    assert settings["site_url"] == DOCUMENTATION
    assert settings["edit_uri_template"].startswith(f"{REPOSITORY}/edit/")
    assert settings["theme"]["font"] is False


def test_every_page_is_in_the_navigation():
    text = (ROOT / "mkdocs.yml").read_text()
    listed = re.findall(r"(?:: |- )([\w./-]+\.(?:md|ipynb))$", text.partition("\nnav:")[2], re.MULTILINE)
    assert len(listed) == len(set(listed))
    assert set(listed) >= {str(path.relative_to(ROOT / "docs")) for path in (ROOT / "docs").rglob("*.md")}
    assert set(listed) >= {f"notebooks/{path.stem}.md" for path in NOTEBOOKS}


def test_rules_of_users_have_no_page():
    assert registry.rule_url("ACME-TASK-NAME") is None
