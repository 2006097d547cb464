"""Base of all sections of an `app.yaml`: their keys are known, and they know their locations.

Nothing is made of a class until a section of it is; what reads a file needs a third of them. Annotations are text in their modules.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Self, dataclass_transform

from amalthea_uros.diagnostics import Location
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.spec.fields import EXAMINES, REQUIRED, KeyEntry, entry
from amalthea_uros.spec.nodes import MappingNode, Node, SequenceNode, YamlText
from amalthea_uros.spec.type_checks import WRONG, Check, Errors, Path, WrongValueError, check_of, wrong

#: How keys begin that are for other tools, or for anchors; they are ignored.
EXTENSION = "x-"
#: Types by the modules and the texts that name them.
_TYPES: dict[tuple[str, str], Any] = {}


class SectionField:
    """A key of a section.

    Attributes
    ----------
    name : of the attribute
    alias : how files write it, if not as the attribute is called
    metadata : marks of its type, beside those in the type
    """

    __slots__ = ("_check", "_module", "_text", "alias", "default", "default_factory", "metadata", "name")

    def __init__(self, name: str, text: str, module: str, stated: Any) -> None:
        said = stated if isinstance(stated, KeyEntry) else KeyEntry(stated, None, None, ())
        self.name, self.alias, self.metadata = name, said.alias, said.marks
        self.default, self.default_factory = said.default, said.default_factory
        self._text, self._module = text, module
        self._check: Check | None = None

    @property
    def key(self) -> str:
        """How files write it."""
        return self.alias or self.name

    @property
    def is_required(self) -> bool:
        """Whether there is no default."""
        return self.default is REQUIRED and self.default_factory is None

    @property
    def annotation(self) -> Any:
        """Its type."""
        place = self._module, self._text
        if place not in _TYPES:
            _TYPES[place] = eval(self._text, vars(sys.modules[self._module]))
        return _TYPES[place]

    @property
    def check(self) -> Check:
        """The check of its values."""
        if self._check is None:
            self._check = check_of(self.annotation, self.metadata)
        return self._check

    def made_default(self) -> Any:
        """The default."""
        return self.default if self.default_factory is None else self.default_factory()


class SectionKind(type):
    """The class of a kind of sections, whose keys are read when somebody asks for them."""

    _fields: dict[str, SectionField]

    @property
    def model_fields(cls) -> dict[str, SectionField]:
        """The keys by the names of the attributes: those of its bases first, in their places also where it has them anew."""
        if "_fields" not in vars(cls):
            fields: dict[str, SectionField] = {}
            for base in reversed(cls.__mro__):
                annotations = vars(base).get("__annotations__", {}) if isinstance(base, SectionKind) else {}
                for name, text in annotations.items():
                    if not name.startswith("_") and not text.startswith("ClassVar"):
                        fields[name] = SectionField(name, text, base.__module__, vars(base).get(name, REQUIRED))
            cls._fields = fields
        return cls._fields


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(entry,))
class DescriptionSection(metaclass=SectionKind):
    """A mapping of the file."""

    _where: tuple[MappingNode, YamlText] | None = None
    #: The section that gives the keys that this one does not state; see `spec.merging`.
    _base: DescriptionSection | None = None
    #: The keys that are stated.
    _stated: frozenset[str] = frozenset()

    def __init__(self, **values: Any) -> None:
        self.__dict__.update(type(self).model_validate(values).__dict__)

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            raise AttributeError(f"{type(self).__name__!r} objects do not change: {name!r}")
        self.__dict__[name] = value

    if not TYPE_CHECKING:  # which would take the classes themselves for values without a hash

        def __eq__(self, other: object) -> bool:
            return type(self) is type(other) and self._compared() == other._compared()

        def __hash__(self) -> int:
            return hash((type(self), *(self.__dict__[name] for name in type(self).model_fields)))

    def __repr__(self) -> str:
        values = (f"{name}={self.__dict__[name]!r}" for name in type(self).model_fields)
        return f"{type(self).__name__}({', '.join(values)})"

    @property
    def model_fields_set(self) -> frozenset[str]:
        """The keys that are stated, by the names of the attributes."""
        return self._stated

    def _compared(self) -> tuple[Any, ...]:
        return ([self.__dict__[name] for name in type(self).model_fields], self._where, self._base)

    @classmethod
    def model_validate(cls, value: Any) -> Self:
        """A section of the content of a file.

        Raises
        ------
        InvalidArgumentError : something in it is wrong; the text has all errors.
        """
        errors: Errors = []
        section = cls.checked(value, (), errors)
        if section is WRONG:
            lines = [f"  {'.'.join(map(str, each['loc']))}: {each['msg']}" for each in errors]
            raise InvalidArgumentError("\n".join([f"{len(errors)} error(s) in {cls.__name__}", *lines]))
        return section  # type: ignore[no-any-return]

    @classmethod
    def model_construct(cls, **values: Any) -> Self:
        """A section with values that are not checked, and defaults."""
        every = {name: values[name] if name in values else field.made_default() for name, field in cls.model_fields.items()}
        return cls._made(every, frozenset(values))

    def model_copy(self, update: Mapping[str, Any] | None = None) -> Self:
        """The section with some other values, which are not checked."""
        section = type(self)._made(self.__dict__, self.model_fields_set)
        if update:
            section.__dict__.update(update)
            section._stated = self.model_fields_set | update.keys()
        return section

    @classmethod
    def checked(cls, value: Any, loc: Path, errors: Errors) -> Any:
        """A section of the content of a file; `WRONG` with errors if something in it is."""
        try:
            value = cls._prepared(value)
            if not isinstance(value, cls):
                value = cls._of_keys(value, loc, errors)
            if value is not WRONG:
                for examine in cls._examinations():
                    examine(value)
        except WrongValueError as problem:
            return wrong(errors, problem.kind, loc, value, str(problem))
        return value

    @classmethod
    def _prepared(cls, value: Any) -> Any:
        """The content without keys that are not for amuros."""
        if not isinstance(value, dict):
            return value
        return {key: item for key, item in value.items() if not key.startswith(EXTENSION)}

    @classmethod
    def implied_keys(cls) -> Mapping[str, Sequence[str]]:
        """Keys that must be stated only where another one is not, by that one."""
        return {}

    @classmethod
    def _of_keys(cls, value: Any, loc: Path, errors: Errors) -> Any:
        if not isinstance(value, dict):
            return wrong(errors, "model_type", loc, value, "expected a mapping")
        former, values, stated = len(errors), {}, set()
        for name, field in cls.model_fields.items():
            key = field.key
            if key in value:
                stated.add(name)
                item, place = value[key], (*loc, key)
                # A key without a value is a mistake also where the key is optional.
                given = item is not None
                values[name] = field.check(item, place, errors) if given else wrong(errors, "empty", place, item, "no value")
            elif field.is_required:
                wrong(errors, "missing", (*loc, key), value, "missing")
            else:
                values[name] = field.made_default()
        known = {field.key for field in cls.model_fields.values()} if len(stated) < len(value) else value
        for key in value:
            if key not in known:
                wrong(errors, "extra_forbidden", (*loc, key), value[key], "unknown key")
        return WRONG if len(errors) > former else cls._made(values, frozenset(stated))

    @classmethod
    def _made(cls, values: Mapping[str, Any], stated: frozenset[str]) -> Self:
        section = object.__new__(cls)
        section.__dict__.update(values)
        section._stated = stated
        return section

    @classmethod
    def _examinations(cls) -> list[Callable[[Any], Any]]:
        if "_examining" not in cls.__dict__:
            names = {name for base in cls.__mro__ for name, each in base.__dict__.items() if hasattr(each, EXAMINES)}
            cls._examining = [getattr(cls, name) for name in sorted(names)]
        return cls._examining

    _examining: ClassVar[list[Callable[[Any], Any]]]

    def location(self, key: str | None = None, index: int | None = None) -> Location | None:
        """Location of the section, of the value of a key, or of an item of that value; None if it was not read from a file.

        A key that is not given has the location of the section; one that a platform gives has its location there.
        """
        where = self._where
        if key is not None and self._base is not None and (where is None or key not in where[0].items):
            inherited = self._base.location(key, index)
            if inherited is not None and self._base.states(key):
                return inherited
        if where is None:
            return None
        own, source = where
        node: Node = own
        if key is not None and key in own.items:
            node = own.items[key]
            if index is not None and isinstance(node, SequenceNode):
                node = node.items[index]
        return source.location(node.place)

    def move_to(self, other: DescriptionSection, key: str) -> None:
        """Give the section and those in it the location of a key of another one, which names the file that they are from."""
        if other._where is not None:
            own, source = other._where
            attach_locations(self, MappingNode(own.items.get(key, own).place, {}, {}), source)

    def states(self, key: str) -> bool:
        """Whether the author wrote the key, or that of the platform."""
        return key in self.model_fields_set

    def inherits(self, key: str) -> bool:
        """Whether the key is stated, but not in the text of the section: a known platform states it."""
        return self.states(key) and self._where is not None and key not in self._where[0].items


class Shorthand(DescriptionSection):
    """A section that may be written as a plain value.

    Attributes
    ----------
    shorthand : the keys that get the plain value
    plain_value : what the plain value means
    nested : the section of that value, if it may be a mapping itself
    """

    shorthand: ClassVar[tuple[str, ...]]
    plain_value: ClassVar[str]
    nested: ClassVar[type[DescriptionSection] | None] = None

    @classmethod
    def _prepared(cls, value: Any) -> Any:
        return super()._prepared(cls._of_plain_value(value))

    @classmethod
    def _of_plain_value(cls, value: Any) -> Any:
        if cls._is_whole(value):
            return value
        return dict.fromkeys(cls.shorthand, value)

    @classmethod
    def _is_whole(cls, value: Any) -> bool:
        """Whether a value is no plain one."""
        return isinstance(value, DescriptionSection) or (isinstance(value, dict) and not cls._is_nested(value))

    @classmethod
    def _is_nested(cls, value: dict[str, Any]) -> bool:
        if cls.nested is None or not cls.model_fields.keys().isdisjoint(value):
            return False
        return not cls.nested.model_fields.keys().isdisjoint(value)


def attach_locations(value: Any, node: Node, source: YamlText) -> None:
    """Attach their locations to a section and everything in it."""
    if isinstance(value, DescriptionSection) and isinstance(node, MappingNode):
        value._where = node, source
        # A section that is not given, or given as a shorthand, has the location of the outer one; in a shorthand also its keys.
        outer = node if isinstance(value, Shorthand) else MappingNode(node.place, {}, {})
        for name, field in type(value).model_fields.items():
            inner = node.items.get(field.key, outer)
            if inner is not outer or isinstance(getattr(value, name), DescriptionSection):
                attach_locations(getattr(value, name), inner, source)
    elif isinstance(value, DescriptionSection):
        is_list = isinstance(value, Shorthand) and isinstance(node, SequenceNode)
        items = dict.fromkeys(value.shorthand, node) if is_list and isinstance(value, Shorthand) else {}
        attach_locations(value, MappingNode(node.place, items, {}), source)
    elif isinstance(value, list | tuple) and isinstance(node, SequenceNode):
        for item, inner in zip(value, node.items, strict=True):
            attach_locations(item, inner, source)
    elif isinstance(value, dict) and isinstance(node, MappingNode):
        for key, item in value.items():
            attach_locations(item, node.items[key], source)
