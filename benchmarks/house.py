"""How the code is cut into files, functions and rooms, for one or more checkouts side by side.

    python -m benchmarks.house            # this checkout
    python -m benchmarks.house OLD NEW    # two checkouts: a table of before and after
    python -m benchmarks.house --packages wagtail -- SITE_PACKAGES    # other code, where it is installed

What is product code counts: Python files of the packages in ``PACKAGES``, without migrations and tests.
Imports are read from the source, nothing is run. An import inside a function, or for a type checker
alone, counts for circles and arrows, and not for what importing a module loads.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from statistics import mean, median, quantiles

PACKAGES = ("annotations", "parser_service", "gpsr_site", "benchmarks", "clients")
SHORT_LINES = 25
# The modules whose imports are the pages, and the routes.
PAGE_ADDRESSES = ("annotations.urls", "parser_service.urls")
ROUTE_ADDRESSES = (
    "annotations.rest_urls",
    "parser_service.rest_urls",
    "annotations.api.urls",  # before the rooms of `web`
    "parser_service.api.urls",
)


@dataclass(frozen=True)
class Module:
    """One file: its dotted name, its source, and the syntax tree of it."""

    name: str
    path: Path
    tree: ast.Module = field(repr=False, compare=False)
    lines: int

    @property
    def package(self) -> str:
        """The package that the module stands in: itself, where it is one."""
        return self.name if self.path.name == "__init__.py" else self.name.rpartition(".")[0]

    @cached_property
    def functions(self) -> list[str]:
        """The names of its functions and methods."""
        kinds = ast.FunctionDef | ast.AsyncFunctionDef
        return [node.name for node in ast.walk(self.tree) if isinstance(node, kinds)]

    @cached_property
    def classes(self) -> list[str]:
        return [node.name for node in self.tree.body if isinstance(node, ast.ClassDef)]

    @cached_property
    def mentions(self) -> Counter[str]:
        """How often each name is used, as a name or behind a dot."""
        names: Counter[str] = Counter()
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Name):
                names[node.id] += 1
            elif isinstance(node, ast.Attribute):
                names[node.attr] += 1
        return names

    @property
    def called_once(self) -> list[str]:
        """Its private functions that one place of the module uses."""
        return [
            name
            for name in self.functions
            if name.startswith("_") and not name.endswith("__") and self.mentions[name] == 1
        ]


def modules_of(root: Path, packages: Sequence[str]) -> dict[str, Module]:
    """Return the product modules of a checkout by dotted name; a package by its own name."""
    modules = {}
    for package in packages:
        for path in sorted((root / package).rglob("*.py")):
            if {"migrations", "tests", "node_modules"} & set(path.relative_to(root).parts):
                continue
            name = ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")
            source = path.read_text(encoding="utf-8")
            modules[name] = Module(name, path, ast.parse(source), source.count("\n"))
    return modules


def imports_in(tree: ast.AST, everywhere: bool) -> Iterator[ast.Import | ast.ImportFrom]:
    """Yield the import statements: all of them, or only those that importing the module runs."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
            continue
        is_function = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        is_for_types = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
        if everywhere or not (is_function or is_for_types):
            yield from imports_in(node, everywhere)


class House:
    """The modules of a checkout, and who imports whom."""

    def __init__(self, root: Path, packages: Sequence[str] = PACKAGES):
        self.modules = modules_of(root, packages)

    def targets(self, node: ast.Import | ast.ImportFrom, by: Module) -> set[str]:
        """Return our modules that a statement in a module names."""
        if isinstance(node, ast.Import):
            names = {alias.name for alias in node.names}
        else:
            above = by.package.split(".")[: 1 - node.level or None] if node.level else []
            source = ".".join((*above, *filter(None, [node.module])))
            names = {f"{source}.{alias.name}" for alias in node.names} | {source}
            inner = {name for name in names if name in self.modules and name != source}
            names = inner if len(inner) == len(node.names) else names
        return {name for name in names if name in self.modules}

    def arrows(self, everywhere: bool) -> dict[str, set[str]]:
        """Return for each module those of ours that it names."""
        return {
            name: {
                other
                for node in imports_in(module.tree, everywhere)
                for other in self.targets(node, module)
                if other != name
            }
            for name, module in self.modules.items()
        }

    @cached_property
    def all_arrows(self) -> dict[str, set[str]]:
        return self.arrows(everywhere=True)

    @cached_property
    def loaded(self) -> dict[str, set[str]]:
        """For each module, what importing it loads at once: the packages on the way included."""
        arrows = self.arrows(everywhere=False)
        return {
            name: {
                step
                for other in others
                for step in packages_on_the_way(other)
                if step in self.modules and step != name and not name.startswith(f"{step}.")
            }
            for name, others in arrows.items()
        }

    def reached(self, name: str) -> set[str]:
        """Return all files that importing a module loads, itself not counted."""
        seen, ahead = {name}, [name]
        while ahead:
            for other in self.loaded[ahead.pop()] - seen:
                seen.add(other)
                ahead.append(other)
        return seen - {name}

    @cached_property
    def circles(self) -> list[list[str]]:
        """Groups of modules of which each imports, by some way, all others."""
        return [group for group in groups_of(self.all_arrows) if len(group) > 1]

    @cached_property
    def longest_chain(self) -> int:
        """The most modules that import one another in a row; a circle counts as one."""
        longest: dict[str, int] = {}
        for group in groups_of(self.loaded):  # what a group imports comes before it
            outside = {other for name in group for other in self.loaded[name]} - set(group)
            length = 1 + max((longest[other] for other in outside), default=0)
            longest.update(dict.fromkeys(group, length))
        return max(longest.values())

    def named_by(self, addresses: tuple[str, ...]) -> set[str]:
        """Return the modules that the addresses of pages or of routes lead to."""
        return {
            other
            for name in addresses
            for other in self.all_arrows.get(name, ())
            if ".rest." not in other
        }

    @cached_property
    def importers(self) -> dict[str, set[str]]:
        importers: dict[str, set[str]] = defaultdict(set)
        for name, others in self.all_arrows.items():
            for other in others:
                importers[other].add(name)
        return importers


