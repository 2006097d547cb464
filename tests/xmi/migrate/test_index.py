"""The index of nodes by tag and type, which is kept up to date from change to change, against one that is made anew."""

from collections import Counter
from unittest.mock import patch

from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.xmi.tree import node as index_module
from amalthea_uros.xmi.tree.node import Node, NodeIndex, remove_all

_TAGS = ("a", "b", "c")
_CHANGES = ("tag", "type", "add", "insert", "take", "set", "remove", "remove all", "wrap", "replace", "nothing")


def trees(draw):
    """Two roots in the index, one outside, and twelve nodes below them."""
    roots = [Node("root", origin=0), Node("root", origin=1), Node("outside", origin=2)]
    nodes = list(roots)
    for origin in range(3, 15):
        made = Node(draw(st.sampled_from(_TAGS)), draw(st.sampled_from(("", "T", "U"))), origin=origin)
        draw(st.sampled_from(nodes)).insert(made)
        nodes.append(made)
    return roots, nodes


def change(draw, nodes):
    """One change at some nodes, of which none gets into itself."""
    kind, node, other = draw(st.sampled_from(_CHANGES)), draw(st.sampled_from(nodes)), draw(st.sampled_from(nodes[3:]))
    is_possible = node not in other.walk()
    match kind:
        case "tag":
            other.tag = draw(st.sampled_from(_TAGS))
        case "type":
            other.type = draw(st.sampled_from(("", "T", "U")))
        case "add":
            nodes.append(node.add(draw(st.sampled_from(_TAGS)), "T"))
        case "insert" if is_possible:
            node.insert(other, draw(st.sampled_from((None, 0))))
        case "take" if is_possible:
            node.take([other, *(child for child in other.children[:1])])
        case "set" if is_possible:
            other.remove()
            node.set_children([other])
        case "remove":
            other.remove()
        case "remove all":
            remove_all([other, *other.children[:2]])
        case "wrap" if other.parent is not None:
            nodes.append(other.wrap("a", "U"))
        case "replace" if other.parent is not None:
            other.replace_by(*other.children[:1])


# Small trees would always be indexed anew.
@patch.object(index_module, "_LARGE_SHARE", 100)
@given(st.data())
def test_it_is_as_if_made_anew(data):
    (first, second, _), nodes = trees(data.draw)
    index = NodeIndex()
    for _ in range(4):
        index.update([first, second])
        present = [*first.walk(), *second.walk()]
        for tag in ("root", *_TAGS):
            assert Counter(index.of_tag(tag)) == Counter(node for node in present if node.tag == tag)
            assert [node.origin for node in index.of_tag(tag)] == sorted(node.origin for node in present if node.tag == tag)
        for name in ("T", "U"):
            assert Counter(index.of_type(name)) == Counter(node for node in present if node.type == name)
        assert Counter(index.all()) == Counter(present)
        for _ in range(data.draw(st.integers(1, 4))):
            change(data.draw, nodes)
