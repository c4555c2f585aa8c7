"""benchmarks/parsing/accuracy.py: the paper's table from cells."""

from __future__ import annotations

import json

import pytest

from benchmarks.parsing.accuracy import main, read_figures, tables


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


def test_seeds_become_a_mean_with_its_spread_and_the_best_is_bold(printed):
    cells = [cell("seq2seq", accuracy, seed=seed) for seed, accuracy in enumerate((0.7, 0.8, 0.9))]
    lines = printed([cell(), *cells]).splitlines()
    assert "| parser | para-para command |" in lines
    assert "| `knn` | 50.0 (42.8) |" in lines
    assert "| `seq2seq` | **80.0** ± 10.0 (64.4) |" in lines


def test_each_protocol_has_a_table_and_a_best_of_its_own(printed):
    text = printed([cell(), cell("ranker", 0.9, protocol="domain")])
    strict, domain = text.split("### domain")
    assert strict.startswith("### strict")
    assert "**50.0**" in strict
    assert "**90.0**" in domain


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
    assert "| parser | gen-gen command | para-para form | gen+para-mixed command |" in lines
    assert "| `knn` | – | **0.0** (0.0) | **50.0** |" in lines


def test_configurations_of_one_parser_are_rows_named_by_what_differs():
    cells = [cell(), cell(configuration={"neighbours": 3})]
    (table,) = tables(read_figures(cells, "validation", ["knn"]))
    assert [name for name, _ in table.rows] == ["knn neighbours=1", "knn neighbours=3"]


def test_a_cell_measured_again_replaces_the_older():
    (row,) = read_figures([cell(accuracy=0.1), cell(accuracy=0.6)], "validation", ["knn"]).to_dict(
        "records"
    )
    assert (row["mean"], row["seeds"], row["splits"]) == (60.0, 1, 0)


def test_new_splits_become_a_mean_as_seeds_do(printed):
    cells = [
        cell(accuracy=accuracy, split=split, n_validation=180 + split)
        for split, accuracy in enumerate((0.6, 0.7, 0.8))
    ]
    text = printed(cells)
    assert "**70.0** ± 10.0" in text
    assert "over 1 seed, 3 new splits by command;" in text


def test_latex_spans_a_setting_over_its_criteria_and_greys_the_paper(printed):
    text = printed([cell(), cell(criterion="logical_form", accuracy=0.0)], "--latex")
    assert r"\multicolumn{2}{c}{para-para}" in text
    assert r"\texttt{knn} & \textbf{50.0} \textcolor{gray}{(42.8)}" in text


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
        ([cell(), cell(split=0)], [], "on the published split and on new ones"),
    ],
)
def test_what_makes_no_table_is_told_in_a_sentence(cells, options, sentence, printed):
    with pytest.raises(SystemExit) as refusal:
        printed(cells, *options)
    assert sentence in str(refusal.value)
