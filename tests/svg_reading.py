"""What a reader sees in an SVG picture of ours: its texts with their places, its boxes, and the scale of its time axis."""

from dataclasses import dataclass
from itertools import combinations

from lxml import etree

SVG = "{http://www.w3.org/2000/svg}"
#: A name with everything that means something in XML.
NASTY = """<Task & "friends'>"""
SIZES = {"title": 16, "small": 11}
#: The average of the characters of names and numbers in DejaVu Sans.
EM = 0.58


@dataclass(frozen=True)
class Text:
    content: str
    left: float
    right: float
    base: float
    size: float

    def overlaps(self, other):
        apart = self.right <= other.left or other.right <= self.left
        return not apart and self.base - self.size * 0.75 < other.base and other.base - other.size * 0.75 < self.base


def parsed(picture):
    return etree.fromstring(picture.encode())


def texts(picture):
    """All but those that are rotated."""
    found = [node for node in parsed(picture).iter(f"{SVG}text") if node.get("transform") is None]
    return [placed(node) for node in found]


def placed(node):
    content = "".join(text for text in node.xpath("./text()"))
    classes = (node.get("class") or "").split()
    size = float(node.get("font-size") or next((SIZES[name] for name in classes if name in SIZES), 12))
    width = EM * size * len(content)
    shift = {"start": 0, "middle": width / 2, "end": width}[node.get("text-anchor", "start")]
    left = float(node.get("x")) - shift
    return Text(content, left, left + width, float(node.get("y")), size)


def assert_readable(picture):
    """Well-formed, all text within the picture, no text on another."""
    width, height = map(float, parsed(picture).get("viewBox").split()[2:])
    found = texts(picture)
    for text in found:
        assert text.left >= 0, text
        assert text.right <= width, text
        assert 0 < text.base < height, text
    for one, other in combinations(found, 2):
        assert not one.overlaps(other), (one, other)


def rectangles(picture, tip=""):
    """(x, width) of the rectangles whose tooltip contains something, from left to right."""
    nodes = [node for node in parsed(picture).iter(f"{SVG}rect") if tip in (node.findtext(f"{SVG}title") or "\0")]
    return sorted((float(node.get("x")), float(node.get("width"))) for node in nodes)


def tick_labels(picture):
    """The numbers at the time axis with their middles."""
    nodes = [
        node
        for node in parsed(picture).iter(f"{SVG}text")
        if node.get("class") == "small" and node.get("text-anchor") == "middle"
    ]
    return [(float(node.text), float(node.get("x"))) for node in nodes]


def scale(picture):
    """From numbers at the time axis to pixels."""
    (first, left), *_, (last, right) = tick_labels(picture)
    return lambda value: left + (value - first) / (last - first) * (right - left)


def contents(picture):
    """What is written, but for what is rotated."""
    return [text.content for text in texts(picture)]


def tooltips(picture):
    return [node.text for node in parsed(picture).iter(f"{SVG}title")]
