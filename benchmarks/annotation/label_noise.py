"""Label noise: identical paraphrases of different source commands, and how often their forms agree.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.annotation.label_noise

Takes the anonymized train and validation paraphrases of the published corpus by command. Of those whose text is
also a paraphrase of another source command, counts how many have the form that most of the others have. No
parser can know the difference: it is the noise of the labels.
"""

from __future__ import annotations

import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

from benchmarks.fresh_site import DATA, WORLD, Site

Said = tuple[str, str]  # source command and form


def paraphrases() -> Iterator[tuple[str, Said]]:
    """The words of each paraphrase with a known source, in class tokens, and what it was said for."""
    from annotations.models import World
    from parser_service.benchmarking.corpus import read_corpus, source_commands
    from parser_service.parsers.words import words
    from parser_service.runs.knowledge import anonymizer_of

    anonymize = anonymizer_of(World.objects.get(name=WORLD))
    sources = source_commands(DATA / "walker2019", anonymize)
    corpus = read_corpus(DATA / "walker2019", "command")
    for part in ("train", "validation"):
        for pair in corpus.pairs(part, ["paraphrased"]):
            if pair.utterance in sources:
                text = " ".join(words(anonymize(pair.utterance)))
                yield text, (sources[pair.utterance], pair.form)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        groups: dict[str, list[Said]] = defaultdict(list)
        for text, said in paraphrases():
            groups[text].append(said)
    verdicts = [
        Counter(other for at, other in group if at != source).most_common(1)[0][0] == form
        for group in groups.values()
        for source, form in group
        if any(at != source for at, _ in group)
    ]
    print(
        f"Of {sum(map(len, groups.values()))} paraphrases {len(verdicts)} are said of another source "
        f"command, too; {sum(verdicts)} of these ({100 * sum(verdicts) / len(verdicts):.0f} %) have the "
        "form that most of the others have."
    )


if __name__ == "__main__":
    main()
