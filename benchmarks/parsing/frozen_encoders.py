"""What a sentence encoder knows before it is trained: the ranker's scores with frozen vectors, on the published corpus.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.frozen_encoders NAME …

NAME is an encoder as ``find_encoder`` finds it: in GPSR_ENCODERS_DIR, a package, or a folder. Prints, in percent of
the validation paraphrases under *domain*, how often the form with the highest score is right. A score is the sum of
the cosine of the nearest example, of that of the gloss, and −0.2 for each slot too many or too few. By command the
forms of training can be answered; on unseen forms all candidates, by gloss and slots alone.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.fresh_site import DATA, WORLD, Site

if TYPE_CHECKING:
    from torch import Tensor

    from parser_service.benchmarking.corpus import Corpus
    from parser_service.neural.sentence_encoder import SentenceEncoder
    from parser_service.parsers.interface import Knowledge, Pair

SLOT = 0.2  # of a cosine, for each slot that does not match
SOURCES = {"gen": ["generated"], "para": ["paraphrased"], "gen+para": ["generated", "paraphrased"]}


class Vectors:
    """The vectors of texts; each text is encoded once."""

    def __init__(self, encoder: SentenceEncoder) -> None:
        self._encoder = encoder
        self._known: dict[str, Tensor] = {}

    def of(self, texts: Sequence[str]) -> Tensor:
        """Return vectors of length 1 [texts, width]."""
        import torch

        new = [text for text in dict.fromkeys(texts) if text not in self._known]
        self._known |= zip(new, self._encoder.vectors(new), strict=True)
        return torch.stack([self._known[text] for text in texts])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("encoders", nargs="+", metavar="NAME")
    names = parser.parse_args().encoders
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        for name in names:
            for line in lines(name):
                print(line, flush=True)


def lines(name: str) -> Iterator[str]:
    from annotations.models import World
    from parser_service.benchmarking.corpus import read_corpus
    from parser_service.neural.pretrained import load_encoder
    from parser_service.neural.sentence_encoder import SentenceEncoder
    from parser_service.parsers.pretrained_files import encoders_folder
    from parser_service.runs.knowledge import knowledge_of

    began = time.process_time()
    encoder = SentenceEncoder.of(load_encoder(name, encoders_folder())).eval()
    vectors, knowledge = Vectors(encoder), knowledge_of(World.objects.get(name=WORLD), "domain")
    yield f"{name}: {encoder.width} wide"
    corpus = read_corpus(DATA / "walker2019", "command")
    for sources in SOURCES:
        yield f"  by command, {sources} → para: {by_command(corpus, sources, knowledge, vectors)}"
    corpus = read_corpus(DATA / "walker2019", "logical_form").with_known(0)
    yield f"  by form, gen+para → para: {by_form(corpus, knowledge, vectors)}"
    yield f"  {time.process_time() - began:.0f} s of processor time"


def by_command(corpus: Corpus, sources: str, knowledge: Knowledge, vectors: Vectors) -> str:
    """Return the accuracy by nearest examples alone, and with glosses and slots."""
    pairs = corpus.pairs("train", SOURCES[sources])
    asked = corpus.pairs("validation", ["paraphrased"])
    forms, examples, described = scores(pairs, asked, knowledge, vectors, is_open=False)
    right = [each.form for each in asked]
    nearest = share_right(examples, forms, right)
    return f"{nearest:.1f} by example, {share_right(examples + described, forms, right):.1f} by all"


def by_form(corpus: Corpus, knowledge: Knowledge, vectors: Vectors) -> str:
    """Return the accuracy on unseen forms, and on known ones with examples."""
    pairs = corpus.pairs("train", SOURCES["gen+para"])
    figures = []
    for part in ("validation", "known"):
        asked = corpus.pairs(part, ["paraphrased"])
        forms, examples, described = scores(pairs, asked, knowledge, vectors, is_open=True)
        by = described if part == "validation" else examples + described
        figures.append(share_right(by, forms, [each.form for each in asked]))
    return f"unseen {figures[0]:.1f} by gloss, known {figures[1]:.1f} by all"


def scores(
    pairs: Sequence[Pair],
    asked: Sequence[Pair],
    knowledge: Knowledge,
    vectors: Vectors,
    is_open: bool,
) -> tuple[Sequence[str], Tensor, Tensor]:
    """Return the forms, and for each of ``asked`` their scores by example and by gloss and slots [asked, forms]."""
    from parser_service.neural.ranker.ranked_forms import collect
    from parser_service.neural.ranker.slots import SlotTerm

    ranked, examples, _ = collect(pairs, knowledge, is_open)
    texts = [each.utterance for each in asked]
    said = vectors.of(texts)
    near = said @ vectors.of([each.utterance for each in examples]).T  # [asked, examples]
    of_form = near.new_tensor([each.form for each in examples]).long().expand(len(near), -1)
    nearest = near.new_full((len(near), len(ranked.forms)), -1.0)
    nearest = nearest.scatter_reduce(1, of_form, near, "amax")
    assert knowledge.ontology is not None
    slots = SlotTerm(ranked.forms, knowledge.ontology).scores(texts)
    return ranked.forms, nearest, said @ vectors.of(ranked.glosses).T + SLOT * slots


def share_right(scores: Tensor, forms: Sequence[str], right: Sequence[str]) -> float:
    """Return the percentage of rows whose highest score is that of the right form."""
    best = scores.argmax(1).tolist()
    hits: int = sum(forms[at] == form for at, form in zip(best, right, strict=True))
    return 100 * hits / len(right)


if __name__ == "__main__":
    main()
