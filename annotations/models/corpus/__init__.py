"""Commands and their forms, paraphrases, and utterances with the labels and forms that they get."""

from __future__ import annotations

from annotations.models.corpus.commands import Command, LogicalForm
from annotations.models.corpus.paraphrases import (
    Paraphrase,
    ParaphraseStatus,
    paraphrase_status_choices,
)
from annotations.models.corpus.proposals import CommandProposal, Proposal
from annotations.models.corpus.utterances import (
    MOST_CHARACTERS,
    Label,
    Origin,
    Utterance,
    UtteranceQuerySet,
    UtteranceStatus,
    Verdict,
    origin_choices,
    utterance_status_choices,
    verdict_choices,
)

__all__ = [
    "MOST_CHARACTERS",
    "Command",
    "CommandProposal",
    "Label",
    "LogicalForm",
    "Origin",
    "Paraphrase",
    "ParaphraseStatus",
    "Proposal",
    "Utterance",
    "UtteranceQuerySet",
    "UtteranceStatus",
    "Verdict",
    "origin_choices",
    "paraphrase_status_choices",
    "utterance_status_choices",
    "verdict_choices",
]
