"""The facts of an `.iprx` file, as the stored facts of the importer's projects have them; reads with the standard library only."""

import json
from functools import cache
from xml.etree import ElementTree

from support import SHARED

METAMODEL = SHARED / "metamodel" / "inchron-root-3.5.0.json"
VECTORS = SHARED / "vectors" / "iprx"

_TYPE = "{http://www.w3.org/2001/XMLSchema-instance}type"
_ORDERED = {"graphEntries", "calls", "entries", "modes", "discreteDistribution", "steps"}
_NUMBERS = {"EInt": int, "ELong": int, "EDouble": float, "UInteger": int, "EBoolean": lambda text: text == "true"}


@cache
def classes():
    packages = json.loads(METAMODEL.read_text())["packages"]
    return {f"{package['name']}.{name}": cls for package in packages for name, cls in package["classes"].items()}


@cache
def features_of(name):
    found = {}
    for above in classes()[name].get("super", []):
        found |= features_of(above)
    return found | {feature["n"]: feature for feature in classes()[name]["f"]}


class _Facts:
    def __init__(self, text):
        root = ElementTree.fromstring(text)
        self.model = root[0]
        self.prefixes = {}
        for event in ElementTree.iterparse(_Lines(text), ["start-ns"]):
            self.prefixes[event[1][0]] = event[1][1]
        self.paths, self.kinds = {}, {}
        self.visit(self.model, "model.Model", "")

    def kind(self, element, declared):
        if _TYPE not in element.attrib:
            return declared
        prefix, _, name = element.attrib[_TYPE].partition(":")
        package = self.prefixes[prefix].rpartition("/3.5.0")[2].strip("/").replace("/", ".") or "root"
        return f"{package}.{name}"

    def visit(self, element, declared, path):
        kind = self.kinds[element] = self.kind(element, declared)
        if identity := element.get("intrinsicId"):
            assert identity not in self.paths, f"two objects have the id of {path}"
            self.paths[identity] = path
        counts = {}
        for child in element:
            feature = features_of(kind)[child.tag]
            number = counts[child.tag] = counts.get(child.tag, -1) + 1
            own = child.get("name") or (f"{child.tag}[{number}]" if feature.get("hi") == -1 else child.tag)
            if feature["k"] == "c":
                self.visit(child, feature["t"], f"{path}/{own}".lstrip("/"))

    def facts(self, element):
        kind = self.kinds[element]
        found = {"class": kind.removeprefix("model.") if kind.count(".") == 1 else kind}
        for name, feature in features_of(kind).items():
            many = feature.get("hi") == -1
            if feature["k"] == "c":
                parts = [self.facts(child) for child in element if child.tag == name]
                if parts:
                    found[name] = self.sorted(name, parts) if many else parts[0]
            elif name == "intrinsicId" or name not in element.attrib:
                continue
            elif feature["k"] == "r":
                if not (many and "opp" in feature) or name == "predecessors":
                    targets = [self.paths[each] for each in element.get(name).split()]
                    found[name] = sorted(targets) if many else targets[0]
            elif element.get(name) != feature.get("def"):
                convert = _NUMBERS.get(feature["t"].rpartition(".")[2].removeprefix("ecore:"), str)
                found[name] = convert(element.get(name))
        return found

    def sorted(self, name, parts):
        return parts if name in _ORDERED else sorted(parts, key=lambda part: json.dumps(part, sort_keys=True))


class _Lines:
    def __init__(self, text):
        self.data = text.encode()

    def read(self, size=-1):
        data, self.data = self.data, b""
        return data


def facts_of(text):
    """The facts of the model in a text."""
    found = _Facts(text)
    return found.facts(found.model)


def differences(ours, theirs, path=""):
    """What differs between two facts: paths, each with both values."""
    if isinstance(ours, dict) and isinstance(theirs, dict):
        for key in sorted(ours.keys() | theirs.keys()):
            yield from differences(ours.get(key), theirs.get(key), f"{path}/{key}")
    elif isinstance(ours, list) and isinstance(theirs, list) and _is_nameless(ours) and _is_nameless(theirs):
        yield from differences(ours[0], theirs[0], f"{path}[0]")
    elif isinstance(ours, list) and isinstance(theirs, list):
        mine, others = ({_key(each): each for each in each_list} for each_list in (ours, theirs))
        for key in [*mine, *(key for key in others if key not in mine)]:
            yield from differences(mine.get(key), others.get(key), f"{path}[{key}]")
    elif ours != theirs:
        yield path, ours, theirs


def _is_nameless(items):
    """Whether it is one object without a name, of which nothing but its content can differ."""
    return len(items) == 1 and isinstance(items[0], dict) and "name" not in items[0]


def _key(item):
    return item.get("name") or json.dumps(item, sort_keys=True) if isinstance(item, dict) else item
