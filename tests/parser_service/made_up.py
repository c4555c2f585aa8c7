"""A small made-up split, as rows and as files, and the parser that learns it in seconds."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path

from annotations.generation.split_statistics import store_figures
from annotations.language.corpus import by_length, write_pairs
from annotations.models import Example, Split, World

# A network that learns the made-up pairs in seconds, and one that is not done before it is stopped.
TINY = {"embedding_size": 8, "hidden_size": 16, "minimum_count": 1, "threads": 1, "batch_size": 4}
LONG = {**TINY, "epochs": 5000, "patience": 5000}

VERBS = {"bring me": "bring", "find": "find", "go get": "bring", "look for": "find"}
PLACES = {
    "": "",
    " in the <room>": ' ( at $1 " <room> " )',
    " near the <location>": ' ( at $1 " <location> " )',
}
THINGS = {"the <object>": "<object>", "a <category>": "<category>", "my <object>": "<object>"}
SAYINGS = {
    "bring me": "please fetch",
    "find": "where is",
    "go get": "i would like",
    "look for": "search for",
}


def made_up_pairs() -> Iterator[tuple[str, str, str]]:
    """Generated command, paraphrase, and the form of both."""
    for (verb, head), (thing, kind), (place, where) in product(
        VERBS.items(), THINGS.items(), PLACES.items()
    ):
        form = f'( {head} ( lambda $1 e ( is_a $1 " {kind} " ){where} ) )'
        yield f"{verb} {thing}{place}", f"{SAYINGS[verb]} {thing}{place} now", form


def make_split(world: World, name: str = "home") -> Split:
    """36 generated pairs and 36 paraphrased ones: of every six, four to train, one of each other part."""
    split = Split.objects.create(
        world=world, name=name, criterion="command", content_hash=f"{name:0>64}"
    )
    parts = ("train", "train", "validation", "train", "test", "train")
    Example.objects.bulk_create(
        Example(
            split=split,
            position=position,
            part=parts[position % len(parts)],
            source=source,
            utterance=text,
            logical_form=form,
        )
        for position, (command, utterance, form) in enumerate(made_up_pairs())
        for source, text in (("generated", command), ("paraphrased", utterance))
    )
    store_figures(split)
    return split


def make_folder(folder: Path) -> Path:
    """Pair files by command with train and validation parts, and where the paraphrases come from."""
    for name, place in (("gen", 0), ("para", 1)):
        rows = {"train.txt": [], "val.txt": []}
        for number, made in enumerate(made_up_pairs()):
            rows["val.txt" if number % 4 == 3 else "train.txt"].append((made[place], made[2]))
        for file, pairs in rows.items():
            path = folder / name / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("".join(write_pairs(by_length(pairs))), encoding="utf-8")
    triples = [f"{said}\n{command}\n{form}\n" for command, said, form in made_up_pairs()]
    (folder / "paraphrasings.txt").write_text("".join(triples), encoding="utf-8")
    return folder
