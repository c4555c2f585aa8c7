"""The figures of Walker, Peng and Cakmak (2019), table III: exact match in percent on the test parts."""

from __future__ import annotations

from django.db.models import Count

from annotations.language.corpus import Criterion
from annotations.models import Example, Split
from parser_service.parsers.registry import parsers

# Parser → for each setting the accuracy by command and by logical form.
PUBLISHED = {name: entry.published for name, entry in parsers().items() if entry.published}
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
