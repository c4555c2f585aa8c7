"""How often a parser finds three commands in one utterance, in six ways of joining them.

    .venv/bin/python -m benchmarks.parsing.three_commands WORLD COMMANDS [--run ID] [--joins 60] [--show 3]

COMMANDS has a JSON object with "command" on each line, as a competition's folder has them. Three are drawn for each
utterance. They are found where the pieces have the answers that the three have alone. Without --run the grammar
oracle of the world answers.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from random import Random

import django

from annotations.language.texts import Refusal

WAYS = (
    "{0}. {1}. {2}.",
    "{0} and then {1} and then {2}",
    "First {0}, after that {1}, and finally {2}",
    "1. {0} 2. {1} 3. {2}",
    "{0}; {1}; {2}",
    "Your first task is to {0}. When you are done, {1}. Also {2}, please",
)


def join(commands: list[str], way: str) -> str:
    """Return one utterance with ``commands`` in it."""
    inside = [command[:1].lower() + command[1:].rstrip(".?!") for command in commands]
    return way.format(*inside)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("world")
    parser.add_argument("commands", type=Path)
    parser.add_argument("--run", type=int)
    parser.add_argument("--joins", type=int, default=60)
    parser.add_argument("--show", type=int, default=3, help="utterances that are not found")
    given = parser.parse_args()
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "gpsr_site.settings")
    django.setup()
    from annotations.language.corpus import wilson_interval
    from annotations.models import World
    from parser_service.models import TrainingRun
    from parser_service.parsers.interface import UNKNOWN
    from parser_service.parsers.oracle import GrammarOracle
    from parser_service.parsers.several import pieces_of
    from parser_service.serving.loading import load_parser, make_untrained

    world = World.objects.get(name=given.world)
    try:
        asked = (
            load_parser(TrainingRun.objects.get(pk=given.run, world=world))
            if given.run
            else make_untrained("grammar-oracle", world)
        ).hesitant()
    except Refusal as refusal:
        sys.exit(str(refusal))

    oracle = asked if isinstance(asked, GrammarOracle) else None

    def judge(pieces: Sequence[str]) -> list[float | None]:
        answers = asked.predict(pieces, 1)
        return [each[0].score if each and each[0].form != UNKNOWN else None for each in answers]

    lines = given.commands.read_text(encoding="utf-8").splitlines()
    commands = [json.loads(line)["command"] for line in lines]
    random = Random(0)
    found: Counter[str] = Counter()
    shown = 0
    for number in range(given.joins):
        way = WAYS[number % len(WAYS)]
        three = random.sample(commands, 3)
        said = join(three, way)
        pieces = [each.text for each in pieces_of(said, oracle, None if oracle else judge)]
        alone = [each[0].form if each else "" for each in asked.predict(three, 1)]
        cut = [each[0].form if each else "" for each in asked.predict(pieces, 1)]
        found[way] += alone == cut
        if alone != cut and shown < given.show:
            shown += 1
            print(f"  not found: {said}\n    cut into {' | '.join(pieces)}")
    for way in WAYS:
        print(f"{found[way]:3d} of {len(range(WAYS.index(way), given.joins, len(WAYS)))}  {way}")
    low, high = wilson_interval(found.total(), given.joins)
    print(f"{found.total()} of {given.joins} found [{low:.1%}, {high:.1%}]")


if __name__ == "__main__":
    main()
