"""The docstrings of the fields of sections, as descriptions in the JSON Schema.

pydantic reads them from the source when it makes a class, which takes a tenth of a run that needs none of them.
"""

from __future__ import annotations

import ast
import inspect
from functools import cache
from textwrap import dedent

from pydantic import BaseModel


def field_docstrings(section: type[BaseModel]) -> dict[str, str]:
    """The docstrings of the fields of a class and of those that it extends, by the keys that a file has.

    A section whose own docstring is the same needs no second one.
    """
    texts: dict[str, str] = {}
    for base in reversed(section.__mro__):
        if issubclass(base, BaseModel) and base is not BaseModel:
            texts |= _of_class(base)
    fields = section.model_fields.items()
    return {
        field.alias or name: texts[name]
        for name, field in fields
        if name in texts and not (isinstance(field.annotation, type) and inspect.getdoc(field.annotation) == texts[name])
    }


@cache
def _of_class(section: type[BaseModel]) -> dict[str, str]:
    (definition,) = ast.parse(dedent(inspect.getsource(section))).body
    assert isinstance(definition, ast.ClassDef)
    texts = {}
    for field, text in zip(definition.body, definition.body[1:], strict=False):
        match field, text:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(docstring))):
                texts[name] = inspect.cleandoc(docstring)
    return texts
