"""The form ranker: chooses the form that an utterance means from many."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from dataclasses import asdict, replace
from http import HTTPStatus
from math import inf, log
from pathlib import Path
from typing import Self

from annotations.language.forms import CLASS_TOKEN
from annotations.language.plans import is_qualified
from annotations.language.texts import Refusal
from parser_service.neural.device import threads
from parser_service.neural.ranker.calibration import TERMS, DecisionRule, Scores
from parser_service.neural.ranker.fitting import Fitting, make_model
from parser_service.neural.ranker.model import RankerModel
from parser_service.neural.ranker.ranked_forms import RankedForms
from parser_service.neural.ranker.steps import FILES
from parser_service.neural.ranker.weighing import weigh_by
from parser_service.neural.sentence_encoder import ENCODER, TOKENIZER, SentenceEncoder
from parser_service.neural.weights import WEIGHTS, load_weights, save_weights
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.hyperparameters.ranker import RankerConfig
from parser_service.parsers.interface import (
    UNKNOWN,
    Candidate,
    Check,
    Knowledge,
    Observer,
    Pair,
    Parser,
    ScoreKind,
    keep_going,
    refuse,
)
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json

FORMS = "forms.json"
SAVED = (FORMS, ENCODER, TOKENIZER, WEIGHTS)
PREDICTION_BATCH = 64
MOST_HEARD = 5  # forms whose slots an utterance may fill in words of its own
NEARLY = 3.0  # nats by which a form may be less probable that leaves nothing out
# Nats by which an utterance that names nothing of the world has to be nearer to what was learned.
UNNAMED = 2.0


class FormRanker(Parser):
    """Chooses from whole forms by one fine-tuned sentence encoder.

    A form with examples is scored by the nearest of them and by its English gloss, a new one by its
    gloss alone; where the ontology is known, slots that no entity of the utterance fills lower the
    score. New forms are made from those of the training pairs (``candidates``) or taken from the
    grammar. Scores are log-probabilities. By how much a new form has to fit better is learned from forms
    that are held out of the first part of the training, never from the validation pairs: those only
    weigh the experts.
    """

    name = "ranker"
    version = 14
    reads = (10, 11, 12, 13)
    protocols = (Protocol.STRICT, Protocol.DOMAIN, Protocol.GRAMMAR)
    score_kind = ScoreKind.LOG_PROBABILITY
    Config = RankerConfig

    def __init__(
        self,
        config: RankerConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        super().__init__(config, seed, knowledge)
        self._decision = DecisionRule()
        self._ranked = RankedForms((), (), 0, (), ())
        self._model: RankerModel | None = None
        self._is_hesitant = False

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
        fitting = Fitting(self.config, self.seed, self.knowledge, validation, observe)
        with threads(self.config.threads):
            fitting.run(
                train,
                check_sealed=lambda folder: open_sealed(folder, type(self), FILES),
                seal=lambda folder: seal(folder, self, FILES),
            )
        self._ranked, self._model = fitting.ranked, fitting.model
        self._decision = fitting.decision
        self._model.encoder.pack()

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return the most probable forms; scores are log-probabilities in nats.

        Their parts are the ``TERMS`` that are not 0; the forms of an utterance that is longer than the
        encoder reads say so. Where the best is below ``unknown_below``, the
        first answer is UNKNOWN, scored with that bound.
        """
        bound = self.config.unknown_below
        least = log(bound) if bound else -inf
        answers: list[list[Candidate]] = []
        for begin in range(0, len(utterances), PREDICTION_BATCH):
            asked = utterances[begin : begin + PREDICTION_BATCH]
            model = self._model_or_refuse()
            scores = model.scores(asked, check)
            members = self._hear(asked, scores, check)
            heard = {number: (asked[number], said.keys()) for number, said in members.items()}
            is_cut = model.encoder.cut(asked)
            number = max(beam_width, MOST_HEARD) if self._is_hesitant else beam_width
            ranked_forms = self._rank(model.rescored(scores, heard), members, number)
            near = scores.nearness.tolist()
            for text, ranked, nearness, is_long in zip(
                asked, ranked_forms, near, is_cut, strict=True
            ):
                if self._is_hesitant and ranked[0].form != UNKNOWN:
                    ranked = self._hesitate(text, ranked, nearness)
                if ranked[0].score < least:
                    ranked = refuse(ranked, least)
                if is_long:
                    ranked = [replace(candidate, is_cut=True) for candidate in ranked]
                answers.append(ranked[:beam_width])
        return answers

    def hesitant(self) -> Self:
        other = copy(self)
        other._is_hesitant = True
        return other

    def calibrated(self, pairs: Sequence[Pair]) -> Self:
        other = copy(self)  # of the same model, which answering does not change
        novelty = self._decision.novelty
        other._decision, _ = weigh_by(
            pairs, novelty, self._ranked, self._model_or_refuse(), keep_going
        )
        return other

    def _hesitate(self, text: str, ranked: list[Candidate], nearness: float) -> list[Candidate]:
        """Return the candidates of an utterance, UNKNOWN first where it is like nothing that was learned, or asks for
        something else or for more than the best of them.

        A form that is nearly as probable comes first where it leaves nothing out.
        """
        slots = self._model_or_refuse().slots
        bound = self._decision.least_nearness
        if slots is not None and not slots.named(text):
            bound += UNNAMED
        if not text.strip() or nearness < bound or is_qualified(text):
            return refuse(ranked, ranked[0].score)
        if slots is None:
            return ranked
        whole = next((each for each in ranked if not slots.asks_for_more(text, each.form)), None)
        if whole is None or whole.score < ranked[0].score - NEARLY:
            return refuse(ranked, ranked[0].score)
        return [whole, *(each for each in ranked if each is not whole)]

    def _hear(
        self, utterances: Sequence[str], scores: Scores, check: Check
    ) -> dict[int, Mapping[str, str]]:
        """Return, by the number of the utterance, the members of closed classes that it names in words of its
        own, where one of the best forms has a slot for one."""
        model = self._model_or_refuse()
        logs = self._decision.log_probabilities(scores)
        logs[:, self._ranked.refused] = -inf
        best = logs.topk(min(MOST_HEARD, logs.shape[1]), dim=-1).indices.tolist()
        heard = {}
        for number, (utterance, forms) in enumerate(zip(utterances, best, strict=True)):
            said = model.hear(utterance, [self._ranked.forms[form] for form in forms], check)
            if said:
                heard[number] = said
        return heard

    def _rank(
        self, scores: Scores, members: Mapping[int, Mapping[str, str]], beam_width: int
    ) -> Iterator[list[Candidate]]:
        """Yield the most probable forms of each utterance; UNKNOWN first where a hesitant parser takes it for
        something else than a command. ``members`` are those of closed classes, by the number of the utterance."""
        logs = self._decision.log_probabilities(scores)
        refused = logs[:, self._ranked.refused].clone()
        logs[:, self._ranked.refused] = -inf
        number = logs.shape[1] - self._ranked.requests
        best = logs.topk(min(beam_width, number), dim=-1)
        terms = self._decision.terms(scores, best.indices).permute(1, 2, 0)
        rows = zip(best.indices.tolist(), best.values.tolist(), terms.tolist(), strict=True)
        for at, ((numbers, probabilities, parts), others) in enumerate(
            zip(rows, refused.tolist(), strict=True)
        ):
            ranked = [
                Candidate(
                    self._ranked.forms[number],
                    score,
                    self._ranked.origin(number),
                    {name: value for name, value in zip(TERMS, part, strict=True) if value},
                    values=values_of(self._ranked.forms[number], members.get(at, {})),
                )
                for number, score, part in zip(numbers, probabilities, parts, strict=True)
            ]
            other = max(others, default=-inf)
            is_other = self._is_hesitant and other > ranked[0].score
            yield refuse(ranked, other) if is_other else ranked

    def save(self, folder: Path) -> None:
        model = self._model_or_refuse()
        folder.mkdir(parents=True, exist_ok=True)
        about = {
            "ranked": self._ranked.to_json(),
            "decision": asdict(self._decision),
            "has_slots": model.slots is not None,
        }
        write_json(folder / FORMS, about)
        model.encoder.describe(folder)
        save_weights(folder / WEIGHTS, model)
        seal(folder, self, SAVED)

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        """Load the parser that ``save`` wrote; under *domain* it finds entities in the current ontology.

        Raises Refusal as every parser does, and where that ontology is not given.
        """
        saved = open_sealed(folder, cls, SAVED)
        parser = cls(saved.config, saved.seed, knowledge)
        about = read_json(folder / FORMS)
        if about["has_slots"] and parser.knowledge.ontology is None:
            raise Refusal(
                f"{folder} holds a parser that knows an ontology. Load it with the ontology of its "
                "world, under the protocol that it was trained with.",
                "ontology_missing",
                HTTPStatus.CONFLICT,
            )
        parser._ranked = RankedForms.read(about["ranked"])
        parser._decision = DecisionRule.read(about["decision"])
        encoder = SentenceEncoder.described_in(folder)
        parser._model = make_model(encoder, parser._ranked, parser.knowledge)
        load_weights(folder / WEIGHTS, parser._model)
        parser._model.eval()
        parser._model.encoder.pack()
        return parser

    def parameters(self) -> int:
        return sum(weights.numel() for weights in self._model.parameters()) if self._model else 0

    def _model_or_refuse(self) -> RankerModel:
        if self._model is None:
            raise ValueError("This parser has learned nothing yet: fit it, or load a fitted one.")
        return self._model


def values_of(form: str, members: Mapping[str, str]) -> tuple[str | None, ...]:
    """Return the entity of each class token of a form, where its class has one slot and ``members`` has its entity;
    none where there is no such token."""
    classes = [name.rstrip("0123456789") for name in CLASS_TOKEN.findall(form)]
    values = tuple(members.get(each) if classes.count(each) == 1 else None for each in classes)
    return values if any(values) else ()
