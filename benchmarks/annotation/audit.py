"""Label audit of the published paraphrases: what it costs, how many labels are in doubt, and the first of them.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.annotation.audit [--folds 5] [--most 50]

Takes the paraphrases that are published with their commands (``paraphrasings.txt``) and the generated commands of
2018. Somebody has to read the list to say how many of these labels are wrong. Last come the labels that say "male"
where the command says "female", or the other way round (docs/reference/formats.md, Pairs).
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from pathlib import Path

from annotations.language.corpus import Suspect
from benchmarks.fresh_site import DATA, WORLD, Site

GENDERS = {"male", "female"}


def show(number: int, suspect: Suspect) -> None:
    scores = ", ".join(f"{each.reason} {each.score:.2f}" for each in suspect.findings)
    print(f"\n{number}. {suspect.pair.utterance}   [{scores}]")
    print(f"   command:   {suspect.pair.source_command}")
    print(f"   label:     {suspect.pair.form}\n   suggested: {suspect.suggested_form}")


def says_the_other_gender(suspect: Suspect) -> bool:
    """Whether the command behind the pair contradicts the gender in the label."""
    from annotations.language.corpus import check_words

    findings = check_words([suspect.pair])
    sentences = [each.sentence for each in findings if "command" in each.sentence]
    return any(f"“{gender}”." in sentence for gender in GENDERS for sentence in sentences)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folds", type=int, default=5)
    parser.add_argument("--most", type=int, default=50, help="labels to print (default: 50)")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.run("generate_pairs", WORLD)
        site.run("import_pairs", str(DATA / "walker2019"), "--world", WORLD, "--name", "walker2019")
        site.enter()
        from annotations.models import World
        from parser_service.labelling.audit_job import audit_labels

        began = time.perf_counter()
        audit = audit_labels(World.objects.get(name=WORLD), folds=args.folds)
        took = time.perf_counter() - began
    reasons = Counter(str(reason) for each in audit.suspects for reason in each.reasons)
    print(f"{len(audit.suspects)} of {audit.pairs} labels are in doubt, found in {took:.1f} s")
    print(", ".join(f"{reason}: {count}" for reason, count in reasons.most_common()))
    for number, suspect in enumerate(audit.suspects[: args.most], start=1):
        show(number, suspect)
    wrong = [at for at, each in enumerate(audit.suspects, 1) if says_the_other_gender(each)]
    print(f"\nThe command says the other gender: {len(wrong)}, at {', '.join(map(str, wrong))}")


if __name__ == "__main__":
    main()
