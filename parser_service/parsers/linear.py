"""The linear classifier: one logistic regression for each form of the training pairs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from copy import copy
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load_file, save_file
from scipy.sparse import csr_matrix, hstack
from scipy.special import expit

from annotations.language.grounding import Anonymizer
from annotations.language.texts import Refusal
from parser_service.parsers.conditions import GENERATED, Protocol
from parser_service.parsers.hyperparameters.linear import LinearConfig
from parser_service.parsers.interface import (
    TRAINING,
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
from parser_service.parsers.words import words

if TYPE_CHECKING:
    from sklearn.feature_extraction.text import TfidfVectorizer

VOCABULARY, WEIGHTS = "vocabulary.json", "model.safetensors"
# The kinds of features: the analyzer of scikit-learn, and the shortest and longest n-gram.
KINDS = {"words": ("word", (1, 3)), "characters": ("char_wb", (2, 5))}

MOST_PAIRS = 20_000  # that training reads, spread evenly over the forms
# Rivals of a form are the pairs of other forms that are most similar to its own pairs. MOST_RIVALS is shared by
# all forms; each has LEAST_RIVALS even where there are many forms.
MOST_RIVALS, LEAST_RIVALS = 4_000_000, 1_000
MOST_WEIGHTS = 40_000_000  # 160 MB; where there are many forms, rare features are left out
PREDICTION_BATCH = 64


class LinearClassifier(Parser):
    """Chooses among the forms of the training pairs by words and parts of words.

    Features are the TF-IDF of one to three words and of two to five characters. Each form has a logistic
    regression that tells its utterances from all others. The score is the probability that it gives, divided
    by the sum over all forms where that sum is above 1. Where the sum is below 1, the rest is the probability
    that no form fits. Where the ontology is known, an utterance is read with the classes of its entities as
    further words.
    """

    name = "linear"
    version = 1
    protocols = (Protocol.STRICT, Protocol.DOMAIN)
    score_kind = ScoreKind.PROBABILITY
    Config = LinearConfig

    def __init__(
        self,
        config: LinearConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        super().__init__(config, seed, knowledge)
        ontology = self.knowledge.ontology
        self._anonymizer = None if ontology is None else Anonymizer(ontology)
        self._forms: list[str] = []
        self._features: Features | None = None
        self._weights = np.zeros((0, 0), np.float32)  # [features, forms]
        self._bias = np.zeros(0, np.float32)  # [forms]
        self._is_hesitant = False

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        """Learn from ``train``, at most ``MOST_PAIRS`` of them; ``validation`` is not read.

        Raises Refusal where there is no pair, or no utterance has a word, and what ``observe`` raises.
        """
        observe = observe or Observer()
        observe.check()
        if not train:
            raise Refusal(
                "There is no training pair, so there is nothing to learn from.", "no_training_pairs"
            )
        drawn = _draw(train, self.seed)
        if len(drawn) < len(train):
            observe.log(
                f"Reads {len(drawn):,} of {len(train):,} pairs, spread evenly over the forms."
            )
        self._forms = sorted({pair.form for pair in drawn})
        most_features = max(1, MOST_WEIGHTS // len(self._forms))
        texts = [self._read(pair.utterance) for pair in drawn]
        self._features = Features.of(texts, most_features)
        self._learn(self._features.values(texts), [pair.form for pair in drawn], observe)

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return the most probable forms of each utterance. Their part ``alone`` is the score before the division.

        Where the best score is below ``unknown_below``, the first answer is UNKNOWN, scored with that bound.
        Raises Refusal where nothing was learned, and what ``check`` raises.
        """
        if self._features is None:
            raise ValueError("This parser has learned nothing yet: fit it, or load a fitted one.")
        answers = []
        for begin in range(0, len(utterances), PREDICTION_BATCH):
            check()
            texts = [self._read(each) for each in utterances[begin : begin + PREDICTION_BATCH]]
            alone = expit(self._features.values(texts) @ self._weights + self._bias)
            for text, row in zip(texts, alone, strict=True):
                answers.append(self._rank(text, row.astype(float), beam_width))
        return answers

    def hesitant(self) -> Self:
        """Return the parser that says UNKNOWN first where it knows no word of the utterance."""
        other = copy(self)
        other._is_hesitant = True
        return other

    def save(self, folder: Path) -> None:
        features = self._features
        if features is None:
            raise ValueError("This parser has learned nothing yet: there is nothing to save.")
        folder.mkdir(parents=True, exist_ok=True)
        lists = {kind: [*each.get_feature_names_out()] for kind, each in features.of_kind.items()}
        about = {"forms": self._forms, "has_classes": self._anonymizer is not None}
        write_json(folder / VOCABULARY, {**about, **lists})
        idf = {f"idf.{kind}": each.idf_ for kind, each in features.of_kind.items()}
        save_file({"weights": self._weights, "bias": self._bias, **idf}, folder / WEIGHTS)
        seal(folder, self, [VOCABULARY, WEIGHTS])

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        saved = open_sealed(folder, cls, [VOCABULARY, WEIGHTS])
        lists = read_json(folder / VOCABULARY)
        try:
            has_classes = bool(lists["has_classes"])
            parser = cls(saved.config, saved.seed, knowledge if has_classes else None)
            arrays = load_file(folder / WEIGHTS)
            parser._features = Features.read(lists, arrays)
            parser._forms = list(lists["forms"])
            parser._bias = arrays["bias"].reshape(len(parser._forms))
            parser._weights = arrays["weights"].reshape(len(parser._features), len(parser._forms))
        except (SafetensorError, KeyError, TypeError, ValueError):
            raise Refusal(
                f"The files in {folder} do not belong together, or hold something else than a linear "
                "classifier; train it again.",
                "saved_parser_unreadable",
                HTTPStatus.CONFLICT,
            ) from None
        if has_classes and parser._anonymizer is None:
            raise Refusal(
                f"{folder} holds a parser that knows an ontology. Load it with the ontology of its world, "
                "under the protocol that it was trained with.",
                "ontology_missing",
                HTTPStatus.CONFLICT,
            )
        return parser

    def parameters(self) -> int:
        return self._weights.size + self._bias.size

    def _read(self, utterance: str) -> str:
        """Return the words of an utterance with a blank between them, then the classes of its entities."""
        text = " ".join(words(utterance))
        if self._anonymizer is None:
            return text
        spans = self._anonymizer.anonymize(utterance).spans
        return " ".join([text, *sorted(f"<{span.entity_class}>" for span in spans)]).strip()

    def _learn(self, values: csr_matrix, forms: Sequence[str], observe: Observer) -> None:
        """Learn the weights of each form. ``values`` are the features of the pairs [pairs, features]."""
        from sklearn.linear_model import LogisticRegression  # slow to import

        number = {form: at for at, form in enumerate(self._forms)}
        form_of = np.array([number[form] for form in forms])  # [pairs]
        values = values.astype(np.float64)  # what liblinear reads
        self._weights = np.zeros((values.shape[1], len(number)), np.float32)
        self._bias = np.zeros(len(number), np.float32)
        most_rivals = max(LEAST_RIVALS, MOST_RIVALS // len(number))
        for at in range(len(number)):
            observe.check()
            rows = _own_and_rivals(values, form_of == at, most_rivals)
            is_own = form_of[rows] == at
            if is_own.all():  # there is no other form
                self._bias[at] = np.log1p(len(rows))
                continue
            regression = LogisticRegression(
                C=self.config.inverse_regularization,
                solver="liblinear",
                dual=True,
                tol=1e-2,
                max_iter=1000,
                random_state=self.seed,
            ).fit(values[rows] if len(rows) < len(form_of) else values, is_own)
            self._weights[:, at] = regression.coef_[0]
            self._bias[at] = regression.intercept_[0]
            observe.progress((at + 1) / len(number), "learning the forms")

    def _rank(self, text: str, alone: np.ndarray, beam_width: int) -> list[Candidate]:
        """Return the most probable of the forms, whose probabilities are ``alone`` [forms]."""
        probabilities = alone / max(1.0, alone.sum())
        best = np.argsort(-probabilities, kind="stable")[:beam_width]
        ranked = [
            Candidate(
                self._forms[at], float(probabilities[at]), TRAINING, {"alone": float(alone[at])}
            )
            for at in best
        ]
        assert self._features is not None
        known = self._features.of_kind["words"].vocabulary_
        bound = self.config.unknown_below
        if self._is_hesitant and not any(word in known for word in text.split()):
            bound = max(bound, ranked[0].score)
        elif ranked[0].score >= bound:
            return ranked
        return refuse(ranked, bound)[:beam_width]


class Features(NamedTuple):
    """The TF-IDF of the words and of the characters of a text, each of length 1."""

    of_kind: dict[str, TfidfVectorizer]

    @classmethod
    def of(cls, texts: Sequence[str], most: int) -> Self:
        """Return at most ``most`` features, and at least one of each kind: the most frequent of ``texts``."""
        if not any(texts):
            raise Refusal(
                "No training utterance has a word, so there is nothing to learn from.",
                "no_training_pairs",
            )
        features = cls({kind: _vectorizer(kind, max_features=max(1, most // 2)) for kind in KINDS})
        for each in features.of_kind.values():
            each.fit(texts)
        return features

    @classmethod
    def read(cls, lists: dict[str, Any], arrays: dict[str, np.ndarray]) -> Self:
        """Return what was saved. Raises KeyError, TypeError and ValueError where that is something else."""
        features = cls({kind: _vectorizer(kind, vocabulary=lists[kind]) for kind in KINDS})
        for kind, each in features.of_kind.items():
            each.idf_ = arrays[f"idf.{kind}"]
        return features

    def __len__(self) -> int:
        return sum(len(each.vocabulary_) for each in self.of_kind.values())

    def values(self, texts: Sequence[str]) -> csr_matrix:
        """Return the features of each text. Shape [texts, features]."""
        return hstack([each.transform(texts) for each in self.of_kind.values()], format="csr")


def _vectorizer(kind: str, **options: Any) -> TfidfVectorizer:
    from sklearn.feature_extraction.text import TfidfVectorizer  # slow to import

    analyzer, lengths = KINDS[kind]
    return TfidfVectorizer(
        analyzer=analyzer,
        ngram_range=lengths,
        lowercase=False,
        token_pattern=r"\S+" if analyzer == "word" else None,
        sublinear_tf=True,
        dtype=np.float32,
        **options,
    )


def _draw(train: Sequence[Pair], seed: int) -> list[Pair]:
    """Return at most ``MOST_PAIRS`` of the pairs, spread evenly over the forms; paraphrases of a form come
    before its other pairs."""
    if len(train) <= MOST_PAIRS:
        return list(train)
    order = np.random.default_rng(seed).permutation(len(train))
    paraphrases_first = sorted(order, key=lambda at: train[at].source == GENERATED)
    seen: Counter[str] = Counter()
    turns = {}
    for at in paraphrases_first:
        seen[train[at].form] += 1
        turns[at] = seen[train[at].form]
    drawn = sorted(paraphrases_first, key=turns.__getitem__)[:MOST_PAIRS]
    return [train[at] for at in sorted(drawn)]


def _own_and_rivals(values: csr_matrix, is_own: np.ndarray, most_rivals: int) -> np.ndarray:
    """Return the numbers of the rows of a form, and of its at most ``most_rivals`` rivals [rows].

    ``values`` are the features of all pairs [pairs, features], ``is_own`` marks those of the form [pairs]. Rivals
    are the rows of others that are most similar to the mean of its own.
    """
    others = np.flatnonzero(~is_own)
    if len(others) <= most_rivals:
        return np.arange(len(is_own))
    mean = values[is_own].mean(axis=0)  # [1, features]
    similarity = np.asarray(values @ np.asarray(mean).ravel())  # [pairs]
    nearest = np.argpartition(-similarity[others], most_rivals)[:most_rivals]
    return np.sort(np.concatenate([np.flatnonzero(is_own), others[nearest]]))
