"""How long an annotator waits for the consequences of an edit, and for saving it.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.annotation.consequences [--repeat 30] [--large N]

Makes a fresh SQLite installation with two worlds: the published 2018 generator with its templates (1,211
commands), and the 2019 grammar (14,520 commands) with templates made from its own productions, since none
were published. Prints the median and the 95th percentile of wall time and the median of processor time in
milliseconds, over changes of templates spread over the world, and what a full generation takes. ``cold`` is
the first answer of a process. Then the same of productions changed, and of entities, nonterminals and predicates
renamed.

``--large N`` also generates a world of N commands and says how long a second connection had to wait to write.
"""

from __future__ import annotations

import argparse
import copy
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from benchmarks.fresh_site import DATA, Site

TEMPLATES_2019 = 150


def milliseconds(work: Callable[[], Any]) -> tuple[float, float]:
    """Return the wall time and the processor time that ``work`` takes."""
    began, processor = time.perf_counter(), time.thread_time()
    work()
    return 1000 * (time.perf_counter() - began), 1000 * (time.thread_time() - processor)


def report(name: str, times: list[tuple[float, float]], bound: float | None = None) -> None:
    walls, processor = sorted(wall for wall, _ in times), sorted(each for _, each in times)
    middle, p95 = len(times) // 2, walls[int(0.95 * (len(times) - 1))]
    verdict = (
        "" if bound is None else f"   (bound {bound:g}: {'held' if p95 <= bound else 'MISSED'})"
    )
    print(
        f"{walls[middle]:9.0f} {p95:9.0f} {processor[middle]:9.0f} ms  {name}{verdict}", flush=True
    )


def files_of(folder: str) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (DATA / folder).iterdir() if path.is_file()}


def files_2019() -> dict[str, bytes]:
    """The grammar of 14,520 commands, and templates that cover it between them."""
    files = files_of("generator-2019")
    del files["egpsr.txt"]
    from annotations.language.templates import read_generator_files

    grammar = read_generator_files(files).grammars.grammar("gpsr.txt")
    lines = "".join(f"{line}\n" for line in template_lines(grammar))
    return {**files, "gpsr_semantics.txt": lines.encode()}


def template_lines(grammar: Any) -> Iterator[str]:
    """Open the largest pattern at its first nonterminal or choice, until there are enough."""
    from annotations.language.forms import Choice, Nonterminal, print_sequence

    patterns: dict[Any, int] = {(Nonterminal("Main"),): grammar.size()}
    while len(patterns) < TEMPLATES_2019:
        largest = max(patterns, key=lambda each: patterns[each])
        place = next(
            place for place, each in enumerate(largest) if isinstance(each, Nonterminal | Choice)
        )
        symbol = largest[place]
        is_choice = isinstance(symbol, Choice)
        alternatives = symbol.alternatives if is_choice else grammar.alternatives(symbol.name)
        del patterns[largest]
        for each in alternatives:
            opened = (*largest[:place], *each, *largest[place + 1 :])
            patterns[opened] = grammar.expander.size(opened)
    for number, pattern in enumerate(patterns):
        yield f"{print_sequence(pattern)} = (task{number})"


def make_world(name: str, files: dict[str, bytes]) -> Any:
    from annotations.exchange.generator_import import import_generator
    from annotations.models import World

    World.objects.create(name=name)
    made = import_generator(name, files)
    if made.is_refused:
        sys.exit(str(made.problems))
    return World.objects.get(name=name)


def forget() -> None:
    """What a process that has just started does not have."""
    from annotations.generation import kept_expansions
    from annotations.language.templates import BoundedCache
    from annotations.rows import from_rows

    kept_expansions._EXPANSIONS = BoundedCache(12)
    kept_expansions._GENERATED = BoundedCache(120_000, lambda generated: len(generated.expansions))
    from_rows._GRAMMARS, from_rows._TEMPLATES = BoundedCache(12), BoundedCache(20_000)


def measure(world: Any, user: Any, repeat: int, bound: float) -> None:
    """Measure ``world``, of ``repeat`` templates; ``bound`` in milliseconds is for the consequences."""
    from annotations.models import SemanticTemplate

    measure_generation(world)
    rows = list(SemanticTemplate.objects.filter(grammar__world=world))
    chosen = spread(rows, repeat)
    print(f"{world}: {world.commands.count():,} commands, {len(rows)} templates")
    measure_consequences(world, chosen, bound)
    measure_edits(world, user, chosen)


def measure_generation(world: Any) -> None:
    from annotations.generation.generating import generate_pairs

    report(f"{world}: full generation, first", [milliseconds(lambda: generate_pairs(world))])
    again = [milliseconds(lambda: generate_pairs(world)) for _ in range(3)]
    report(f"{world}: full generation, nothing changed", again)


def measure_consequences(world: Any, chosen: list[Any], bound: float) -> None:
    from annotations.generation.world_consequences import TemplateChange, consequences

    def look(row: Any, number: int) -> None:
        after = copy.copy(row)
        after.form = f"(other{number})"
        trouble = consequences(world, TemplateChange(row, after)).trouble
        if trouble:
            sys.exit(trouble)

    forget()
    report(f"{world}: consequences, cold", [milliseconds(lambda: look(chosen[0], -1))])
    times = [milliseconds(lambda: look(row, n)) for n, row in enumerate(chosen)]  # noqa: B023
    report(f"{world}: consequences", times, bound)


