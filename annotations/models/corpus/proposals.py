"""What trained parsers propose. A worker computes it, so that no page loads a parser."""

from __future__ import annotations

from django.db import models

from annotations.models.corpus.utterances import MOST_CHARACTERS, Utterance
from annotations.models.worlds import World


class ProposedForm(models.Model):
    """``source`` is the parser's name and ``run`` the number of its run; ``rank`` counts from 1;
    ``form`` is canonical corpus text; scores compare within one parser only."""

    source = models.CharField(max_length=60)
    run = models.PositiveBigIntegerField()
    rank = models.PositiveSmallIntegerField()
    form = models.TextField()
    score = models.FloatField()

    class Meta:
        abstract = True

    def __str__(self) -> str:
        return self.form


class Proposal(ProposedForm):
    """A form that a trained parser answers to an utterance."""

    utterance = models.ForeignKey(Utterance, on_delete=models.CASCADE, related_name="proposals")

    class Meta:
        ordering = ["utterance", "rank"]
        constraints = [
            models.UniqueConstraint(fields=["utterance", "source", "rank"], name="proposal_rank")
        ]


class CommandProposal(ProposedForm):
    """A form that a trained parser answers to an anonymized command, which has none yet."""

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="command_proposals")
    command = models.CharField(max_length=MOST_CHARACTERS)

    class Meta:
        ordering = ["command", "rank"]
        constraints = [
            models.UniqueConstraint(
                fields=["world", "command", "rank"], name="command_proposal_rank"
            )
        ]
