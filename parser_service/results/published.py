"""The figures of Walker, Peng and Cakmak (2019), table III: exact match in percent on the test parts."""

from __future__ import annotations

from django.db.models import Count

from annotations.language.corpus import Criterion
from annotations.models import Example, Split

# Parser → for each setting the accuracy by command and by logical form.
PUBLISHED: dict[str, dict[tuple[str, str], tuple[float, float]]] = {
    "grammar-oracle": {
        ("gen", "gen"): (100.0, 100.0),
        ("gen", "para"): (1.1, 0.9),
        ("para", "para"): (1.1, 0.9),
        ("gen+para", "para"): (1.1, 0.9),
    },
    "knn": {
        ("gen", "gen"): (63.0, 0.0),
        ("gen", "para"): (42.0, 0.0),
        ("para", "para"): (42.8, 0.0),
        ("gen+para", "para"): (49.8, 0.0),
    },
    "seq2seq": {
        ("gen", "gen"): (95.9, 0.0),
        ("gen", "para"): (13.0, 0.0),
        ("para", "para"): (64.4, 0.0),
        ("gen+para", "para"): (79.6, 0.0),
    },
    "seq2seq-glove": {
        ("gen", "gen"): (98.8, 26.3),
        ("gen", "para"): (12.4, 0.0),
        ("para", "para"): (70.2, 0.0),
        ("gen+para", "para"): (85.3, 6.3),
    },
    "seq2seq-glove-elmo": {
        ("gen", "gen"): (98.8, 36.2),
        ("gen", "para"): (21.3, 0.0),
        ("para", "para"): (77.3, 22.1),
        ("gen+para", "para"): (85.4, 34.4),
    },
    "seq2seq-glove-gpt": {
        ("gen", "gen"): (97.9, 24.6),
        ("gen", "para"): (27.6, 1.8),
        ("para", "para"): (78.2, 26.3),
        ("gen+para", "para"): (89.0, 37.9),
    },
    "seq2seq-glove-bert-base": {
        ("gen", "gen"): (96.3, 56.9),
        ("gen", "para"): (12.2, 3.3),
        ("para", "para"): (75.4, 31.3),
        ("gen+para", "para"): (87.6, 37.6),
    },
    "seq2seq-glove-bert-large": {
        ("gen", "gen"): (97.9, 54.7),
        ("gen", "para"): (27.1, 9.6),
        ("para", "para"): (78.5, 30.4),
        ("gen+para", "para"): (89.4, 37.6),
    },
}
# Which of a pair of figures belongs to a criterion.
INDEX = {Criterion.COMMAND: 0, Criterion.LOGICAL_FORM: 1}
# Training and validation pairs of the published corpus (docs/reference/formats.md, Pairs): how a
# split is known to be it.
SIZES = {
    Criterion.COMMAND: {
        ("generated", "train"): 847,
        ("generated", "validation"): 121,
        ("paraphrased", "train"): 1265,
        ("paraphrased", "validation"): 181,
    },
    Criterion.LOGICAL_FORM: {
        ("generated", "train"): 850,
        ("generated", "validation"): 129,
        ("paraphrased", "train"): 1244,
        ("paraphrased", "validation"): 211,
    },
}


def published_criteria(splits: list[Split]) -> dict[int, str]:
    """Return key → criterion of the splits that are the published corpus: imported, with its sizes."""
    imported = [split.pk for split in splits if split.seed is None]
    counted = (
        Example.objects.filter(split__in=imported, part__in=["train", "validation"])
        .order_by()
        .values_list("split_id", "source", "part")
        .annotate(Count("pk"))
    )
    sizes: dict[int, dict[tuple[str, str], int]] = {}
    for key, source, part, count in counted:
        sizes.setdefault(key, {})[source, part] = count
    return {
        key: criterion
        for key, counted in sizes.items()
        for criterion, expected in SIZES.items()
        if counted == expected
    }


def published_accuracy(parser: str, setting: tuple[str, str], criterion: str) -> float | None:
    """Return the paper's accuracy in percent, or None where it has none."""
    figures = PUBLISHED.get(parser, {}).get(setting)
    return figures[INDEX[Criterion(criterion)]] if figures and criterion in INDEX else None