def measure_edits(world: Any, user: Any, chosen: list[Any]) -> None:
    """Measure changing the ``chosen`` templates, and adding and deleting a few."""
    from annotations.editing.edits import add, change, delete
    from annotations.models import SemanticTemplate, TaskCategory

    changed = [
        milliseconds(lambda: change(row, {"form": f"(saved{n})"}, user, row.version))  # noqa: B023
        for n, row in enumerate(chosen)
    ]
    report(f"{world}: save a changed form", changed)
    category = TaskCategory.objects.filter(grammar__world=world).last()
    assert category is not None
    made: list[Any] = []
    added = [
        milliseconds(
            lambda: made.append(
                add(SemanticTemplate.for_category(category, pattern=f"say {n}", form="(say)"), user)  # noqa: B023
            )
        )
        for n in range(5)
    ]
    report(f"{world}: save a new template", added)
    report(
        f"{world}: delete a template",
        [milliseconds(lambda: delete(row, user, row.version)) for row in made],  # noqa: B023
    )


def spread(rows: Any, count: int) -> list[Any]:
    """Return ``count`` of the rows, evenly from the first on; all where there are no more."""
    rows = list(rows)
    return [rows[number * len(rows) // count] for number in range(count)] if rows[count:] else rows


def measure_productions(world: Any, user: Any, repeat: int, bound: float) -> None:
    """What a production would become and change, asked about with another word each time, and saved."""
    from annotations.editing.edits import change
    from annotations.generation.deletion_check import check_deletion
    from annotations.generation.production_check import (
        ProductionEdit,
        check_production,
        consequences_of_production,
    )
    from annotations.models import Production

    rows = spread(Production.objects.filter(grammar__world=world), repeat)

    def edit(row: Any) -> Any:
        expansion = f"{row.expansion} please"
        return ProductionEdit(world, row.source, row.nonterminal, expansion, row)

    for name, look, limit in (
        ("check a production", lambda row: check_production(edit(row)), None),
        ("consequences of a production", lambda row: consequences_of_production(edit(row)), bound),
        ("consequences of deleting one", check_deletion, bound),
        (
            "save a production",
            lambda row: change(row, {"expansion": f"{row.expansion} please"}, user, row.version),
            None,
        ),
    ):
        times = [milliseconds(lambda: look(row)) for row in rows]  # noqa: B023
        report(f"{world}: {name}", times, limit)


def measure_renames(world: Any, user: Any, repeat: int, bound: float) -> None:
    """What another name changes, and changing it."""
    from annotations.editing.world_rename import rename, touched_by
    from annotations.models import Entity, Predicate, Production

    productions = Production.objects.filter(grammar__world=world).exclude(nonterminal="Main")
    first = {row.nonterminal: row for row in reversed(productions)}
    for noun, field, rows in (
        ("an entity", "text", Entity.objects.filter(ontology__world=world)),
        ("a nonterminal", "nonterminal", first.values()),
        ("a predicate", "name", Predicate.objects.filter(world=world)),
    ):
        chosen = [(row, getattr(row, field)) for row in spread(rows, repeat)]
        new = [f"renamed{number}" for number in range(len(chosen))]
        pairs = list(zip(chosen, new, strict=True))
        looked = [milliseconds(lambda: touched_by(row, old, name)) for (row, old), name in pairs]  # noqa: B023
        report(f"{world}: what renaming {noun} changes", looked, bound)
        saved = [
            milliseconds(lambda: rename(row, old, name, user, current_version(row)))  # noqa: B023
            for (row, old), name in pairs
        ]
        report(f"{world}: rename {noun}", saved)


def current_version(row: Any) -> int:
    """Return the version of a row, which another rename may have changed."""
    return int(type(row).objects.values_list("version", flat=True).get(pk=row.pk))


def measure_large(commands: int) -> None:
    """Generate ``commands`` while another connection asks for the write lock again and again."""
    from django.db import connection, transaction

    from annotations.generation.generating import generate_pairs
    from annotations.models import World

    words = " | ".join(f"w{number}" for number in range(78))
    third = max(1, round(commands / 78**2))
    things = " | ".join(f"t{number}" for number in range(third))
    files = {
        "large.txt": f"$Main = do $a $b $c\n$a = {words}\n$b = {words}\n$c = {things}\n".encode(),
        "large_semantics.txt": b"do $a $b $c = (do $a)\n",
    }
    world = make_world("large", files)
    waits, is_done = [0.0], threading.Event()

    def write_again_and_again() -> None:
        while not is_done.is_set():
            began = time.perf_counter()
            try:
                with transaction.atomic():
                    World.objects.filter(pk=world.pk).update(description="x")
            except Exception as error:
                print(f"          another writer failed: {error}")
            waits.append(time.perf_counter() - began)
            time.sleep(0.05)
        connection.close()

    writer = threading.Thread(target=write_again_and_again)
    writer.start()
    took, _ = milliseconds(lambda: generate_pairs(world))
    is_done.set()
    writer.join()
    print(f"{took / 1000:9.1f} s   generation of {world.commands.count():,} commands")
    print(f"{max(waits):9.1f} s   longest wait of another writer")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=30)
    parser.add_argument("--large", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.enter()
        from annotations.models import User

        user = User.objects.create(username="annotator")
        if options.large:
            measure_large(options.large)
            return
        print("   median       p95 processor")
        worlds = (("gpsr2018", files_of("generator-2018"), 300), ("gpsr2019", files_2019(), 1000))
        for name, files, bound in worlds:
            world = make_world(name, files)
            for each in (measure, measure_productions, measure_renames):
                each(world, user, options.repeat, bound)


if __name__ == "__main__":
    main()
