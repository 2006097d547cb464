"""Where the product is found; `[project.urls]` states the same addresses."""

from urllib.parse import quote

REPOSITORY = "https://github.com/amuros/amuros"
DOCUMENTATION = "https://amuros.github.io/amuros"


def page_of_finding(identifier: str) -> str:
    """Where an id of a finding is explained."""
    return f"{DOCUMENTATION}/rules/{quote(identifier)}/"
