"""How long the questions to a language model are, and how often the right form is among those it may choose from.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.language_model [--criterion command]

Nothing is asked: no server is needed. Examples are the generated and paraphrased training pairs of the
published corpus, questions are about its validation paraphrases.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.fresh_site import DATA, WORLD, Site

if TYPE_CHECKING:
    from parser_service.parsers.interface import Knowledge, Pair
    from parser_service.parsers.model_server.protocol import Question

SOURCES = ("generated", "paraphrased")
FORMS = (6, 12, 24, 48)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--criterion", choices=["command", "logical_form"], default="command")
    criterion = parser.parse_args().criterion
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        print(*lengths(criterion), *coverage(criterion), sep="\n")


def lengths(criterion: str) -> Iterator[str]:
    from annotations.models import World
    from parser_service.parsers.llm.config import FREE, LISTED
    from parser_service.runs.knowledge import knowledge_of

    for protocol in ("strict", "domain"):
        knowledge = knowledge_of(World.objects.get(name=WORLD), protocol)
        for decoding in (LISTED, FREE):
            began = time.perf_counter()
            _, questions = ask_nobody(criterion, knowledge, decoding=decoding)
            spent = 1000 * (time.perf_counter() - began) / len(questions)
            sizes = [sum(len(each["content"]) for each in asked.messages) for asked in questions]
            mean = sum(sizes) / len(sizes)
            yield (
                f"{protocol}, {decoding}: {mean:,.0f} characters a question, at most {max(sizes):,}; "
                f"{spent:.1f} ms to write one"
            )


def coverage(criterion: str) -> Iterator[str]:
    from parser_service.parsers.interface import Knowledge

    for number in FORMS:
        pairs, questions = ask_nobody(criterion, Knowledge(), forms=number)
        listed = [(asked.schema or {})["properties"]["form"]["enum"] for asked in questions]
        right = sum(pair.form in forms for pair, forms in zip(pairs, listed, strict=True))
        yield f"{number} forms: the right one is among them for {100 * right / len(pairs):.1f} %"


def ask_nobody(
    criterion: str, knowledge: Knowledge, **config: Any
) -> tuple[list[Pair], list[Question]]:
    """Return the validation paraphrases, and the question about each."""
    from parser_service.benchmarking.corpus import read_corpus
    from parser_service.parsers.llm.config import LanguageModelConfig
    from parser_service.parsers.llm.language_model import LanguageModel

    corpus = read_corpus(DATA / "walker2019", criterion)
    model = LanguageModel(LanguageModelConfig(model="any", **config), 0, knowledge)
    model.keep([(pair.utterance, pair.form) for pair in corpus.pairs("train", SOURCES)])
    pairs = corpus.pairs("validation", ["paraphrased"])
    return pairs, model.questions([pair.utterance for pair in pairs])


if __name__ == "__main__":
    main()
