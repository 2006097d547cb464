"""The declarations of fields name attributes that the classes have, so that no result fails only when it is written."""

import pkgutil
from importlib import import_module

import pytest

from amalthea_uros.report import fields
from amalthea_uros.report.fields.declaration import ALSO, TIME_SUFFIX, declared

for module in pkgutil.iter_modules(fields.__path__):
    import_module(f"{fields.__name__}.{module.name}")


def attributes(kind):
    """The attributes of a class: fields of data classes and named tuples, and properties."""
    found = set(dir(kind))
    for base in kind.__mro__:
        found.update(getattr(base, "__annotations__", {}), getattr(base, "_fields", ()))
    return found


@pytest.mark.parametrize("kind", declared(), ids=lambda kind: kind.__name__)
def test_each_field_comes_from_an_attribute(kind):
    sources = [field.removesuffix(TIME_SUFFIX) if isinstance(field, str) else field[1] for field in declared()[kind]]
    first = {source.partition(".")[0] for source in sources if isinstance(source, str)}
    assert first - attributes(kind) == set()


@pytest.mark.parametrize("kind", declared(), ids=lambda kind: kind.__name__)
def test_each_name_is_given_once(kind):
    names = [field if isinstance(field, str) else field[0] for field in declared()[kind]]
    named = [name for name in names if name != ALSO]
    assert len(named) == len(set(named))
