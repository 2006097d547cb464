"""Draw which room of the package imports which: the Mermaid picture in docs/architecture.md.

Imports for type checking only are not counted; those inside functions are. A room that is reached through another one has no arrow
of its own, and the rooms that every room may import are left out.

Usage: python tools/draw_rooms.py [PAGE]
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

import networkx as nx

ROOT = Path(__file__).parent.parent
PACKAGE = "amalthea_uros"
PAGE = ROOT / "docs" / "architecture.md"

#: What every room may import.
BASE = ("_internal", "_version", "diagnostics", "errors", "names", "units")

#: No rooms: the public interface, and the module that starts the command line.
_ENTRANCES = ("__init__", "__main__")


def module_imports(*, for_types: bool = False) -> nx.DiGraph:
    """The modules of the package, each with those that it imports.

    Parameters
    ----------
    for_types : include imports for type checking only
    """
    modules, imports = _imports()
    graph = nx.DiGraph()
    graph.add_nodes_from(modules)
    graph.add_edges_from((module, target) for module, target, is_for_types in imports if for_types or not is_for_types)
    return graph


@cache
def _imports() -> tuple[list[str], list[tuple[str, str, bool]]]:
    """All modules, and each import: by which module, of which one, and whether for type checking only."""
    files = {_module_name(path): path for path in (ROOT / PACKAGE).rglob("*.py")}
    found = ((module, _imported(ast.parse(path.read_text()), files)) for module, path in files.items())
    return list(files), [(module, target, is_for_types) for module, targets in found for target, is_for_types in targets]


def room_imports(*, for_types: bool = False) -> nx.DiGraph:
    """The rooms, each with those that it imports."""
    modules = module_imports(for_types=for_types)
    graph = nx.DiGraph()
    graph.add_nodes_from(room_of(module) for module in modules)
    graph.add_edges_from((room_of(module), room_of(target)) for module, target in modules.edges)
    graph.remove_edges_from([(room, room) for room in graph])
    graph.remove_nodes_from(_ENTRANCES)
    return graph


def room_of(module: str) -> str:
    """The room of a module: `timing` for `amalthea_uros.timing.demand.model`."""
    return [*module.split("."), "__init__"][1]


def circles(graph: nx.DiGraph) -> list[list[str]]:
    """What imports itself through others."""
    return sorted(sorted(found) for found in nx.strongly_connected_components(graph) if len(found) > 1)


def picture() -> str:
    """The rooms as a Mermaid flowchart; an arrow leads from a room to one that it imports."""
    rooms = room_imports()
    rooms.remove_nodes_from(BASE)
    arrows = nx.transitive_reduction(rooms).edges
    return "\n".join(["flowchart TD", *(f"    {room} --> {target}" for room, target in sorted(arrows))])


def _module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _imported(tree: ast.AST, files: Mapping[str, Path], *, for_types: bool = False) -> Iterator[tuple[str, bool]]:
    """The modules of the package that a module imports at any place, and whether for type checking only."""
    for node in ast.iter_child_nodes(tree):
        match node:
            case ast.If(test=ast.Name(id="TYPE_CHECKING")):
                yield from _imported(node, files, for_types=True)
            case ast.Import(names=names):
                yield from ((name.name, for_types) for name in names if name.name in files)
            case ast.ImportFrom(module=str(module), names=names) if module in files:
                found = (f"{module}.{name.name}" for name in names)
                yield from ((name if name in files else module, for_types) for name in found)
            case ast.stmt() | ast.ExceptHandler() | ast.match_case():  # an expression has no import
                yield from _imported(node, files, for_types=for_types)


def main(page: Path) -> None:
    text = re.sub(r"(?s)(?<=```mermaid\n).*?(?=\n```)", picture(), page.read_text(encoding="utf-8"))
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PAGE)
