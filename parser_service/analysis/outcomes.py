"""How many answers are right in each cluster, small enough to be kept with a score."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from hashlib import sha256
from statistics import fmean
from typing import Literal, TypeAlias

import numpy as np

from annotations.language.corpus import harmonic_mean
from parser_service.analysis.arrays import Ints
from parser_service.analysis.clustered import Clustered, Interval, Parts, interval_of
from parser_service.analysis.scores import Judged

# Of a part with more clusters, whole clusters are put together at random: groups of clusters are as
# independent as clusters are, and 300 of them say nearly as much.
MOST_CLUSTERS = 300
NAME_DIGITS = 8
Counted: TypeAlias = Literal["exact", "equivalent", "well_formed", "same_plan"]
PLACES: dict[Counted, int] = {"exact": 1, "equivalent": 2, "well_formed": 3, "same_plan": 4}

Outcomes: TypeAlias = dict[str, list[int]]
"""Cluster, as digits of its SHA-256 → number of examples, and how many are exact, equivalent and well-formed; where
plans were compared, also how many have the same plan."""


def name_clusters(clusters: Collection[str]) -> dict[str, str]:
    """Return the name under which each of distinct clusters is counted; of many several share one."""
    digests = {cluster: sha256(cluster.encode()).hexdigest() for cluster in clusters}
    if len(digests) > MOST_CLUSTERS:
        return {each: str(int(digest, 16) % MOST_CLUSTERS) for each, digest in digests.items()}
    return {each: digest[:NAME_DIGITS] for each, digest in digests.items()}


def encode_clusters(clusters: Sequence[str]) -> Ints:
    """Return the place of each cluster among the names under which they are counted, in their order: [clusters]."""
    names = name_clusters(set(clusters))
    places = {name: place for place, name in enumerate(sorted(set(names.values())))}
    return np.array([places[names[each]] for each in clusters], dtype=np.int64)


def outcomes_of(clusters: Sequence[str], judgements: Sequence[Judged]) -> Outcomes:
    """Count the answers to examples, whose clusters are given, by cluster. Shapes: [examples] each."""
    names = name_clusters(set(clusters))
    has_plans = not any(judgement.is_same_plan is None for judgement in judgements)
    outcomes: Outcomes = {}
    for cluster, judgement in zip(clusters, judgements, strict=True):
        counts = outcomes.setdefault(names[cluster], [0] * (5 if has_plans else 4))
        counts[0] += 1
        counts[1] += judgement.is_exact_match
        counts[2] += judgement.is_equivalent
        counts[3] += judgement.is_well_formed
        if has_plans:
            counts[4] += bool(judgement.is_same_plan)
    return dict(sorted(outcomes.items()))


def clustered(
    of: Sequence[Mapping[str, Sequence[int]]], counted: Counted = "exact"
) -> Clustered | None:
    """Return what some trainings got right; None where one of them has no outcomes, or did not count this."""
    at = PLACES[counted]
    if not of or not all(one and len(next(iter(one.values()))) > at for one in of):
        return None
    return Clustered.of([{name: (each[at], each[0]) for name, each in one.items()} for one in of])


def interval_of_outcomes(
    outcomes: Outcomes, counted: Counted = "exact"
) -> tuple[float, float] | None:
    """Return the 95 % interval of the share that is right, fractions of 1; None without outcomes."""
    right = clustered([outcomes], counted)
    parts: Parts | None = (right,) if right is not None else None
    return interval_of(parts) if parts else None


def interval_of_scores(
    parts: Sequence[Sequence[Outcomes]],
    stored: Sequence[Sequence[Interval]],
    counted: Counted = "exact",
) -> tuple[Interval, Parts | None]:
    """Return the 95 % interval of the mean of one part, or of the harmonic mean of two, and what it was taken from.

    Without outcomes by cluster it is the mean, or the harmonic mean, of the intervals that were ``stored``, which
    are also those of single scores. Shapes: [parts, trainings] each.
    """
    sides = [clustered(part, counted) for part in parts]
    together: Parts | None = None if None in sides else tuple(sides)  # type: ignore[assignment]
    if together is not None and (len(parts) > 1 or len(parts[0]) > 1):
        return interval_of(together), together
    lows, highs = ([fmean(ends[at] for ends in part) for part in stored] for at in (0, 1))
    low, high = (harmonic_mean(*each) if len(parts) > 1 else each[0] for each in (lows, highs))
    return (low, high), together
