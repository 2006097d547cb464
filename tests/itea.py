"""Models of ITEA versions: every sub-model has a namespace of its own."""

PACKAGES = (
    *("central", "common", "components", "config", "constraints", "events", "hw", "mapping", "os", "propertyconstraints"),
    *("stimuli", "sw"),
)

XMI = 'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'


def model(number, content, root="central:AMALTHEA", attributes=""):
    """The text of a file of a version, such as "1.2.0"."""
    spaces = " ".join(f'xmlns:{package}="http://www.amalthea.itea2.org/model/{number}/{package}"' for package in PACKAGES)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<{root} {XMI} {spaces} {attributes}>{content}</{root}>\n'


def nested(path, attributes=""):
    """Elements inside each other, such as "swModel/runnables/runnableItems sw:Group", the last one with attributes."""
    tags = [part.partition(" ") for part in path.split("/")]
    starts = [f'<{tag} xsi:type="{kind}">' if kind else f"<{tag}>" for tag, _, kind in tags]
    starts[-1] = f"{starts[-1][:-1]} {attributes}>"
    return "".join(starts) + "".join(f"</{tag}>" for tag, _, _ in reversed(tags))


def write(folder, number, **files):
    """Write files (`__` in the names stands for a dot, `_` before the end for a hyphen) and return their paths."""
    paths = []
    for name, text in files.items():
        path = folder / name.replace("__", ".").replace("amxmi_", "amxmi-")
        path.write_text(text if text.startswith("<?xml") else model(number, text))
        paths.append(path)
    return paths


def only(models, *path):
    """The node at a path of tags below the root of the only file."""
    [node] = models.trees[0].root.find(*path)
    return node


def all_of(models, tag):
    """Every node of a tag."""
    return [node for tree in models.trees for node in tree.root.walk() if node.tag == tag]


def messages(notes, kind):
    """The messages of the notes of one kind."""
    return [note.message for note in notes if note.kind == kind]
