"""Beam search over a whole batch of utterances at once."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from parser_service.neural.seq2seq.lstm import Decoder, Encoded
from parser_service.neural.seq2seq.vocabulary import END, PADDING, START, UNKNOWN
from parser_service.parsers.interface import Check, keep_going

IMPOSSIBLE = float("-inf")


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """One decoded form: its token numbers, without START and END, and its log-probability."""

    tokens: list[int]
    score: float


@torch.no_grad()
def search(
    decoder: Decoder, encoded: Encoded, width: int, longest: int, check: Check = keep_going
) -> list[list[Hypothesis]]:
    """Return for each utterance the ``width`` most probable forms that the search reaches, best first.

    A finished hypothesis stays in its beam at its score. Forms are cut at ``longest`` tokens.
    """
    batch = encoded.mask.shape[0]
    repeated = encoded.repeat(width)
    state = decoder.start(repeated)
    device = repeated.states.device
    written = torch.full((batch, width, 1), START, device=device)  # [batch, width, tokens so far]
    scores = torch.full((batch, width), IMPOSSIBLE, device=device)  # [batch, width]
    scores[:, 0] = 0.0  # before the first token all hypotheses are the same: one is enough
    firsts = torch.arange(batch, device=device)[:, None] * width  # [batch, 1], rows of ``repeated``
    for _ in range(longest):
        check()
        logits, state = decoder(written[:, :, -1].reshape(-1, 1), state, repeated)
        scores, origins, tokens = _best(scores, logits.view(batch, width, -1), written)
        state = state.rows((firsts + origins).flatten())
        written = written.gather(1, origins[:, :, None].expand(-1, -1, written.shape[2]))
        written = torch.cat((written, tokens[:, :, None]), dim=2)
        if bool(_is_finished(written).all()):
            break
    written, scores = written.cpu(), scores.cpu()
    return [_hypotheses(written[row], scores[row]) for row in range(batch)]


def _best(scores: Tensor, logits: Tensor, written: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    """Return the best continuations of all hypotheses of each beam: their scores, the hypotheses they
    continue and the tokens they add, each [batch, width]."""
    batch, width, words = logits.shape
    steps = torch.log_softmax(logits, dim=-1)  # [batch, width, words]
    steps[:, :, [PADDING, UNKNOWN, START]] = IMPOSSIBLE
    only_padding = steps.new_full((words,), IMPOSSIBLE)  # [words]
    only_padding[PADDING] = 0.0
    steps = torch.where(_is_finished(written)[:, :, None], only_padding, steps)
    totals = (scores[:, :, None] + steps).view(batch, width * words)
    best, places = totals.topk(width, dim=1)  # [batch, width]
    return best, places // words, places % words


def _is_finished(written: Tensor) -> Tensor:
    """Return a mask [batch, width], true where the last token ends a form or pads one that has ended."""
    last = written[:, :, -1]  # [batch, width]
    return (last == END) | (last == PADDING)


def _hypotheses(written: Tensor, scores: Tensor) -> list[Hypothesis]:
    """Return the possible hypotheses of a beam: ``written`` [width, tokens], ``scores`` [width]."""
    hypotheses = []
    for row, score in zip(written[:, 1:].tolist(), scores.tolist(), strict=True):
        if score > IMPOSSIBLE:
            end = next((at for at, token in enumerate(row) if token == END), len(row))
            hypotheses.append(Hypothesis(row[:end], score))
    return hypotheses
