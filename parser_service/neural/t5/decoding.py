"""Beam search over the forms that may be written."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import torch
from torch import Tensor

from parser_service.neural.t5.automaton import START, Automaton, UnfinishedForm
from parser_service.neural.t5.network import EncoderDecoder, SourceTokens
from parser_service.parsers.interface import Check

if TYPE_CHECKING:
    pass

SCORED_AT_ONCE = 8  # hypotheses; each token of one has a logit for every word of the vocabulary


class Limits(Protocol):
    """What may be written."""

    def continuations(self, tokens: Sequence[int]) -> list[int]:
        """Return the tokens that may follow ``tokens``; nothing where these may not be written."""


class Typed:
    """The tokens that ``automaton`` allows, the end of a form among them."""

    def __init__(self, automaton: Automaton, network: EncoderDecoder):
        self._automaton = automaton
        self._network = network
        self._states: dict[tuple[int, ...], UnfinishedForm | None] = {(): START}

    def continuations(self, tokens: Sequence[int]) -> list[int]:
        state = self._state(tuple(tokens))
        if state is None:
            return []
        atoms = self._automaton.continuations(state)
        allowed = [self._network.numbers[atom] for atom in atoms]
        return [*allowed, self._network.end] if self._automaton.can_end(state) else allowed

    def _state(self, tokens: tuple[int, ...]) -> UnfinishedForm | None:
        """Return the state after ``tokens``, from that before the last of them."""
        if tokens not in self._states:
            before, [atom] = self._state(tokens[:-1]), self._network.text(tokens[-1:])
            self._states[tokens] = self._automaton.follow(before, atom) if before else None
        return self._states[tokens]


@dataclass(frozen=True, slots=True)
class ScoredForm:
    """A form as it was written: its tokens without the end, and its log-probability."""

    tokens: list[int]
    score: float


def search(
    network: EncoderDecoder,
    sources: Sequence[SourceTokens],
    limits: Limits | None,
    width: int,
    longest: int,
    check: Check,
) -> Iterator[list[ScoredForm]]:
    """Yield for each utterance the most probable of the forms that the search reaches, best first.

    Args:
        limits: what may be written; None for anything.
        width: how many hypotheses are kept, and the most that are returned.
        longest: the most tokens of a form, its end included.
    """
    inputs = network.sources(sources)
    with torch.no_grad():
        states = network.model.get_encoder()(**inputs).last_hidden_state  # [batch, length, width]
        mask = inputs["attention_mask"]  # [batch, length]
        written = _generate(network, states, mask, limits, width, longest, check)
        for row, candidates in enumerate(written):
            targets = [each for each in candidates if each and _is_allowed(each, limits)]
            here = slice(row, row + 1)
            yield _score(network, states[here], mask[here], targets, check)


def _generate(
    network: EncoderDecoder,
    states: Tensor,
    mask: Tensor,
    limits: Limits | None,
    width: int,
    longest: int,
    check: Check,
) -> list[list[list[int]]]:
    """Return the distinct hypotheses of each utterance, with the end where it was written."""
    from transformers import GenerationConfig, StoppingCriteriaList
    from transformers.modeling_outputs import BaseModelOutput

    def allowed(_: int, tokens: Tensor) -> Tensor:
        # A beam that was never possible, because fewer forms than beams begin so, asks as well.
        following = limits.continuations(tokens.cpu().tolist()[1:]) if limits else []
        return torch.tensor(following or [network.end])

    def stop(tokens: Tensor, *_: Any, **__: Any) -> Tensor:
        check()
        return torch.zeros(len(tokens), dtype=torch.bool, device=tokens.device)

    # Published settings (a forced first token, no repeated words) are for other tasks.
    network.model.generation_config = GenerationConfig()  # type: ignore[no-untyped-call]
    rows = network.model.generate(
        encoder_outputs=BaseModelOutput(last_hidden_state=states),
        attention_mask=mask,
        generation_config=GenerationConfig(  # type: ignore[no-untyped-call]
            num_beams=width,
            num_return_sequences=width,
            max_new_tokens=longest,
            length_penalty=0.0,  # by log-probability, whatever the length
            decoder_start_token_id=network.start,
            eos_token_id=network.end,
            pad_token_id=network.padding,
        ),
        stopping_criteria=StoppingCriteriaList([stop]),
        prefix_allowed_tokens_fn=allowed if limits else None,
    )
    texts = [_without_padding(row, network) for row in rows[:, 1:].cpu().tolist()]
    beams = [texts[begin : begin + width] for begin in range(0, len(texts), width)]
    return [[list(each) for each in dict.fromkeys(map(tuple, beam))] for beam in beams]


def _without_padding(tokens: list[int], network: EncoderDecoder) -> list[int]:
    """Return tokens up to and including the first end; padding at the end is left out."""
    if network.end in tokens:
        return tokens[: tokens.index(network.end) + 1]
    while tokens and tokens[-1] == network.padding:
        tokens.pop()
    return tokens


def _is_allowed(tokens: Sequence[int], limits: Limits | None) -> bool:
    """Return whether every token was allowed when it was written: beams that are not full may hold
    others."""
    if not limits:
        return True
    is_ended = not limits.continuations(tokens)
    return is_ended and all(
        token in limits.continuations(tokens[:place]) for place, token in enumerate(tokens)
    )


def _score(
    network: EncoderDecoder,
    states: Tensor,
    mask: Tensor,
    targets: Sequence[list[int]],
    check: Check,
) -> list[ScoredForm]:
    """Return hypotheses with their log-probabilities among all texts, the best first; ``states`` [1, source
    length, width] and ``mask`` [1, source length] are of one utterance."""
    from transformers.modeling_outputs import BaseModelOutput

    hypotheses = []
    for begin in range(0, len(targets), SCORED_AT_ONCE):
        check()
        some = targets[begin : begin + SCORED_AT_ONCE]
        logits, labels = network.logits(
            some,
            encoder_outputs=BaseModelOutput(last_hidden_state=states.expand(len(some), -1, -1)),
            attention_mask=mask.expand(len(some), -1),
        )
        logs = torch.log_softmax(logits.float(), -1)  # [hypotheses, length, vocabulary]
        of_tokens = logs.gather(2, labels.clamp(min=0)[:, :, None])[:, :, 0]
        scores = of_tokens.masked_fill(labels < 0, 0.0).sum(1).cpu().tolist()
        for tokens, score in zip(some, scores, strict=True):
            is_ended = tokens[-1] == network.end
            hypotheses.append(ScoredForm(tokens[:-1] if is_ended else tokens, score))
    return sorted(hypotheses, key=lambda each: -each.score)
