"""Parses metadata in TSDL (CTF 1.8, section 7 and appendix C): types and the blocks trace, env, clock, stream, event."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple, TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.trace.ctf.types import (
    ArrayType,
    EnumerationType,
    FieldType,
    FloatType,
    IntegerType,
    StringType,
    StructType,
    VariantType,
)
from amalthea_uros.trace.files import UnreadableError

_TOKEN = re.compile(
    r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/)
    |(?P<text>"(?:[^"\\\n]|\\.)*")
    |(?P<char>'(?:[^'\\\n]|\\.)')
    |(?P<number>(?:0[xX][0-9a-fA-F]+|[0-9]+)[uUlL]*)
    |(?P<word>[A-Za-z_][A-Za-z0-9_]*)
    |(?P<sign>:=|\.\.\.|->|[{}\[\]()<>;:,.=*+-])""",
    re.VERBOSE | re.DOTALL,
)


class TsdlToken(NamedTuple):
    """A word, number, text or sign; `kind` is the name of a group above, or "end"."""

    kind: str
    text: str
    line: int


def tokens(source: str, most: int) -> list[TsdlToken]:
    """The tokens of a text, with one for the end.

    Raises
    ------
    UnreadableError : there is something that is none, or there are too many.
    """
    found: list[TsdlToken] = []
    place, line = 0, 1
    while place < len(source):
        match = _TOKEN.match(source, place)
        if match is None or len(found) >= most:
            raise UnreadableError("a character that TSDL does not know" if match is None else f"more than {most:,} words", line)
        kind = match.lastgroup or "skip"
        if kind != "skip":
            found.append(TsdlToken(kind, match[0], line))
        line += match[0].count("\n")
        place = match.end()
    return [*found, TsdlToken("end", "", line)]


#: The depth of types and blocks in each other.
_DEPTH = 32
_MOST_TOKENS = 2_000_000
_MOST_BITS = 1 << 20
_SIZES = range(1, 65)
_TEXT = ("UTF8", "ASCII", "utf8", "ascii", "UTF_8", "utf_8")
_BLOCKS = ("trace", "env", "clock", "stream", "event", "callsite")
_C_WORDS = ("const", "signed", "unsigned", "char", "short", "int", "long", "float", "double", "void", "_Bool", "_Complex")

Value: TypeAlias = int | str | FieldType
_Scope: TypeAlias = dict[str, FieldType]


@dataclass(slots=True)
class MetadataBlock:
    """A block such as `event {...}`: numbers, texts and names by dotted keys, and types."""

    kind: str
    values: dict[str, Value] = field(default_factory=dict)

    def number(self, key: str, default: int) -> int:
        """A number."""
        value = self.values.get(key, default)
        return value if isinstance(value, int) else default

    def text(self, key: str, default: str = "") -> str:
        """A text or a word."""
        value = self.values.get(key, default)
        return value if isinstance(value, str) else default

    def struct(self, key: str) -> StructType | None:
        """A type, None if there is none."""
        value = self.values.get(key)
        return value if isinstance(value, StructType) else None


def parse(source: str) -> list[MetadataBlock]:
    """The blocks of metadata, in their order.

    Raises
    ------
    UnreadableError : they cannot be understood.
    """
    return _TsdlParser(tokens(source, _MOST_TOKENS)).blocks()


