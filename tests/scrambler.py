"""Rewrites a canonical text into one that says the same and looks as if many people and tools had been at it."""

import re
from typing import Any, NamedTuple

from amalthea_uros.metamodel.versions import facts

LINE = re.compile(r"<(?P<end>/?)(?P<tag>[^\s/>]+)(?P<attributes>[^<]*?)(?P<empty>/?)>$")
ATTRIBUTE = re.compile(r'([^\s=]+)="([^"]*)"')
PLAIN = re.compile(r"[A-Za-z0-9_.]")


class Node(NamedTuple):
    tag: str
    attributes: list[tuple[str, str]]
    children: list[Any]


def tree(text: str) -> Node:
    """The elements of a canonical text, with values as they stand between the quotes."""
    stack = [Node("", [], [])]
    for line in text.split("\n")[1:-1]:
        match = LINE.match(line.strip(" "))
        if match["end"]:
            stack.pop()
            continue
        node = Node(match["tag"], ATTRIBUTE.findall(match["attributes"]), [])
        stack[-1].children.append(node)
        if not match["empty"]:
            stack.append(node)
    return stack[0].children[0]


class Scrambler:
    """One way of writing things; `rng` decides which. Comments and unknown things carry numbers, to find them again."""

    def __init__(self, rng, version: str, is_ascii: bool = False) -> None:
        self.rng = rng
        self.facts = facts(version)
        self.count = 0
        self.prefixes = {
            "am": rng.choice(["am", "m", "amalthea"]),
            "xsi": rng.choice(["xsi", "i"]),
            "xmi": rng.choice(["xmi", "x"]),
        }
        self.indent = rng.choice(["  ", "    ", "\t", "", None])
        self.keeps_ids = rng.random() < 0.7
        self.comment = "<!-- {} <a> & 'b' -->" if is_ascii else "<!-- {} <ä> & '名' -->"

    def chance(self, probability: float) -> bool:
        return self.rng.random() < probability

    def number(self) -> str:
        self.count += 1
        return f"mark{self.count}."

    def text(self, canonical: str, declaration: str = '<?xml version="1.0" encoding="UTF-8"?>\n') -> str:
        root = self.element(tree(canonical), "Amalthea", 0)
        before = self.comment.format(self.number()) + "\n" if self.chance(0.3) else ""
        behind = "\n" + self.comment.format(self.number()) if self.chance(0.3) else ""
        return declaration + before + root + behind + self.rng.choice(["", "\n", "\n\n"])

    def element(self, node: Node, class_name: str, depth: int) -> str:
        tag = self.name(node.tag)
        children = [
            self.element(child, self.class_of(child, class_name), depth + 1) for child in self.interleaved(node.children)
        ]
        if "href" not in dict(node.attributes):
            children = [piece for child in children for piece in (*self.noise(), child)] + self.noise()
        opening = f"<{tag}{''.join(self.attributes(node, class_name))}{self.rng.choice(['', '', ' ', chr(10)])}"
        if children:
            pieces = [self.space(depth + 1) + child for child in children]
            return f"{opening}>{''.join(pieces)}{self.space(depth)}</{tag}{self.rng.choice(['', ' '])}>"
        return opening + self.rng.choice(["/>", "/>", f"></{tag}>", f">{self.space(depth)}</{tag}>"])

    def class_of(self, child: Node, holder_class: str) -> str:
        typed = dict(child.attributes).get("xsi:type")
        return typed.removeprefix("am:") if typed else self.facts.feature(holder_class, child.tag).type

    def interleaved(self, children: list[Node]) -> list[Node]:
        """The children of different features mixed, those of one feature in order."""
        queues: dict[str, list[Node]] = {}
        for child in children:
            queues.setdefault(child.tag, []).append(child)
        order = [child.tag for child in children]
        if self.chance(0.5):
            self.rng.shuffle(order)
        return [queues[tag].pop(0) for tag in order]

    def noise(self) -> list[str]:
        if not self.chance(0.15):
            return []
        number = self.number()
        return [
            self.rng.choice(
                [
                    self.comment.format(number),
                    f"<?tool {number} a='>'?>",
                    f"<unknown n='{number}' b = \"x > y\" />",
                    f"<unknown n='{number}'><!-- / --><name unknown='>'></name>text</unknown>",
                ]
            )
        ]

    def space(self, depth: int) -> str:
        if self.indent is None:
            return self.rng.choice(["", "\n", "\n\n  ", " ", "\n\t\t"])
        return "\n" + self.indent * depth if self.indent else ""

    def attributes(self, node: Node, class_name: str) -> list[str]:
        is_href = "href" in dict(node.attributes)
        kept = [(key, value) for key, value in node.attributes if is_href or not self.leaves_out(key, value, class_name)]
        if self.chance(0.1) and not is_href:
            kept.append((f"unknown{self.count}", self.number() + "&lt;&#38;"))
        if self.chance(0.5):
            self.rng.shuffle(kept)
        return [self.attribute(key, value) for key, value in kept]

    def leaves_out(self, key: str, value: str, class_name: str) -> bool:
        if key == "xmi:id":
            return not self.keeps_ids or self.chance(0.1)
        feature = self.facts.feature(class_name, key)
        return feature is not None and feature.default == value and self.chance(0.5)

    def attribute(self, key: str, value: str) -> str:
        if key == "xsi:type":
            value = value.replace("am:", self.prefixes["am"] + ":")
        elif not key.startswith("xmlns"):
            value = self.respelled(value)
        lead = self.rng.choice([" ", " ", " ", "  ", "\n    ", "\t"])
        equals = self.rng.choice(["=", "=", "=", " = ", "=\n"])
        if self.chance(0.3):
            return f"{lead}{self.name(key)}{equals}'{value.replace(chr(39), '&apos;').replace('&quot;', chr(34))}'"
        return f'{lead}{self.name(key)}{equals}"{value}"'

    def respelled(self, value: str) -> str:
        """A value with some characters as references, and some blanks as line breaks, which a parser reads as blanks."""
        if self.chance(0.1):
            value = value.replace(" ", self.rng.choice(["\n", "\t"]))
        if self.chance(0.1) and "&" not in value:
            value = PLAIN.sub(lambda match: self.rng.choice([match[0], f"&#x{ord(match[0]):X};", f"&#{ord(match[0])};"]), value)
        return value

    def name(self, name: str) -> str:
        if name.startswith("xmlns:"):
            return f"xmlns:{self.prefixes[name.removeprefix('xmlns:')]}"
        prefix, colon, local = name.partition(":")
        return f"{self.prefixes[prefix]}:{local}" if colon else name


ENCODINGS = {
    "utf-8": ("UTF-8", "utf-8"),
    "utf-8 with a byte order mark": ("UTF-8", "utf-8-sig"),
    "utf-16": ("UTF-16", "utf-16"),
    "latin-1": ("ISO-8859-1", "iso-8859-1"),
}
