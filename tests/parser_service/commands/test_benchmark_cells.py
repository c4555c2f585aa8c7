"""What a cell of ``manage.py benchmark`` says beside its accuracy, and what is refused."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from django.core.management import CommandError, call_command

from annotations.language.corpus import harmonic_mean
from annotations.language.forms import read_form
from annotations.language.plans import RecipeBook, default_book
from annotations.language.world import Ontology, infer_signatures
from parser_service.analysis.plan_agreement import PlanAgreement
from parser_service.analysis.probabilities import NO_PROBABILITY, probability_of
from parser_service.analysis.scores import Judgement
from parser_service.benchmarking.benchmark_cells import TrialGroup, declared_by
from parser_service.benchmarking.corpus import Corpus
from parser_service.benchmarking.measured_answers import PairAnswer, PartAnswers
from parser_service.benchmarking.trials import TrialColumn, trials
from parser_service.management.options import read_column
from parser_service.parsers.interface import Knowledge, Pair, ScoreKind
from tests.parser_service.made_up import make_folder

RIGHT, WRONG = Judgement(True, True, True), Judgement()


@pytest.fixture
def folder(tmp_path) -> Path:
    made = make_folder(tmp_path / "pairs")
    for name in ("gen", "para"):
        shutil.copytree(made / name, made / f"{name}_logical")
    return made


def run(folder: Path, file: Path, **options) -> list[dict]:
    given = {"parsers": "knn", "criteria": "logical_form", "protocols": "strict", **options}
    call_command("benchmark", str(folder), json=file, **given)
    return json.loads(file.read_text(encoding="utf-8"))


def test_by_form_a_cell_has_three_figures(folder, tmp_path):
    for cell in run(folder, tmp_path / "cells.json", seeds="2"):
        assert cell["n_known"] > 0
        expected = harmonic_mean(cell["accuracy_validation"], cell["accuracy_known"])
        assert cell["harmonic_mean"] == expected
        for figure, ending in (
            (cell["accuracy_validation"], ""),
            (cell["accuracy_known"], "_known"),
            (cell["harmonic_mean"], "_harmonic_mean"),
        ):
            low, high = cell[f"interval{ending}"]
            assert 0 <= low <= figure <= high <= 1
        assert cell["clusters"] == len(cell["outcomes"]["validation"])
        assert cell["clusters_known"] == len(cell["outcomes"]["known"])


def test_known_pairs_are_in_no_training_and_their_forms_are(folder, tmp_path):
    by_form, by_command = (
        {cell["setting"]: cell for cell in run(folder, tmp_path / f"{each}.json", criteria=each)}
        for each in ("logical_form", "command")
    )
    for setting in ("gen-gen", "para-para", "gen+para-mixed"):
        cell = by_form[setting]
        assert cell["n_train"] + cell["n_known"] == by_command[setting]["n_train"]
    assert by_form["gen-para"]["n_known"] == by_form["para-para"]["n_known"]


def test_every_cell_has_an_interval_over_clusters(folder, tmp_path):
    for cell in run(folder, tmp_path / "cells.json", criteria="command"):
        low, high = cell["interval"]
        assert low <= cell["accuracy_validation"] <= high
        tally = cell["outcomes"]["validation"].values()
        assert (cell["clusters"], cell["n_validation"]) == (len(tally), sum(n for _, n in tally))
        assert (
            sum(right for right, _ in tally) == cell["accuracy_validation"] * cell["n_validation"]
        )
        assert "harmonic_mean" not in cell


def test_every_cell_says_how_many_answers_have_the_same_plan(folder, tmp_path):
    for cell in run(folder, tmp_path / "cells.json"):
        for part, ending in (("validation", ""), ("known", "_known")):
            low, high = cell[f"interval_same_plan{ending}"]
            assert cell[f"accuracy_{part}"] <= cell[f"same_plan_{part}"]
            assert low <= cell[f"same_plan_{part}"] <= high
            tally = cell["outcomes_same_plan"][part].values()
            assert sum(right for right, _ in tally) == cell[f"same_plan_{part}"] * cell[f"n_{part}"]
        assert cell["same_plan_test"] is None


def test_other_recipes_are_another_measurement():
    (trial,) = trials(["knn"], [TrialColumn("gen-gen", "command", "strict")], seeds=[0])
    corpus = Corpus("command", {})
    groups = (
        TrialGroup((trial,), corpus, Knowledge(), "", PlanAgreement(Ontology(()), {}, book))
        for book in (default_book(), RecipeBook())
    )
    assert len({group.key(trial) for group in groups}) == 2


def test_a_similarity_is_no_probability_and_says_so(folder, tmp_path):
    (cell,) = run(folder, tmp_path / "cells.json", criteria="command", train_test="gen-gen")
    measured = cell["calibration"]["validation"]
    assert cell["score_kind"] == "similarity"
    assert (measured["expected_calibration_error"], measured["brier_score"]) == (None, None)
    assert measured["note"] == NO_PROBABILITY
    assert measured["coverage"] == sorted(measured["coverage"])
    assert measured["risk"][-1] == pytest.approx(1 - cell["accuracy_validation"])


def test_probabilities_are_measured_and_no_answer_counts_as_sure_to_be_wrong():
    answers = PartAnswers(
        (PairAnswer("a", RIGHT, -0.0), PairAnswer("b", WRONG, -30.0), PairAnswer("b", WRONG, None)),
        seconds=0.003,
        kind=ScoreKind.LOG_PROBABILITY,
    )
    measured = answers.calibration()
    assert (measured["expected_calibration_error"], measured["brier_score"]) == (0, 0)
    assert answers.milliseconds == pytest.approx(1)
    assert sorted(answers.tally().values()) == [[0, 2], [1, 1]]


@pytest.mark.parametrize(
    ("score", "kind", "probability"),
    [
        (0.25, ScoreKind.PROBABILITY, 0.25),
        (1e-9, ScoreKind.LOG_PROBABILITY, 1.0),
        (float("-inf"), ScoreKind.LOG_PROBABILITY, 0.0),
        (0.25, ScoreKind.SIMILARITY, None),
        (0.25, None, None),
    ],
)
def test_what_a_score_says(score, kind, probability):
    assert probability_of(score, kind) == probability


@pytest.mark.parametrize("setting", ["gen-gen", "gen+para-mixed"])
def test_what_the_grammar_gives_is_no_test(setting):
    (trial,) = trials(["ranker"], [TrialColumn(setting, "logical_form", "grammar")], seeds=[0])
    [sentence] = TrialGroup((trial,), None, Knowledge(), "").measure()
    assert sentence.startswith(f"ranker, grammar: {setting} ")


def test_the_oracle_which_learns_nothing_may_be_tested_on_generated_commands():
    (trial,) = trials(["grammar-oracle"], [TrialColumn("gen-gen", "command", "grammar")], seeds=[0])
    trial.require_unseen()


def test_declared_by_training_alone_is_a_training_of_its_own_under_domain():
    texts = ("command:strict", "command:domain", "command:domain:training")
    todo = list(trials(["ranker"], [read_column(f"para-para:{text}") for text in texts], seeds=[0]))
    assert [(trial.protocol, trial.declared) for trial in todo] == [
        ("strict", "all"), ("domain", "all"), ("domain", "training"),
    ]  # fmt: skip
    assert len({trial.training for trial in todo}) == 3


def test_only_what_training_forms_have_is_declared():
    forms = [
        '( go " <room> " )',
        '( go " <room> " " <location> " )',
        "( find ( lambda $1 e ( tall $1 ) ) )",
    ]
    predicates = infer_signatures(map(read_form, forms))
    glossed = {name: replace(each, gloss=f"{name}!") for name, each in predicates.items()}
    declared = declared_by([Pair("go", forms[0])], Knowledge(glossed)).predicates
    assert list(declared) == ["go"]
    assert (len(predicates["go"].signatures), len(declared["go"].signatures)) == (2, 1)
    assert declared["go"].gloss == "go!"


def test_prompts_without_a_command_are_reported(folder, tmp_path, world, capsys):
    lines = (folder / "paraphrasings.txt").read_text().splitlines()
    lines[1] = "juggle the apple"
    (folder / "paraphrasings.txt").write_text("\n".join(lines) + "\n")
    options = {"criteria": "source_command", "world": "home", "train_test": "para-para"}
    run(folder, tmp_path / "cells.json", **options)
    assert "1 of 36 paraphrases " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("column", "code", "named"),
    [
        ("gen-gen:command:domain:some", "unknown_name", "'some'.* all, training"),
        ("gen-gen:command:strict:training", "column_unreadable", "domain"),
        ("gen-gen:command:domain:all:more", "column_unreadable", "TRAIN-TEST:CRITERION:PROTOCOL"),
    ],
)
def test_only_known_ways_to_declare_are_taken(folder, tmp_path, column, code, named):
    with pytest.raises(CommandError, match=named) as refused:
        run(folder, tmp_path / "cells.json", columns=column, criteria=None, protocols=None)
    assert refused.value.__cause__.code == code


def test_new_splits_may_be_those_of_one_criterion_alone():
    columns = [read_column(f"para-para:{each}:strict") for each in ("command", "source_command")]
    todo = trials(["knn"], columns, [0], new_splits=range(14, 16), new_criteria=["source_command"])
    assert [(trial.criterion, trial.split) for trial in todo] == [
        ("command", None), ("source_command", 14), ("source_command", 15),
    ]  # fmt: skip