class _TsdlParser:
    def __init__(self, found: list[TsdlToken]) -> None:
        self._tokens = found
        self._place = 0
        self._depth = 0
        self._scopes: list[_Scope] = [{}]
        self._is_big_endian = _native_order(found)

    def blocks(self) -> list[MetadataBlock]:
        """All blocks."""
        found = []
        while self._next.kind != "end":
            if self._next.text in _BLOCKS and self._after.text == "{":
                found.append(self._block())
            else:
                self._definition()
        return found

    @property
    def _next(self) -> TsdlToken:
        return self._tokens[self._place]

    @property
    def _after(self) -> TsdlToken:
        return self._tokens[min(self._place + 1, len(self._tokens) - 1)]

    def _error(self, message: str) -> UnreadableError:
        return UnreadableError(message, self._next.line)

    def _take(self, text: str = "") -> TsdlToken:
        token = self._next
        if token.kind == "end" or (text and token.text != text):
            raise self._error(f"expected {text!r}, not {token.text[:40]!r}" if text else "the text ends early")
        self._place += 1
        return token

    def _skip(self, text: str) -> bool:
        if self._next.text == text:
            self._place += 1
            return True
        return False

    def _word(self) -> str:
        token = self._take()
        if token.kind != "word":
            raise self._error(f"expected a name, not {token.text[:40]!r}")
        return token.text

    def _enter(self) -> None:
        self._depth += 1
        if self._depth > _DEPTH:
            raise self._error(f"types are nested more than {_DEPTH} deep")

    def _block(self) -> MetadataBlock:
        block = MetadataBlock(self._word())
        self._take("{")
        self._scopes.append({})
        while not self._skip("}"):
            if self._is_definition():
                self._definition()
                continue
            key = self._key()
            if self._skip(":="):
                block.values[key] = self._type()
            else:
                self._take("=")
                block.values[key] = self._value()
            self._take(";")
        self._scopes.pop()
        self._skip(";")
        return block

    def _key(self) -> str:
        token = self._take()
        parts = [token.text.strip('"')]
        while self._skip("."):
            parts.append(self._word())
        return ".".join(parts)

    def _value(self) -> int | str:
        token = self._next
        if token.kind == "text":
            return self._text()
        if token.kind == "number" or token.text in "+-":
            return self._number()
        if token.kind != "word":
            raise self._error(f"expected a value, not {token.text[:40]!r}")
        return self._key()

    def _text(self) -> str:
        """A text, or several that follow each other."""
        parts = []
        while self._next.kind == "text":
            parts.append(self._take().text[1:-1].replace('\\"', '"').replace("\\\\", "\\"))
        return "".join(parts)

    def _number(self) -> int:
        sign = 1
        while self._next.text in ("+", "-"):
            sign *= -1 if self._take().text == "-" else 1
        token = self._take()
        if token.kind == "char":
            return sign * ord(token.text[-2])
        digits = token.text.rstrip("uUlL")
        if token.kind != "number" or len(digits) > 40:
            raise self._error(f"expected a number, not {token.text[:40]!r}")
        base = (
            16 if digits[:2].lower() == "0x" else 8 if digits.startswith("0") and digits.isdigit() and len(digits) > 1 else 10
        )
        try:
            return sign * int(digits, base)
        except ValueError:
            raise self._error(f"expected a number, not {token.text[:40]!r}") from None

    def _is_definition(self) -> bool:
        token = self._next.text
        if token in ("struct", "variant", "enum"):
            return self._after.text not in (":=", "=", ".")
        return token in ("typealias", "typedef")

    def _definition(self) -> None:
        """A definition of types, which is kept in the present scope."""
        if self._skip("typealias"):
            kind = self._type()
            self._take(":=")
            self._scopes[-1][self._type_name()] = kind
        elif self._skip("typedef"):
            kind = self._type()
            name, kind = self._declarator(kind)
            self._scopes[-1][name] = kind
        elif self._next.text in ("struct", "variant", "enum"):
            self._type()
        else:
            raise self._error(f"expected a definition, not {self._next.text[:40]!r}")
        self._take(";")

    def _type_name(self) -> str:
        """The name of a type, which may have several words and stars."""
        words = [self._word()]
        while self._next.kind == "word" or self._next.text == "*":
            words.append(self._take().text)
        return " ".join(words)

    def _type(self) -> FieldType:
        self._enter()
        word = self._next.text
        try:
            if word == "integer":
                return self._integer()
            if word == "floating_point":
                return self._float()
            if word == "string":
                self._take()
                if self._next.text == "{":
                    self._properties()
                return StringType()
            if word in ("struct", "variant", "enum"):
                return self._named(word)
            return self._alias()
        finally:
            self._depth -= 1

    def _alias(self) -> FieldType:
        """A type by its name: words of C belong together, other names are one word."""
        words = [self._word()]
        if words[0] in _C_WORDS:
            while self._next.text in _C_WORDS:
                words.append(self._word())
        while self._next.text == "*":
            words.append(self._take().text)
        return self._found(" ".join(words))

    def _found(self, name: str) -> FieldType:
        for scope in reversed(self._scopes):
            if name in scope:
                return scope[name]
        raise self._error(f"unknown type {name[:60]!r}")

    def _properties(self) -> dict[str, int | str]:
        found: dict[str, int | str] = {}
        self._take("{")
        while not self._skip("}"):
            key = self._key()
            self._take("=")
            found[key] = self._value()
            self._take(";")
        return found

    def _integer(self) -> IntegerType:
        self._take("integer")
        given = self._properties()
        size = given.get("size", 0)
        if not isinstance(size, int) or size not in _SIZES:
            raise self._error("an integer has 1 to 64 bits")
        clock = str(given.get("map", ""))
        return IntegerType(
            size,
            self._alignment(given.get("align", 8 if size % 8 == 0 else 1)),
            str(given.get("signed", "false")) in ("true", "TRUE", "1"),
            self._order(given),
            str(given.get("encoding", "none")) in _TEXT and size == 8,
            clock.removeprefix("clock.").removesuffix(".value") if clock else "",
        )

    def _float(self) -> FloatType:
        self._take("floating_point")
        given = self._properties()
        size = {(8, 24): 32, (11, 53): 64}.get((given.get("exp_dig"), given.get("mant_dig")))  # type: ignore[arg-type]
        if size is None:
            raise self._error("numbers with a fraction have 32 or 64 bits")
        return FloatType(size, self._alignment(given.get("align", 8)), self._order(given))

    def _order(self, given: Mapping[str, int | str]) -> bool:
        order = given.get("byte_order", "native")
        return self._is_big_endian if order == "native" else order in ("be", "network")

    def _alignment(self, value: int | str) -> int:
        if not isinstance(value, int) or not 0 < value <= _MOST_BITS or value & (value - 1):
            raise self._error("an alignment is a power of two")
        return value

    def _named(self, word: str) -> FieldType:
        """A struct, variant or enumeration, with or without a name."""
        self._take(word)
        name = self._word() if self._next.kind == "word" and self._next.text != "align" else ""
        key = f"{word} {name}"
        if word == "variant":
            return self._variant(name)
        if word == "enum":
            kind: FieldType = self._enumeration() if self._next.text in (":", "{") else self._found(key)
        else:
            kind = self._struct() if self._next.text == "{" else self._found(key)
        if name:
            self._scopes[-1][key] = kind
        return kind

    def _struct(self) -> StructType:
        fields = self._fields()
        align = 1
        if self._skip("align"):
            self._take("(")
            align = self._alignment(self._number())
            self._take(")")
        return StructType(fields, max([align, *(kind.align for _, kind in fields)]))

    def _fields(self) -> tuple[tuple[str, FieldType], ...]:
        fields: list[tuple[str, FieldType]] = []
        self._take("{")
        self._scopes.append({})
        while not self._skip("}"):
            if self._next.text in ("typealias", "typedef"):
                self._definition()
                continue
            kind = self._type()
            if self._skip(";"):
                continue  # a definition of a struct, variant or enumeration with a name
            fields.append(self._field(kind))
            while self._skip(","):
                fields.append(self._field(kind))
            self._take(";")
        self._scopes.pop()
        return tuple(fields)

    def _field(self, kind: FieldType) -> tuple[str, FieldType]:
        """A field; writers put an underscore before names, so that none is a keyword."""
        name, kind = self._declarator(kind)
        return name.removeprefix("_"), kind

    def _declarator(self, kind: FieldType) -> tuple[str, FieldType]:
        name = self._word()
        lengths: list[int | str] = []
        while self._skip("["):
            lengths.append(self._number() if self._next.kind == "number" else self._key())
            self._take("]")
            if len(lengths) > _DEPTH:
                raise self._error("an array has too many dimensions")
        for length in reversed(lengths):
            kind = ArrayType(kind, length)
        return name, kind

    def _variant(self, name: str) -> VariantType:
        """A variant; its tag may come where it is used."""
        tag = ""
        if self._skip("<"):
            tag = self._key()
            self._take(">")
        if self._next.text == "{":
            kind = VariantType(tag, dict(self._fields()))
            if name:
                self._scopes[-1][f"variant {name}"] = kind
            return kind
        known = self._found(f"variant {name}")
        if not isinstance(known, VariantType):
            raise self._error(f"{name!r} is not a variant")
        return VariantType(tag or known.tag, known.options)

    def _enumeration(self) -> EnumerationType:
        container: FieldType = IntegerType(32, 8, True, self._is_big_endian)
        if self._skip(":"):
            container = self._type()
        elif "int" in self._scopes[0]:
            container = self._scopes[0]["int"]
        if not isinstance(container, IntegerType):
            raise self._error("the type of an enumeration is not an integer")
        self._take("{")
        ranges = tuple(self._ranges())
        self._take("}")
        return EnumerationType(container, ranges)

    def _ranges(self) -> Iterator[tuple[int, int, str]]:
        following = 0
        while self._next.text != "}":
            token = self._take()
            label = token.text[1:-1] if token.kind == "text" else token.text
            first = last = following
            if self._skip("="):
                first = last = self._number()
                if self._skip("..."):
                    last = self._number()
            yield first, last, label
            following = last + 1
            if not self._skip(","):
                return


def _native_order(found: list[TsdlToken]) -> bool:
    """Whether numbers are big-endian unless they say otherwise: `byte_order` of the block `trace`, which may come after types."""
    is_trace, depth = False, 0
    for place, token in enumerate(found[:-4]):
        if depth == 0 and token.text == "trace":
            is_trace = True
        depth += (token.text == "{") - (token.text == "}")
        if is_trace and depth == 1 and token.text == "byte_order" and found[place + 1].text == "=":
            return found[place + 2].text in ("be", "network")
        if depth == 0 and token.text == "}":
            is_trace = False
    return False
