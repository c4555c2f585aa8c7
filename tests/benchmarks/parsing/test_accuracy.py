"""benchmarks/parsing/accuracy.py: the paper's table from cells."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from benchmarks.parsing.accuracy import main, read_figures, tables
from parser_service.parsers.registry import entry


def outcomes(right: int, clusters: int = 40, size: int = 5) -> dict[str, list[int]]:
    """So many of the clusters are right as a whole."""
    return {f"{n:04}": [size * (n < right), size] for n in range(clusters)}


def cell(parser="knn", accuracy=0.5, **changes):
    made = {
        "key": str(changes),
        "parser": parser,
        "configuration": {"neighbours": 1},
        "setting": "para-para",
        "criterion": "command",
        "protocol": "strict",
        "seed": 0,
        "n_validation": 181,
        "n_test": 0,
        "accuracy_validation": accuracy,
        "accuracy_test": None,
    }
    return {**made, **changes}


@pytest.fixture
def printed(tmp_path, capsys):
    def print_table(cells, *options):
        file = tmp_path / "cells.json"
        file.write_text(json.dumps(cells))
        main([str(file), *options])
        return capsys.readouterr().out

    return print_table


def test_seeds_become_a_mean_with_its_interval_and_their_spread_stands_apart(printed):
    cells = [
        cell("seq2seq", right / 40, seed=seed, outcomes={"validation": outcomes(right)})
        for seed, right in enumerate((28, 32, 36))
    ]
    lines = printed(cells).splitlines()
    assert "| parser | para-para command |" in lines
    [line] = [each for each in lines if each.startswith("| `seq2seq` | 80.0 ± ")]
    reach = float(line.split("± ")[1].split(" ")[0])
    assert 10 < reach < 22
    assert line.endswith("(64.4) |")
    assert (
        lines[lines.index("Standard deviations between trainings:") + 4] == "| `seq2seq` | 10.0 |"
    )


def test_one_seed_has_an_interval_and_no_spread(printed):
    text = printed([cell(outcomes={"validation": outcomes(20)})])
    assert "| `knn` | 50.0 ± 15." in text
    assert "Standard deviations" not in text


def test_answers_with_the_same_plan_stand_in_a_table_of_their_own(printed):
    right = {"validation": outcomes(20)}
    by_plan = {"same_plan_validation": 0.75, "outcomes_same_plan": {"validation": outcomes(30)}}
    exact, _, plans = printed([cell(outcomes=right, **by_plan)]).partition(", same plan")
    assert "| `knn` | 50.0 ± " in exact and "(42.8)" in exact
    assert "| `knn` | 75.0 ± " in plans and "(42.8)" not in plans
    not_compared = {"same_plan_validation": None, "outcomes_same_plan": right}
    assert "same plan" not in printed([cell(outcomes=right, **not_compared)])


def test_a_cell_from_before_outcomes_has_no_interval_and_says_so(printed):
    text = printed([cell()])
    assert "| `knn` | 50.0 (42.8) |" in text
    assert "Figures without ± were measured before" in text


@pytest.mark.parametrize(("better", "is_bold"), [(26, False), (38, True)])
def test_bold_is_what_is_better_beyond_chance(printed, better, is_bold):
    cells = [
        cell(outcomes={"validation": outcomes(24)}, accuracy=0.6),
        cell("seq2seq", better / 40, outcomes={"validation": outcomes(better)}),
    ]
    assert (f"**{100 * better / 40:.1f}**" in printed(cells)) == is_bold


def test_with_more_rows_a_difference_has_to_be_clearer(printed):
    """Seven clusters are enough (p = 1/64) against one other row, and not against five."""
    better = cell("seq2seq", 0.8, outcomes={"validation": outcomes(32)})
    others = [
        cell(name, 0.625, outcomes={"validation": outcomes(25)})
        for name in ("knn", "ranker", "seq2seq-minilm", "seq2seq-glove", "seq2seq-glove-elmo")
    ]
    assert "**80.0**" in printed([better, others[0]])
    assert "**80.0**" not in printed([better, *others])


def test_four_clusters_are_no_evidence_however_many_examples_they_have(printed):
    cells = [
        cell("seq2seq", 0.725, outcomes={"validation": outcomes(29, size=500)}),
        cell(accuracy=0.625, outcomes={"validation": outcomes(25, size=500)}),
    ]
    assert "**72.5**" not in printed(cells)


def test_by_form_the_three_figures_stand_together(printed):
    of_form = {"validation": outcomes(16), "known": outcomes(32)}
    changes = {"criterion": "logical_form", "accuracy_known": 0.8, "n_known": 200}
    lines = printed([cell("ranker", 0.4, outcomes=of_form, **changes)]).splitlines()
    heads = ("form, harmonic mean", "form, unseen", "form, known")
    assert "| parser | " + " | ".join(f"para-para {head}" for head in heads) + " |" in lines
    [line] = [each for each in lines if each.startswith("| `ranker` |")]
    figures = [each.split(" ± ")[0].strip() for each in line.split("|")[2:5]]
    assert figures == ["53.3", "40.0", "80.0"]


def test_new_splits_are_a_row_in_the_table_of_the_published_one(printed):
    made = {"outcomes": {"validation": outcomes(20)}}
    text = printed([cell(**made), *(cell(split=split, **made) for split in (14, 15))])
    assert "| `knn` | 50.0 ± " in text
    assert "| `knn, new splits` | 50.0 ± " in text
    assert "over 1 seed, 2 new splits by command;" in text


def test_cells_of_another_version_are_left_out_and_counted(printed):
    version = entry("knn").version
    text = printed([cell(version=version), cell(accuracy=0.9, seed=1, version=version + 1)])
    assert "| `knn` | 50.0" in text
    assert "1 cells of other versions of these parsers are left out." in text


def test_declaring_by_training_is_a_row_of_its_own(printed):
    text = printed(
        [cell("ranker", declared=each, protocol="domain") for each in ("all", "training")]
    )
    assert "| `ranker` | 50.0 |" in text
    assert "| `ranker, declared by training` | 50.0 |" in text


def test_the_grammar_protocol_by_form_says_what_training_has(printed):
    text = printed([cell("ranker", protocol="grammar", criterion="logical_form")])
    assert "Under grammar, training has the prompts of the paraphrases of unseen forms" in text


def test_each_protocol_has_a_table_of_its_own(printed):
    text = printed([cell(), cell("ranker", 0.9, protocol="domain")])
    strict, domain = text.split("### domain")
    assert strict.startswith("### strict")
    assert "50.0" in strict
    assert "90.0" in domain


def test_a_protocol_has_the_columns_that_were_measured_in_it(printed):
    cells = [cell(), cell("ranker", setting="gen-para", protocol="domain")]
    strict, domain = printed(cells).split("### domain")
    assert "| parser | para-para command |" in strict
    assert "| parser | gen-para command |" in domain


def test_columns_follow_the_paper_and_what_was_not_measured_is_a_dash(printed):
    cells = [
        cell(setting="gen+para-mixed", n_validation=302),
        cell(criterion="logical_form", accuracy=0.0),
        cell("seq2seq", setting="gen-gen", n_validation=121),
    ]
    lines = printed(cells).splitlines()
    forms = " | ".join(f"para-para form, {each}" for each in ("harmonic mean", "unseen", "known"))
    assert f"| parser | gen-gen command | {forms} | gen+para-mixed command |" in lines
    assert "| `knn` | – | – | 0.0 (0.0) | – | 50.0 |" in lines


def test_configurations_of_one_parser_are_rows_named_by_what_differs():
    cells = [cell(), cell(configuration={"neighbours": 3})]
    (table,) = tables(read_figures(cells, "validation", ["knn"]))
    assert [name for name, _ in table.rows] == ["knn neighbours=1", "knn neighbours=3"]


def test_a_cell_measured_again_replaces_the_older():
    (row,) = read_figures([cell(accuracy=0.1), cell(accuracy=0.6)], "validation", ["knn"]).to_dict(
        "records"
    )
    assert (row["mean"], row["seeds"], row["splits"]) == (60.0, 1, 0)


def test_latex_spans_a_setting_over_its_criteria_and_greys_the_paper(printed):
    text = printed([cell(), cell(criterion="logical_form", accuracy=0.0)], "--latex")
    assert r"\multicolumn{4}{c}{para-para}" in text
    assert r"\texttt{knn} & 50.0 \textcolor{gray}{(42.8)}" in text


def test_parsers_are_chosen_by_name(printed):
    text = printed([cell(), cell("seq2seq")], "--parsers", "seq2seq")
    assert "`knn`" not in text
    assert "`seq2seq`" in text


@pytest.mark.parametrize(
    ("cells", "options", "sentence"),
    [
        ([cell()], ["--part", "test"], "has an accuracy on a test part"),
        ([], [], "has an accuracy on a validation part"),
        ([cell(), cell(seed=1, n_validation=97)], [], "97 and 181 pairs"),
    ],
)
def test_what_makes_no_table_is_told_in_a_sentence(cells, options, sentence, printed):
    with pytest.raises(SystemExit) as refusal:
        printed(cells, *options)
    assert sentence in str(refusal.value)


def test_a_model_that_may_have_read_the_corpus_is_marked(printed):
    cells = [cell(), cell("llm", 0.4, answered_by="tiny")]
    text = printed(cells)
    assert "| `llm†` | 40.0 |" in text and "| `knn` |" in text
    assert "† Answers of a language model, which may have read a public corpus" in text
    assert "†" not in printed([cell()])
    assert r"\texttt{llm\textdagger{}} & 40.0" in printed(cells, "--latex")


def test_csv_has_a_row_for_each_cell_without_what_its_intervals_are_drawn_from(printed):
    curve = {"area": 0.1, "brier_score": 0.2, "coverage": [0.5, 1.0], "risk": [0.0, 0.3]}
    cells = [
        cell(
            seed=seed,
            interval=[0.4, 0.6],
            outcomes={"validation": outcomes(20)},
            calibration={"validation": curve},
        )
        for seed in (0, 1)
    ]
    first, second = csv.DictReader(
        printed([*cells, cell("seq2seq")], "--csv", "--parsers", "knn").splitlines()
    )
    assert (first["seed"], second["seed"]) == ("0", "1")
    assert (first["parser"], first["setting"], first["accuracy_validation"]) == (
        "knn",
        "para-para",
        "0.5",
    )
    assert json.loads(first["configuration"]) == {"neighbours": 1}
    assert (first["interval_low"], first["interval_high"]) == ("0.4", "0.6")
    assert (first["area_validation"], first["brier_score_validation"]) == ("0.1", "0.2")
    assert not {"key", "outcomes", "coverage_validation", "risk_validation"} & set(first)


def test_the_kept_figures_of_the_ranker_are_those_of_its_tables():
    kept = Path(__file__).resolve().parents[3] / "benchmarks" / "results" / "ranker.csv"
    with kept.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    columns = {(row["setting"], row["criterion"], row["protocol"]) for row in rows}
    assert len(rows) == 28 and len(columns) == 9
    figures = {
        row["seed"]: round(100 * float(row["accuracy_validation"]), 1)
        for row in rows
        if (row["setting"], row["criterion"], row["protocol"]) == ("para-para", "command", "strict")
    }
    assert figures == {"0": 90.1, "1": 87.8, "2": 89.0}
