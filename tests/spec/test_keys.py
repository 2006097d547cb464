"""No key of app.yaml is accepted and then ignored."""

import ast

import yaml
from support import ROOT

from amalthea_uros.spec import description as description  # with all its sections
from amalthea_uros.spec import platforms as platforms
from amalthea_uros.spec.section import DescriptionSection

#: The version of the format, for which there is only one value, and where figures come from, for readers.
WITHOUT_EFFECT = {"amuros", "sources"}


def test_every_key_is_read_somewhere():
    read = {name for room in ("spec", "uros") for name in names_read_in(ROOT / "amalthea_uros" / room)}
    assert {key for section in sections(DescriptionSection) for key in section.model_fields} - read == WITHOUT_EFFECT


def sections(base):
    for section in base.__subclasses__():
        yield section
        yield from sections(section)


def names_read_in(folder):
    """The attributes and texts in the code of a folder; keys are read as `task.period`, or by their names from a table.

    Build options are read by the names in the tables of their middlewares.
    """
    for path in folder.rglob("options.yaml"):
        yield from (row["name"] for group in yaml.safe_load(path.read_text()) for row in group["options"])
    for path in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Attribute):
                yield node.attr
            elif isinstance(node, ast.Constant):
                yield node.value
