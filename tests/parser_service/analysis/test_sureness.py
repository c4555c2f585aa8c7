"""How sure answers are, and what is done with them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from parser_service.analysis.sureness import (
    DEFAULT_WEIGHTS,
    FEW,
    LEAST_ACT,
    UNLIKELY,
    WEIGHTS,
    AnsweredForm,
    AnsweringPart,
    Calibration,
    Decision,
    Evidence,
    OperatingPoint,
    calibrations_by_cluster,
    decide,
    in_words,
    operating_point,
)

ORACLE = Evidence(AnsweringPart.ORACLE, is_exact=True)
CALIBRATED = Calibration(examples=40)
LEARNED = Evidence(AnsweringPart.LEARNED, learned_log_probability=float(np.log(0.77)))

counts = st.integers(0, 5)
evidences = st.builds(
    Evidence,
    part=st.sampled_from(list(AnsweringPart)),
    is_exact=st.booleans(),
    heard_cost=st.floats(0, 50),
    readings=st.integers(1, 9),
    learned_log_probability=st.none() | st.floats(-400, 0.001),
    margin=st.none() | st.floats(-1, 60),
    agrees=st.sampled_from([None, True, False]),
    not_said=counts,
    left_out=counts,
    exchanged=st.booleans(),
    executable=st.booleans(),
    unknown_words=counts,
)
examples = st.lists(st.tuples(evidences, st.booleans()), max_size=30)
judged = st.builds(
    lambda *about: drawn(*about),
    st.integers(0, 10_000),
    st.integers(0, 3 * FEW),
    st.sampled_from([0.3, 0.9, 0.97, 1.0]),
)


def drawn(seed, number, good):
    """Answers with a few different probabilities, of which the share ``good`` is right."""
    random = np.random.default_rng(seed)
    return list(
        zip(
            random.choice([0.2, 0.5, 0.7, 0.9, 0.95, 0.98, 0.985, 0.999], number).tolist(),
            (random.random(number) < good).tolist(),
            strict=True,
        )
    )


def logit(probability):
    return np.log(probability / (1 - probability))


def fitted(pairs):
    return Calibration.fit([each for each, _ in pairs], [right for _, right in pairs])


def made_up(number, weights, seed=0):
    """Evidence of all kinds, and whether it is right as ``weights`` say."""
    random = np.random.default_rng(seed)
    made = [
        Evidence(
            part=random.choice([AnsweringPart.ORACLE, AnsweringPart.LEARNED]),
            is_exact=bool(random.random() < 0.5),
            heard_cost=float(random.integers(0, 12)),
            learned_log_probability=float(np.log(random.uniform(0.02, 0.99))),
            margin=float(random.exponential(1.5)),
            agrees=random.choice([None, True, False]),
            not_said=int(random.random() < 0.2),
            left_out=int(random.random() < 0.2),
            exchanged=bool(random.random() < 0.1),
            unknown_words=int(random.random() < 0.2),
        )
        for _ in range(number)
    ]
    truth = Calibration(weights)
    chances = np.array([truth.probability(each) for each in made])
    return made, random.random(number) < chances, chances


def test_the_default_is_near_what_such_answers_were_worth():
    default = Calibration()
    assert default.probability(ORACLE) == pytest.approx(0.98, abs=0.015)
    heard = [
        default.probability(replace(ORACLE, is_exact=False, heard_cost=cost)) for cost in (1, 2, 9)
    ]
    assert heard[0] == pytest.approx(0.93, abs=0.01)
    assert heard == sorted(heard, reverse=True)
    assert 0.5 < default.probability(LEARNED) < 0.77  # shrunk
    assert default.probability(replace(LEARNED, agrees=True)) > default.probability(LEARNED)


@pytest.mark.parametrize(
    "against", [{"not_said": 1}, {"left_out": 1}, {"exchanged": True}, {"unknown_words": 2}]
)
@pytest.mark.parametrize("evidence", [ORACLE, LEARNED], ids=["oracle", "learned"])
def test_what_speaks_against_a_form_costs_two_nats(evidence, against):
    default = Calibration()
    before, after = (
        logit(default.probability(each)) for each in (evidence, replace(evidence, **against))
    )
    assert before - after >= 2 - 1e-9


@given(evidences, examples)
def test_no_evidence_against_an_answer_makes_it_surer(evidence, pairs):
    calibration = fitted(pairs)
    before = calibration.probability(evidence)
    worse = [
        {"heard_cost": evidence.heard_cost + 1},
        {"readings": evidence.readings + 1},
        {"not_said": evidence.not_said + 1},
        {"left_out": evidence.left_out + 1},
        {"unknown_words": evidence.unknown_words + 1},
        {"exchanged": True},
        {"executable": False},
        {"is_exact": False},
        {"agrees": False},
        {"margin": (evidence.margin or 0.0) - 1},
    ]
    if evidence.learned_log_probability is not None:
        worse.append({"learned_log_probability": evidence.learned_log_probability - 1})
    for each in worse:
        assert calibration.probability(replace(evidence, **each)) <= before + 1e-12
    assert calibration.probability(replace(evidence, agrees=True)) >= before - 1e-12
    assert 0 < before < 1


def test_without_an_example_it_is_the_default():
    assert Calibration.fit([], []) == Calibration()
    assert Calibration().weights == DEFAULT_WEIGHTS


@given(examples)
def test_it_is_read_as_it_was_written(pairs):
    calibration = fitted(pairs)
    assert Calibration.read(calibration.to_json()) == calibration
    assert calibration.examples == len(pairs)


def test_a_weight_that_an_older_version_had_not_is_the_default():
    stored = Calibration().to_json()
    del stored["weights"]["unknown_words"]
    assert Calibration.read(stored) == Calibration()


def test_few_examples_hardly_move_it_and_many_win():
    odds = [
        logit(Calibration.fit([ORACLE] * number, [False] * number).probability(ORACLE))
        for number in (0, 1, 200)
    ]
    assert odds[0] - 1.5 < odds[1] < odds[0]
    assert odds[2] < -1


def test_it_recovers_a_simulated_calibration():
    moved = {
        "oracle": 2.0,
        "learned": -1.0,
        "learned_log_odds": 1.1,
        "heard_otherwise": -0.6,
        "not_said": -1.2,
    }
    weights = {**DEFAULT_WEIGHTS, **moved}
    made, right, _ = made_up(6_000, weights)
    calibration = Calibration.fit(made, right.tolist())
    for name in moved:
        assert calibration.weights[name] == pytest.approx(weights[name], abs=0.3), name
    fresh, is_right, chances = made_up(3_000, weights, seed=1)
    said = np.array([calibration.probability(each) for each in fresh])
    assert np.abs(said - chances).mean() < 0.02
    before = np.array([each.raw_probability for each in fresh])
    assert ((said - is_right) ** 2).mean() < ((before - is_right) ** 2).mean()


def test_the_order_of_the_examples_does_not_matter():
    made, right, _ = made_up(200, DEFAULT_WEIGHTS)
    one = Calibration.fit(made, right.tolist())
    other = Calibration.fit(made[::-1], right[::-1].tolist())
    for name in WEIGHTS:
        assert one.weights[name] == pytest.approx(other.weights[name], abs=1e-3)


def test_no_cluster_calibrates_itself():
    """Answers of one cluster are all wrong, which only the others hear of."""
    clusters = [str(number) for number in range(20) for _ in range(10)]
    right = [cluster != "7" for cluster in clusters]
    by_cluster = calibrations_by_cluster([LEARNED] * 200, right, clusters)
    said = {name: each.probability(LEARNED) for name, each in by_cluster.items()}
    assert set(said) == set(clusters)
    assert said["7"] == max(said.values()) > min(said.values())
    assert all(each.examples < 200 for each in by_cluster.values())


def test_a_single_cluster_has_the_default():
    assert calibrations_by_cluster([ORACLE] * 9, [True] * 9, ["one"] * 9) == {"one": Calibration()}
    assert calibrations_by_cluster([], [], []) == {}


@given(judged, st.sampled_from([0.0, 0.02, 0.1, 0.5]))
def test_of_what_is_acted_on_no_more_is_wrong_than_allowed(pairs, allowed):
    from scipy.stats import binom

    given_ = np.array([each for each, _ in pairs])
    right = np.array([each for _, each in pairs], dtype=bool)
    point = operating_point(given_, right, allowed)
    assert LEAST_ACT <= point.act <= 1
    if len(pairs) < FEW:
        assert point.act == max(1 - allowed, LEAST_ACT)
        return
    acted = given_ >= point.act
    wrong = (~right[acted]).sum()
    kept_by_chance = (
        point.act == max(1 - allowed, LEAST_ACT)
        and binom.sf(wrong - 1, acted.sum(), allowed) >= UNLIKELY - 1e-9
    )
    assert wrong <= allowed * acted.sum() or kept_by_chance
    for bound in given_[(given_ < point.act) & (given_ >= LEAST_ACT)]:  # a lower one allows more
        assert (~right[given_ >= bound]).mean() > allowed


def test_a_larger_allowed_share_acts_on_more():
    random = np.random.default_rng(3)
    chances = random.uniform(size=400)
    right = random.uniform(size=400) < chances
    bounds = [operating_point(chances, right, allowed).act for allowed in (0.0, 0.02, 0.1, 0.3)]
    assert bounds == sorted(bounds, reverse=True)
    assert bounds[0] > bounds[-1]


@pytest.mark.parametrize(("surest", "least"), [(0.9, 0.98), (0.99, 0.99)])
def test_where_the_surest_are_wrong_only_what_is_surer_is_acted_on(surest, least):
    point = operating_point([surest] * FEW, [False] * FEW)
    assert point.act == pytest.approx(least)
    assert point.act > surest


def test_one_wrong_answer_of_few_does_not_silence_what_is_sure():
    """All others are far below any bound that is good enough."""
    given_, right = [0.99] * 6 + [0.6] * 60, [False] + [True] * 35 + [False] * 30
    assert operating_point(given_, right).act == pytest.approx(0.98)


POINT = OperatingPoint(0.9, 0.3)
TRUTHS = [False, True]


@pytest.mark.parametrize(
    ("probability", "about", "decision"),
    [
        (0.95, {}, Decision.ACT),
        (0.9, {}, Decision.ACT),
        (0.89, {}, Decision.CONFIRM),
        (0.3, {}, Decision.CONFIRM),
        (0.29, {}, Decision.REFUSE),
        (None, {}, Decision.REFUSE),
        (0.95, {"objections": True}, Decision.REFUSE),
        (0.95, {"open_slots": True}, Decision.ASK),
        (0.95, {"ambiguous": True}, Decision.ASK),
        (0.95, {"executable": False}, Decision.ASK),
        (0.05, {"open_slots": True}, Decision.REFUSE),
        (0.95, {"is_learned": True}, Decision.ACT),
        (0.95, {"is_learned": True, "has_people": False}, Decision.CONFIRM),
        (0.95, {"has_people": False}, Decision.ACT),
    ],
)
def test_decisions(probability, about, decision):
    usual = {"is_learned": False, "has_people": True}
    assert decide(probability, POINT, **{**usual, **about}) == decision


@pytest.mark.parametrize("truths", list(product(TRUTHS, repeat=6)))
def test_what_is_acted_on_is_open_in_nothing(truths):
    names = ("is_learned", "has_people", "open_slots", "executable", "objections", "ambiguous")
    about = dict(zip(names, truths, strict=True))
    if decide(0.99, POINT, **about) == Decision.ACT:
        assert about["executable"]
        assert not (about["open_slots"] or about["objections"] or about["ambiguous"])
        assert about["has_people"] or not about["is_learned"]


def test_an_answer_without_evidence_is_refused():
    assert AnsweredForm().decision(0.99, POINT, CALIBRATED) == Decision.REFUSE
    assert AnsweredForm("UNKNOWN", ORACLE).decision(0.99, POINT, CALIBRATED) == Decision.ACT
    hurt = AnsweredForm("UNKNOWN", replace(ORACLE, executable=False))
    assert hurt.decision(0.99, POINT, CALIBRATED) == Decision.ASK


@pytest.mark.parametrize(
    ("decision", "probability", "words"),
    [
        ("act", 0.98, "sure"),
        ("confirm", 0.772, "77 %: shall I?"),
        ("ask", 0.95, "95 %: one question"),
        ("refuse", 0.03, "unsure: 3 %"),
        ("refuse", 0.95, "refused"),
        ("refuse", None, "not understood"),
    ],
)
def test_sureness_in_words(decision, probability, words):
    assert in_words(decision, probability) == words
