"""Weighs the experts of a model by pairs that it did not learn from."""

from __future__ import annotations

from collections.abc import Sequence

import torch

from parser_service.neural.ranker.calibration import DecisionRule, weigh
from parser_service.neural.ranker.model import RankerModel
from parser_service.neural.ranker.ranked_forms import RankedForms
from parser_service.parsers.conditions import GENERATED
from parser_service.parsers.interface import Check, Pair
from parser_service.parsers.spreading import spread

MOST_SCORES = 5_000_000  # of validation utterances and forms, to choose weights by
LEAST_VALIDATED = 64

Report = tuple[float | None, float | None]
"""Loss in nats, and accuracy as a fraction of 1; None where nothing was validated."""


def weigh_by(
    validation: Sequence[Pair],
    novelty: float,
    ranked: RankedForms,
    model: RankerModel,
    check: Check,
) -> tuple[DecisionRule, Report]:
    """Return the decision with the weights that ``validation`` tells, and its loss and accuracy there; of very
    many pairs, some of each form tell.

    Generated commands alone tell nothing: nearly all of them are answered right, so glosses would count three times
    as much as examples, and people would be heard worse.
    """
    most = max(LEAST_VALIDATED, MOST_SCORES // len(ranked.forms))
    asked = spread(validation, most, lambda pair: pair.form)
    if not asked:
        return DecisionRule(novelty), (None, None)
    number = {form: at for at, form in enumerate(ranked.forms)}
    targets = torch.tensor([number.get(pair.form, -1) for pair in asked])
    scores = model.scores([pair.utterance for pair in asked], check)
    spoken = torch.tensor([pair.source != GENERATED for pair in asked])
    decision = weigh(novelty, scores, targets, spoken) if spoken.any() else DecisionRule(novelty)
    logs = decision.log_probabilities(scores)
    of_targets = logs[targets >= 0].gather(1, targets[targets >= 0, None])
    loss = -float(of_targets.mean()) if len(of_targets) else None
    return decision, (loss, float((logs.argmax(-1) == targets).float().mean()))
