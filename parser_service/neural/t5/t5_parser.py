"""The encoder–decoder parser: fine-tunes a pretrained network to write forms."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Self

from annotations.language.forms import to_corpus
from annotations.language.texts import Refusal
from parser_service.neural.device import full_fp32, processor, threads
from parser_service.neural.t5.automaton import Automaton
from parser_service.neural.t5.config import EncoderDecoderConfig
from parser_service.neural.t5.decoding import Limits, ScoredForm, Typed, search
from parser_service.neural.t5.fine_tuning import FILES as STATE
from parser_service.neural.t5.fine_tuning import (
    FineTuning,
    TokenizedPair,
    load_training,
    save_training,
    validation_loss,
)
from parser_service.neural.t5.network import FILES, EncoderDecoder
from parser_service.neural.t5.published_weights import load_encoder_decoder
from parser_service.neural.t5.spelling import read, try_to_spell
from parser_service.neural.t5.targets import SHORTEST_ATOM, Targets, Trie
from parser_service.neural.training import random_state_kept, resume
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import (
    Candidate,
    Check,
    EpochReport,
    Knowledge,
    Observer,
    Pair,
    Parser,
    ScoreKind,
    keep_going,
)
from parser_service.parsers.pretrained_files import encoders_folder, refuse_missing_weights
from parser_service.parsers.spreading import spread
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json
from parser_service.parsers.written_forms import canonical_or_same

FORMS = "forms.json"
SAVED = (FORMS, *FILES)
PREDICTION_BATCH = 16
SLACK = 10  # atoms that a freely written form may have more than the longest one seen
VALIDATIONS = 4  # in a training, at most: each decodes forms
MOST_VALIDATED = 300  # pairs


class T5(Parser):
    """Reads an utterance with a pretrained encoder and writes the form, atom by atom, with its decoder.

    The parser keeps the weights of the last step. Candidates are scored by their log-probability
    among all texts, so ``decoding`` decides what may be written but not how it is scored.
    """

    name = "t5"
    version = 1
    protocols = (Protocol.STRICT, Protocol.DOMAIN)
    score_kind = ScoreKind.LOG_PROBABILITY
    Config = EncoderDecoderConfig

    def __init__(
        self,
        config: EncoderDecoderConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        super().__init__(config, seed, knowledge)
        self._network: EncoderDecoder | None = None
        self._targets: Targets | None = None
        self._limits: Automaton | Trie | None = None

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        observe = observe or Observer()
        if not train:
            raise Refusal(
                "There is no training pair, so there is nothing to learn from.", "no_training_pairs"
            )
        refuse_missing_weights(self.config)
        with threads(self.config.threads):
            training = self._prepare(train, observe)
            resume(
                observe,
                check=lambda folder: open_sealed(folder, type(self), (*SAVED, *STATE)),
                load=lambda folder: load_training(folder, training),
                unit="step",
            )
            self._train(training, validation, observe)

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return the most probable forms by beam search; scores are log-probabilities in nats. Their part
        ``tokens`` counts the atoms that were written, ``cut`` the tokens at the end of the utterance
        that were too many to read.

        The beam is as wide as the configuration says, or as ``beam_width`` where that is more.
        """
        network, _ = self._fitted()
        sources = [network.read(utterance) for utterance in utterances]
        order = sorted(range(len(sources)), key=lambda at: len(sources[at].tokens))
        width = max(beam_width, self.config.beam_width)
        answers: list[list[Candidate]] = [[] for _ in utterances]
        with threads(self.config.threads), full_fp32():
            for begin in range(0, len(order), PREDICTION_BATCH):
                check()
                places = order[begin : begin + PREDICTION_BATCH]
                some = [sources[place] for place in places]
                limits: Limits | None = (
                    Typed(self._limits, network)  # a new one, which remembers no other texts
                    if isinstance(self._limits, Automaton)
                    else self._limits
                )
                beams = search(network, some, limits, width, self._most_tokens(), check)
                for place, hypotheses in zip(places, beams, strict=True):
                    candidates = self._candidates(hypotheses, sources[place].cut)
                    answers[place] = candidates[:beam_width]
        return answers

    def save(self, folder: Path) -> None:
        self._write(folder)
        seal(folder, self, SAVED)

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        saved = open_sealed(folder, cls, SAVED)
        parser = cls(saved.config, saved.seed, knowledge)
        parser._set(EncoderDecoder.described_in(folder), Targets.read(read_json(folder / FORMS)))
        return parser

    def parameters(self) -> int:
        return int(self._network.model.num_parameters()) if self._network else 0

    def _set(self, network: EncoderDecoder, targets: Targets) -> None:
        network.move_to(processor())
        self._network, self._targets = network, targets
        self._limits = targets.limits(self.config.decoding, network)

    def _fitted(self) -> tuple[EncoderDecoder, Targets]:
        if self._network is None or self._targets is None:
            raise ValueError("This parser has learned nothing yet: fit it, or load a fitted one.")
        return self._network, self._targets

    def _prepare(self, train: Sequence[Pair], observe: Observer) -> FineTuning:
        """Make the network with a token for each atom, and say what there is to learn from."""
        is_listed = self.config.decoding == "listed"
        targets = Targets.of(train, self.knowledge, is_listed, observe.check)
        with random_state_kept():
            pretrained = load_encoder_decoder(self.config.encoder, encoders_folder())
            network = EncoderDecoder.of(pretrained, targets.atoms())
        self._set(network, targets.fitted_to(network))
        examples = self._examples(train, observe.check)
        for line in self._remarks(examples, len(train)):
            observe.log(line)
        return FineTuning(network, self.config, self.seed, examples)

    def _remarks(self, examples: Sequence[TokenizedPair], pairs: int) -> Iterator[str]:
        """Yield what the log says of the examples that were made of so many training pairs."""
        network, targets = self._fitted()
        yield (
            f"{self.parameters():,} weights; {len(network.atoms)} tokens spell "
            f"{len(targets.origins)} forms, the longest of {targets.longest}."
        )
        if cut := sum(example.source.cut > 0 for example in examples):
            yield f"{cut} of {pairs} utterances are cut after {network.longest} tokens."
        if left_out := pairs - len(examples):
            yield f"{left_out} of {pairs} pairs are left out: their forms cannot be read."
        if isinstance(self._limits, Automaton):
            refused = sum(
                not self._limits.accepts(try_to_spell(text) or ()) for text in targets.origins
            )
            if refused:
                yield (
                    f"{refused} of {len(targets.origins)} forms of the training pairs are never "
                    "answered: the declared signatures do not allow them."
                )

    def _examples(self, pairs: Sequence[Pair], check: Check) -> list[TokenizedPair]:
        """Return the pairs whose forms are spelled with known atoms, in tokens."""
        network, _ = self._fitted()
        tokens = {
            text: network.write(atoms)
            for text in {pair.form for pair in pairs}
            if (atoms := try_to_spell(text)) and network.numbers.keys() >= set(atoms)
        }
        examples = []
        for pair in pairs:
            check()
            if pair.form in tokens:
                examples.append(TokenizedPair(network.read(pair.utterance), tokens[pair.form]))
        return examples

    def _train(self, training: FineTuning, validation: Sequence[Pair], observe: Observer) -> None:
        begin = time.monotonic()
        while not training.is_over():
            training.run_step(observe.check)
            if training.ends_epoch():
                self._report(training, validation, observe, begin)
                begin = time.monotonic()
            if observe.is_checkpoint_due():
                # The newest weights count as the best: the last ones become the parser.
                observe.checkpoint(
                    training.epoch, True, lambda folder: self._checkpoint(folder, training)
                )
            observe.progress(*training.progress())
        if training.step < self.config.steps:
            observe.log(
                f"Training ended after {training.step} of {self.config.steps} steps: it may take "
                f"{self.config.minutes:g} minutes."
            )

    def _report(
        self, training: FineTuning, validation: Sequence[Pair], observe: Observer, begin: float
    ) -> None:
        """Report the epoch since ``begin``, a time of ``time.monotonic``."""
        loss = sum(training.losses) / len(training.losses)
        result: tuple[float | None, float | None] = None, None
        if validation and training.is_due(VALIDATIONS):
            with full_fp32():
                result = self._validate(validation, observe.check)
        observe.epoch(EpochReport(training.epoch, loss, *result, time.monotonic() - begin))

    def _validate(self, validation: Sequence[Pair], check: Check) -> tuple[float | None, float]:
        """Return loss and accuracy on validation pairs; the loss on those whose forms can be spelled."""
        network, _ = self._fitted()
        pairs = spread(validation, MOST_VALIDATED)
        examples = self._examples(pairs, check)
        loss = validation_loss(network, examples, check) if examples else None
        answers = self.predict([pair.utterance for pair in pairs], check=check)
        right = sum(
            bool(candidates) and candidates[0].form == pair.form
            for candidates, pair in zip(answers, pairs, strict=True)
        )
        return loss, right / len(pairs)

    def _most_tokens(self) -> int:
        """Return how many tokens are written at most, the end of the form included."""
        network, targets = self._fitted()
        most = {
            "typed": targets.rules.longest // SHORTEST_ATOM,
            "listed": targets.longest,
            "free": targets.longest + SLACK,
        }
        return min(most[self.config.decoding] + 1, network.most_written)

    def _candidates(self, hypotheses: Sequence[ScoredForm], cut: int) -> list[Candidate]:
        """Return distinct forms, each with the score of its best spelling."""
        network, targets = self._fitted()
        best: dict[str, ScoredForm] = {}
        for hypothesis in hypotheses:
            best.setdefault(_form(network.text(hypothesis.tokens)), hypothesis)
        return [
            Candidate(
                form,
                hypothesis.score,
                targets.origins.get(form, ""),
                {
                    "log_probability": hypothesis.score,
                    "tokens": len(hypothesis.tokens),
                    **({"cut": cut} if cut else {}),
                },
                is_cut=cut > 0,
            )
            for form, hypothesis in best.items()
        ]

    def _write(self, folder: Path) -> None:
        network, targets = self._fitted()
        folder.mkdir(parents=True, exist_ok=True)
        write_json(folder / FORMS, targets.to_json())
        network.save(folder)

    def _checkpoint(self, folder: Path, training: FineTuning) -> None:
        """Write the parser after this step, and the state to resume from."""
        self._write(folder)
        save_training(folder, training)
        seal(folder, self, (*SAVED, *STATE))


def _form(texts: Sequence[str]) -> str:
    """Return the form that is spelled so, in canonical corpus text, or the texts where it is none."""
    try:
        return canonical_or_same(to_corpus(read(texts)))
    except ValueError:
        return " ".join(texts)
