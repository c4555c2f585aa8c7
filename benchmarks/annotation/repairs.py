"""How often a repair takes back a mistake in a published template, and what finding repairs costs.

    python -m benchmarks.annotation.repairs FOLDER [--most 12] [--seed 0]

FOLDER holds the files of a generator. Mistakes are those of tests/annotations/language/templates/mistakes.py.
A mistake counts as taken back if the repaired template has the pattern and the canonical form of the
original. ``first``: by the first repair of a problem; ``any``: by one of those offered.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from pathlib import Path
from random import Random

from annotations.language.templates import (
    SemanticTemplate,
    Sides,
    TemplateChecker,
    Usage,
    read_sides,
    usage_of,
    with_repairs,
)
from annotations.language.texts import Repair
from tests.annotations.language.templates.mistakes import mistakes, published_checkers, value_of

COUNTS = ("made", "noticed", "offered", "first", "any")


def try_mistake(
    checker: TemplateChecker,
    template: SemanticTemplate,
    sides: Sides,
    usage: Usage,
) -> tuple[set[str], float] | None:
    """Return which counts a mistake adds to and the seconds that its repairs took; None if it changes nothing.

    ``usage`` is that of the generator without this template.
    """
    wrong, unread = read_sides(sides.pattern, sides.form)
    if wrong is not None and value_of(wrong) == value_of(template):
        return None
    problems = unread if wrong is None else checker.problems(wrong)
    begun = time.perf_counter()
    repaired = with_repairs(problems, sides, checker, lambda: usage)
    seconds = time.perf_counter() - begun
    usual = {problem.message for problem in checker.problems(template)}
    fresh = [problem for problem in repaired if problem.message not in usual]
    offered = [problem.repairs for problem in fresh if problem.repairs]

    def is_right(repair: Repair) -> bool:
        after = sides.after(repair)
        mended, _ = read_sides(after.pattern, after.form)
        return mended is not None and value_of(mended) == value_of(template)

    holds = {
        "made": True,
        "noticed": bool(fresh),
        "offered": bool(offered),
        "first": bool(offered) and is_right(offered[0][0]),
        "any": any(is_right(each) for repairs in offered for each in repairs),
    }
    return {name for name, is_so in holds.items() if is_so}, seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--most", type=int, default=12, help="mistakes in one template")
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    random = Random(chosen.seed)
    counts: dict[str, Counter[str]] = {}
    seconds: list[float] = []
    published = list(published_checkers(chosen.folder))
    for checker, template in published:
        others = [each for _, each in published if each is not template]
        usage = usage_of(others, checker.grammar)
        made = list(mistakes(template))
        for kind, sides in random.sample(made, min(chosen.most, len(made))):
            result = try_mistake(checker, template, sides, usage)
            if result is not None:
                counts.setdefault(kind, Counter()).update(result[0])
                seconds.append(result[1])
    counts["all"] = sum(counts.values(), Counter())
    print(f"{'mistake':32}" + "".join(f"{name:>9}" for name in COUNTS))
    for kind, row in counts.items():
        shares = "".join(f"{row[name] / row['made']:9.1%}" for name in COUNTS[1:])
        print(f"{kind:32}{row['made']:9}{shares}")
    seconds.sort()
    middle, late = seconds[len(seconds) // 2], seconds[int(len(seconds) * 0.95)]
    print(f"repairs of one check: median {middle * 1000:.0f} ms, 95 % within {late * 1000:.0f} ms")


if __name__ == "__main__":
    main()
