"""Words that contributors are asked not to use: those that were used most for a form."""

from __future__ import annotations

from collections import Counter

from annotations.language.texts import COURTESY_WORDS, DETERMINERS, PLACE_PREPOSITIONS, folded_words
from annotations.models import Submission
from annotations.models.campaigns import SubmissionKind

_MOST_READ = 200  # texts of a form
_NEVER = COURTESY_WORDS | DETERMINERS | PLACE_PREPOSITIONS | {"me", "i", "it", "of", "for", "them"}


def taboo_words_for(place: Submission) -> tuple[str, ...]:
    """Return as many words as the campaign asks for, the most used first; none at first.

    Words of entities and words that every sentence has are never among them. A word counts once for each text,
    and from the second text on.
    """
    prompt, campaign = place.prompt, place.contributor.campaign
    if prompt is None or place.kind != SubmissionKind.REWRITE or not campaign.taboo_words:
        return ()
    texts = (
        Submission.objects.answered()
        .filter(
            contributor__campaign=campaign,
            prompt__logical_form=prompt.logical_form,
            kind=SubmissionKind.REWRITE,
        )
        .exclude(contributor=place.contributor_id)
        .order_by("-pk")
        .values_list("text", flat=True)[:_MOST_READ]
    )
    kept = {word for entity in prompt.entities for word in folded_words(entity["text"])}
    counts = Counter(word for text in texts for word in set(folded_words(text)) - kept - _NEVER)
    used = sorted((-count, word) for word, count in counts.items() if count > 1)
    return tuple(word for _, word in used[: campaign.taboo_words])
