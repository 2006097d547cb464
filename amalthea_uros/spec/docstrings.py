"""The docstrings of the fields of sections, as descriptions in the JSON Schema.

They are read from the source when somebody needs them.
"""

from __future__ import annotations

import ast
import inspect
from functools import cache
from textwrap import dedent

from amalthea_uros.spec.section import DescriptionSection


def field_docstrings(section: type[DescriptionSection]) -> dict[str, str]:
    """The docstrings of the fields of a class and of those that it extends, by the keys that a file has.

    A section whose own docstring is the same needs no second one.
    """
    texts: dict[str, str] = {}
    for base in reversed(section.__mro__):
        if issubclass(base, DescriptionSection) and base is not DescriptionSection:
            texts |= _of_class(base)
    fields = section.model_fields.items()
    return {
        field.key: texts[name]
        for name, field in fields
        if name in texts and not (isinstance(field.annotation, type) and inspect.getdoc(field.annotation) == texts[name])
    }


@cache
def _of_class(section: type[DescriptionSection]) -> dict[str, str]:
    (definition,) = ast.parse(dedent(inspect.getsource(section))).body
    assert isinstance(definition, ast.ClassDef)
    texts = {}
    for field, text in zip(definition.body, definition.body[1:], strict=False):
        match field, text:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(docstring))):
                texts[name] = inspect.cleandoc(docstring)
    return texts