def packages_on_the_way(name: str) -> list[str]:
    """Return ``a``, ``a.b`` and ``a.b.c`` for ``a.b.c``: importing the last loads all three."""
    parts = name.split(".")
    return [".".join(parts[:end]) for end in range(1, len(parts) + 1)]


def groups_of(arrows: dict[str, set[str]]) -> list[list[str]]:
    """Return the strongly connected components, each after those that it points to (Tarjan, 1972)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    on_stack: set[str] = set()
    groups: list[list[str]] = []

    def visit(name: str) -> None:
        index[name] = low[name] = len(index)
        stack.append(name)
        on_stack.add(name)
        for other in sorted(arrows[name]):
            if other not in index:
                visit(other)
                low[name] = min(low[name], low[other])
            elif other in on_stack:
                low[name] = min(low[name], index[other])
        if low[name] == index[name]:
            group = stack[stack.index(name) :]
            del stack[stack.index(name) :]
            on_stack.difference_update(group)
            groups.append(group)

    sys.setrecursionlimit(10_000)
    for name in sorted(arrows):
        if name not in index:
            visit(name)
    return groups


def middle(numbers: Iterable[int]) -> str:
    """Return the median; a dash without any number."""
    found = [*numbers]
    return f"{median(found):.0f}" if found else "–"


def repeated(names: list[str]) -> str:
    """Return how many names several have, and how many have one of these."""
    counts = [count for count in Counter(names).values() if count > 1]
    return f"{len(counts)} names, {sum(counts)}"


def figures_of(root: Path, packages: Sequence[str] = PACKAGES) -> dict[str, str]:
    """Return the figures of a checkout by what they count."""
    house = House(root, packages)
    modules = list(house.modules.values())
    lines = [module.lines for module in modules if module.lines]
    functions = sum(len(module.functions) for module in modules)
    once = sum(len(module.called_once) for module in modules)
    pages, routes = house.named_by(PAGE_ADDRESSES), house.named_by(ROUTE_ADDRESSES)
    arrows = {
        (module.package, house.modules[other].package)
        for module in modules
        for other in house.all_arrows[module.name]
        if house.modules[other].package != module.package
    }
    return {
        "files": f"{len(lines):,}",
        "lines": f"{sum(lines):,}",
        "lines of a file: median / 95 % / most": (
            f"{median(lines):.0f} / {quantiles(lines, n=20)[-1]:.0f} / {max(lines)}"
        ),
        "functions": f"{functions:,}",
        "private functions used in one place": f"{once:,} ({once / functions:.1%})",
        "files that importing a page loads (median)": f"{middle(len(house.reached(page)) for page in pages)}",
        "files that importing a route loads (median)": f"{middle(len(house.reached(route)) for route in routes)}",
        "files that importing a file loads (mean)": f"{mean(len(house.reached(name)) for name in house.modules):.0f}",
        "longest chain of imports": str(house.longest_chain),
        "circles of imports": str(len(house.circles)),
        "imports of a page by a route": str(
            sum(len(house.all_arrows[route] & pages) for route in routes)
        ),
        "file names more than once": repeated(
            [module.path.name for module in modules if module.path.name != "__init__.py"]
        ),
        "class names more than once": repeated([name for each in modules for name in each.classes]),
        f"files under {SHORT_LINES} lines with one importer": str(
            sum(
                0 < module.lines < SHORT_LINES and len(house.importers[module.name]) == 1
                for module in modules
                if module.path.name != "__init__.py"
            )
        ),
        "rooms: packages with code": f"{len({module.package for module in modules if module.lines}):,}",
        "arrows between rooms": f"{len(arrows):,}",
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("roots", nargs="*", type=Path, default=[Path.cwd()])
    parser.add_argument("--circles", action="store_true", help="also list the circles of imports")
    parser.add_argument("--packages", nargs="+", default=PACKAGES, help="what is counted")
    chosen = parser.parse_args()
    columns = [figures_of(root, chosen.packages) for root in chosen.roots]
    print("| |" + "".join(f" {root.resolve().name} |" for root in chosen.roots))
    print("| --- |" + " ---: |" * len(columns))
    for what in columns[0]:
        print(f"| {what} |" + "".join(f" {column[what]} |" for column in columns))
    if chosen.circles:
        for root in chosen.roots:
            for circle in House(root, chosen.packages).circles:
                print(f"{root.resolve().name}: {' → '.join(sorted(circle))}")


if __name__ == "__main__":
    main()
