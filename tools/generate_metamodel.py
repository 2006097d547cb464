"""Generate `amalthea_uros/metamodel/classes*.py` from the facts.

Usage: python tools/generate_metamodel.py [TARGET]
"""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from templating import ROOT, templates
from union import Union, UnionClass, constant_case, union

TARGET = ROOT / "amalthea_uros" / "metamodel"
DESCRIPTIONS = ROOT / "tools" / "metamodel_descriptions.txt"


def descriptions() -> dict[str, str]:
    """Our words for classes ("Task") and features ("Task.preemption")."""
    lines = DESCRIPTIONS.read_text(encoding="utf-8").splitlines() if DESCRIPTIONS.exists() else []
    return {name.strip(): text.strip() for name, _, text in (line.partition(":") for line in lines) if text}


def in_base_order(classes: list[UnionClass], merged: Union) -> Iterator[UnionClass]:
    """Classes of one module, each after those of its bases that live in the same module."""
    names = {cls.name for cls in classes}
    done: set[str] = set()

    def visit(cls: UnionClass) -> Iterator[UnionClass]:
        for base in cls.bases:
            if base in names and base not in done:
                yield from visit(merged.classes[base])
        if cls.name not in done:
            done.add(cls.name)
            yield cls

    for cls in classes:
        yield from visit(cls)


def imports(classes: list[UnionClass], merged: Union, bases: bool) -> dict[str, list[str]]:
    """Names needed from other modules: of base classes, or only of types of features."""
    needed = {base for cls in classes for base in cls.bases}
    if not bases:
        types = {t for cls in classes for f in cls.features.values() for t in f.types}
        needed = types - needed
    found: dict[str, list[str]] = {}
    for name in needed:
        module = merged.classes[name].module if name in merged.classes else "enums" if name in merged.enums else None
        if module and module != classes[0].module:
            found.setdefault(module, []).append(name)
    return {module: sorted(names) for module, names in sorted(found.items())}


#: A feature is a line, however long; other lines have this width.
WIDTH = 180


def lines(names: list[str], indent: str = "    ") -> str:
    """Names with commas, as many on a line as there is room for."""
    return textwrap.fill(", ".join(names), WIDTH, initial_indent=indent, subsequent_indent=indent)


def importing(module: str, names: list[str]) -> str:
    """The import of names that are needed for types."""
    start = f"    from amalthea_uros.metamodel.classes_{module} import "
    line = start + ", ".join(names)
    return line if len(line) <= WIDTH else f"{start}(\n{lines(names, ' ' * 8)},\n    )"


def quoted(names: list[str]) -> list[str]:
    """Names as string literals."""
    return [f'"{name}"' for name in names]


def render() -> dict[str, str]:
    """File name -> text of every generated module."""
    merged = union()
    environment = templates()
    environment.filters |= {"constant": constant_case, "lines": lines, "quoted": quoted}
    by_module: dict[str, list[UnionClass]] = {}
    for cls in merged.classes.values():
        by_module.setdefault(cls.module, []).append(cls)
    shared = {
        "merged": merged,
        "described": descriptions(),
        "importing": importing,
        "versions": merged.versions,
        "all_versions": set(merged.versions),
    }
    files = {"classes_enums.py": environment.get_template("metamodel/enums.py.jinja").render(shared)}
    for module, classes in by_module.items():
        quantities = [cls for cls in classes if "Quantity" in cls.bases]
        files[f"classes_{module}.py"] = environment.get_template("metamodel/classes.py.jinja").render(
            shared,
            module=module,
            classes=list(in_base_order(classes, merged)),
            needs_element=bool(quantities) or any(not cls.bases for cls in classes),
            specifiers=sorted({f.specifier for cls in classes for f in cls.features.values()}),
            base_imports=imports(classes, merged, bases=True),
            type_imports=imports(classes, merged, bases=False),
            unit_imports=[f"{cls.name}Unit" for cls in quantities],
        )
    exported = {module: sorted(cls.name for cls in classes) for module, classes in sorted(by_module.items())}
    files["classes.py"] = environment.get_template("metamodel/all_classes.py.jinja").render(
        exported={"enums": sorted(merged.enums), **exported}
    )
    return files


def main(target: Path) -> None:
    target.mkdir(parents=True, exist_ok=True)
    for name, text in render().items():
        (target / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else TARGET)
