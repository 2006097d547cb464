"""Models of any version as text that says what they mean: without order where it means nothing, with references as paths to targets."""

from collections import Counter

from amalthea_uros.xmi.emf.files import read_text
from amalthea_uros.xmi.migrate.chain import migrate
from amalthea_uros.xmi.tree.link import read_set
from amalthea_uros.xmi.tree.notes import StepNotes

MAX_SIZE = 100_000_000

_SPACES = (
    'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xmlns:am="http://app4mc.eclipse.org/amalthea/{}"'
)


def model(version, content, root="Amalthea"):
    """The text of a file of APP4MC; `xsi:type` may be written as `t`, without prefix."""
    typed = content.replace(' t="', ' xsi:type="am:')
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<am:{root} {_SPACES.format(version)}>{typed}</am:{root}>\n'


def opened(*paths):
    """The linked nodes of some files."""
    return read_set([(path, read_text(path)) for path in paths], MAX_SIZE, StepNotes())


def migrated(paths, target):
    """The nodes of some files after migration, and the notes of it."""
    notes = StepNotes()
    models = read_set([(path, read_text(path)) for path in paths], MAX_SIZE, notes)
    migrate(models, target, notes)
    return models, notes.all


def meaning(models):
    """The whole set as lines."""
    places = {}
    for tree in models.trees:
        number_places(tree.root, file_name(tree) if len(models.trees) > 1 else "", places)
    lines = []
    for tree in sorted(models.trees, key=lambda tree: tree.path.name):
        lines += [f"== {tree.version}", *described(tree.root, "", places)]
    return lines


def file_name(tree):
    """The name of a file without what it gets when a sub-model of an ITEA version is written in a later one."""
    name = tree.path.name
    return name.removesuffix(".amxmi") if ".amxmi-" in name else name


def number_places(node, path, places):
    places[node] = path
    count = Counter()
    for child in node.children:
        number_places(child, f"{path}/{child.tag}.{count[child.tag]}", places)
        count[child.tag] += 1


def described(node, indent, places):
    """A node and everything in it. Parts of different tags have no order, those of one tag do."""
    texts = [f"{key}={text!r}" for key, text in sorted(node.attributes.items())]
    for name, targets in sorted(node.references.items()):
        texts.append(f"{name} -> " + " ".join(place_of(target, places) for target in targets))
    yield " ".join([indent + node.tag, f"[{node.type}]" if node.type else "", *texts]).rstrip()
    for child in sorted(node.children, key=lambda child: child.tag):
        yield from described(child, indent + "  ", places)


def place_of(target, places):
    if target.is_proxy:
        return f"?{target.attributes['path']}:{target.target_class}"
    return places.get(target, "LOST " + repr(target))
