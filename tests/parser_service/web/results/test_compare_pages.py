"""The compare page says what the analysis core says, and every number leads to its answers."""

from __future__ import annotations

import re

import numpy as np
import pytest

from parser_service.analysis.comparing import compare_runs
from parser_service.analysis.confusions import confuse_heads
from parser_service.analysis.encoded_labels import encode
from parser_service.analysis.outcomes import encode_clusters
from parser_service.analysis.slicing import accuracy_of_labels, bin_names, head_predicates
from parser_service.models import ErrorCategory, Prediction, Review, Slice
from parser_service.results import breakdown
from parser_service.results.saving import save_slice
from parser_service.runs.split_pairs import cluster_of
from tests.sample_world import scored_run

PAGE = "/w/home/compare/"


@pytest.fixture
def second(sample):
    return scored_run(sample.world, sample.split, right=8, seed=1)


@pytest.fixture
def third(sample):
    return scored_run(sample.world, sample.split, parser="seq2seq", right=5)


def compare(client, *runs, **chosen):
    return client.get(PAGE, {"run": [run.pk for run in runs], "part": "validation", **chosen})


def outcomes(*runs):
    """Whether each run is right, by the key of the example: [runs, examples]."""
    rows = [run.predictions.order_by("example_id") for run in runs]
    return np.array([each.values_list("is_exact_match", flat=True) for each in rows])


def clusters_of(run):
    """The cluster of each example, [examples]."""
    rows = run.predictions.order_by("example_id").select_related("example")
    return encode_clusters([cluster_of(each.example, run.split.criterion) for each in rows])


def total_behind(client, url):
    return client.get(url).context["listing"].total


def test_wins_losses_and_what_they_mean_are_those_of_the_core(sample, second, third, anna):
    runs = (sample.run, second, third)
    context = compare(anna, *runs).context
    expected = compare_runs(outcomes(*runs), clusters_of(sample.run))
    assert [pair.comparison for pair in context["pairs"]] == list(expected)
    names = [f"Nearest neighbour (run {run.pk})" for run in runs]
    assert context["pairs"][0].letters == ("A", "B")
    assert str(runs[1].pk) in context["pairs"][0].meaning, names


def test_the_form_sends_the_runs_in_their_order(sample, second, third, anna):
    page = compare(anna, second, sample.run)
    assert [each.run for each in page.context["choice"].offered] == [second, sample.run, third]
    boxes = re.findall(r'name="run" id="run-(\d+)" value="\1" checked', page.content.decode())
    assert boxes == [str(second.pk), str(sample.run.pk)]


def test_without_a_part_the_runs_say_which(sample, second, third, anna):
    third.evaluations.update(part="test")  # so that the page begins with the test part
    assert anna.get(PAGE, follow=True).context["choice"].part == "test"
    page = anna.get(PAGE, {"run": [sample.run.pk, second.pk]})
    assert page.context["choice"].part == "validation"
    assert page.context["pairs"]


def test_each_cell_of_the_matrix_leads_to_the_answers_that_it_counts(sample, second, third, anna):
    for query in ({}, {"source": "generated"}):
        matrix = compare(anna, sample.run, second, third, **query).context["matrix"]
        cells = [cell for _, row in matrix for cell in row if cell.count]
        assert cells
        for cell in cells:
            assert total_behind(anna, cell.url) == cell.count


def test_runs_are_compared_by_plan_too(sample, second, anna):
    """One more answer of the first run has the plan of its label, though another form."""
    wrong = sample.run.predictions.filter(is_exact_match=False).order_by("example_id").last()
    Prediction.objects.filter(pk=wrong.pk).update(is_same_plan=True)
    by_form, by_plan = (
        compare(anna, sample.run, second, measure=measure).context
        for measure in ("exact", "same_plan")
    )
    assert by_form["measure"] == "exact"
    assert [cell.correct for *_, cell in by_form["accuracies"]] == [3, 8]
    assert [cell.correct for *_, cell in by_plan["accuracies"]] == [4, 8]
    cells = [cell for _, row in by_plan["matrix"] for cell in row if cell.count]
    cells += [cell for *_, cell in by_plan["accuracies"]]
    for cell in cells:
        behind = cell.count - cell.correct if hasattr(cell, "correct") else cell.count
        assert total_behind(anna, cell.url) == behind
    (bigger,) = [url for measure, url in by_plan["measure_urls"] if measure == "exact"]
    assert anna.get(f"{PAGE}{bigger}").context["measure"] == "exact"


def test_a_run_whose_plans_were_not_compared_is_named(sample, second, anna):
    second.predictions.update(is_same_plan=None)
    for measure, named in (("exact", []), ("same_plan", [second])):
        page = compare(anna, sample.run, second, measure=measure)
        assert page.context["compared"].without_plans == [second]
        notes = re.findall(r'/runs/(\d+)/">run \d+</a> were not all', page.content.decode())
        assert notes == [str(run.pk) for run in named]


def test_a_measure_that_is_misspelled_is_exact_match(sample, second, anna):
    assert compare(anna, sample.run, second, measure="best").context["measure"] == "exact"


def length_bin(text: str) -> str:
    return bin_names()[min((len(text.split()) - 1) // 4, 4)]


def test_slices_are_those_of_the_core_and_lead_to_their_answers(sample, second, anna):
    context = compare(anna, sample.run, second).context
    tables = {table.name: table for table in context["breakdowns"]}
    examples = [each.example for each in sample.run.predictions.order_by("example_id")]
    labels = {
        "words": [length_bin(each.utterance) for each in examples],
        "source": [each.source for each in examples],
        "head": [each.logical_form.split()[1] for each in examples],
    }
    for name, values in labels.items():
        core = accuracy_of_labels(
            outcomes(sample.run, second), encode(values), clusters_of(sample.run)
        )
        by_title = {row.title: row for row in tables[name].rows}
        for place, value in enumerate(core.values):
            row = by_title[value]
            assert row.count == core.counts[place]
            assert total_behind(anna, row.url) == row.count
            for run, cell in enumerate(row.cells):
                assert cell.percent == pytest.approx(100 * core.accuracies[run, place])
                assert (cell.low, cell.high) == pytest.approx(
                    (100 * core.low[run, place], 100 * core.high[run, place])
                )
                assert total_behind(anna, cell.url) == (cell.count - cell.correct or cell.count)
    assert "depth" not in tables, "all forms are equally deep"
    assert {each.depth for each in examples} == {3}


def test_confusions_are_those_of_the_core_and_lead_to_their_answers(sample, second, anna):
    heat = compare(anna, sample.run, second, confusion=second.pk).context["heat"]
    rows = list(second.predictions.select_related("example"))
    labels, answers = (
        encode(head_predicates(forms))
        for forms in (
            [row.example.logical_form for row in rows],
            [row.logical_form for row in rows],
        )
    )
    core = confuse_heads(labels, answers)
    shown = {
        (row.head, head): cell
        for row in heat.rows
        for head, cell in zip(heat.columns, row.cells, strict=True)
        if cell.count
    }
    for (label, answer), cell in shown.items():
        place = core.heads.index(label), core.heads.index(answer)
        assert cell.count == core.counts[place]
        assert total_behind(anna, cell.url) == cell.count
    assert heat.n_errors == sum(count for *_, count in core.errors())


def test_a_slice_of_the_address_holds_for_everything(sample, second, anna):
    saved = save_slice(sample.world, "short", "max_words=7")
    counts = {
        compare(anna, sample.run, second, **query).context["compared"].count
        for query in ({"max_words": 7}, {"slice": saved.pk})
    }
    assert counts == {sample.split.examples.filter(part="validation", word_count__lte=7).count()}


def test_groups_within_a_slice_lead_to_what_is_in_both(sample, second, anna):
    save_slice(sample.world, "fetching", "q=fetch")
    context = compare(anna, sample.run, second, min_words=7, max_words=8).context
    for table in (*context["breakdowns"], context["saved"]):
        for row in table.rows:
            for cell in row.cells:
                if cell.url and cell.count:
                    assert total_behind(anna, cell.url) == (cell.count - cell.correct or cell.count)


def test_what_is_said_of_answers_is_meant_of_the_first_run(sample, second, anna):
    context = compare(anna, sample.run, second, outcome="wrong").context
    assert context["compared"].count == 9
    accuracies = [cell for _, _, cell in context["accuracies"]]
    assert [cell.correct for cell in accuracies] == [0, 5]
    assert total_behind(anna, accuracies[1].url) == 4
    for _, row in context["matrix"]:
        for cell in row:
            if cell.count and cell.url:
                assert total_behind(anna, cell.url) == cell.count


def test_saved_slices_are_rows_of_their_own(sample, second, anna):
    save_slice(sample.world, "fetching", "q=fetch")
    save_slice(sample.world, "nothing", "q=xyzzy")
    rows = {row.title: row for row in compare(anna, sample.run, second).context["saved"].rows}
    assert (rows["fetching"].count, rows["nothing"].count) == (2, 0)
    assert rows["nothing"].cells[0].percent is None
    assert anna.get(rows["fetching"].url).context["compared"].count == 2


@pytest.mark.parametrize(("most", "fetching"), [(11, None), (12, 2)])
def test_of_many_examples_only_slices_that_columns_tell_are_counted(
    most, fetching, sample, second, anna, monkeypatch
):
    monkeypatch.setattr(breakdown, "MOST_ASKED", most)
    save_slice(sample.world, "fetching", "q=fetch")
    save_slice(sample.world, "short", "max_words=7")
    rows = {row.title: row for row in compare(anna, sample.run, second).context["saved"].rows}
    short = sample.split.examples.filter(part="validation", word_count__lte=7).count()
    assert {title: row.count for title, row in rows.items()} == {
        "fetching": fetching,
        "short": short,
    }
    assert bool(rows["fetching"].cells) == (fetching is not None)
    assert anna.get(rows["fetching"].url).context["compared"].count == 2


def test_of_many_groups_the_frequent_ones_are_shown(sample, second, anna, monkeypatch):
    tables = {
        table.name: table for table in compare(anna, sample.run, second).context["breakdowns"]
    }
    monkeypatch.setattr(breakdown, "MOST_ROWS", 2)
    context = compare(anna, sample.run, second).context
    cut = {table.name: table for table in context["breakdowns"]}
    heads = sorted((row.count for row in tables["head"].rows), reverse=True)
    assert [row.count for row in cut["head"].rows] == heads[:2]
    assert cut["head"].n_more == len(heads) - 2
    assert all(len(table.rows) > 1 for table in tables.values())


def test_errors_are_broken_down_by_what_people_say_of_them_or_else_the_machine(
    sample, second, anna
):
    codes = ("wrong_predicate", "ill_formed")
    first, other = (
        ErrorCategory.objects.create(world=sample.world, code=code, name=code.upper(), position=1)
        for code in codes
    )
    wrong = list(sample.run.predictions.filter(is_exact_match=False).order_by("example_id"))
    for row in wrong[:4]:
        Review.objects.create(run=sample.run, example=row.example, category=first, is_proposed=True)
    Review.objects.create(run=sample.run, example=wrong[0].example, category=other)
    tables = compare(anna, sample.run, second).context["breakdowns"]
    rows = {row.title: row for table in tables for row in table.rows if table.name == "error"}
    counts = {title: row.count for title, row in rows.items()}
    assert counts == {"WRONG_PREDICATE": 3, "ILL_FORMED": 1, "not categorised": 5, "right": 3}
    for row in rows.values():
        assert total_behind(anna, row.url) == row.count
    cell = rows["not categorised"].cells[1]
    assert total_behind(anna, cell.url) == (cell.count - cell.correct or cell.count)


def test_an_example_that_one_run_was_not_asked_is_left_out(sample, second, anna):
    second.predictions.first().delete()
    assert compare(anna, sample.run, second).context["compared"].count == 11


def test_without_two_runs_the_page_says_what_to_do(sample, anna):
    page = anna.get(PAGE, {"part": "validation"})
    assert not page.context["choice"].suggested and '<div class="empty">' in page.content.decode()
    scored_run(sample.world, sample.split, parser="seq2seq", right=5)
    answer = anna.get(PAGE, {"part": "validation", "run": sample.run.pk})
    suggestion = answer.context["suggestion_url"].replace("&", "&amp;")
    assert f'class="primary" href="{suggestion}"' in answer.content.decode()
    suggested = anna.get(PAGE + answer.context["suggestion_url"]).context
    assert {run.parser for run in suggested["choice"].runs} == {"knn", "seq2seq"}


def test_a_world_without_scores_says_what_belongs_here(world, anna):
    assert '<div class="empty">' in anna.get(PAGE).content.decode()


def test_a_run_of_another_split_or_world_is_left_out_and_named(sample, second, other_sample, anna):
    from tests.parser_service.made_up import make_split

    elsewhere = scored_run(sample.world, make_split(sample.world, "second-split"))
    page = compare(anna, sample.run, second, elsewhere, other_sample.run)
    assert page.context["choice"].runs == (sample.run, second)
    notes = page.context["choice"].notes
    assert any(f"Run {elsewhere.pk} " in each for each in notes)
    assert any(each.startswith("1 run ") for each in notes) and len(notes) == 2
    assert all(each in page.content.decode() for each in notes)


@pytest.mark.parametrize(
    "query",
    ["run=x&run=1&run=1", "run=99999999999999999999&run=-1", "run=1&part=train", "confusion=x",
     "run=%00", "split=nowhere", "min_words=x&head=%ED%A0%80&slice=5"],
)  # fmt: skip
def test_an_odd_address_is_answered(query, sample, second, anna):
    assert anna.get(f"{PAGE}?{query}", follow=True).status_code == 200


def test_a_slice_without_examples_says_so(sample, second, anna):
    page = compare(anna, sample.run, second, min_words=500).content.decode()
    assert "Remove a filter" in page


def test_what_people_wrote_is_escaped(sample, second, anna):
    Slice.objects.create(world=sample.world, name="<script>x</script>", query="outcome=wrong")
    sample.split.examples.update(task_category="<b>bold</b>")
    Prediction.objects.filter(run=second).update(logical_form='( <i>x " <room> " )')
    page = compare(anna, sample.run, second).content.decode()
    for text in ("<script>x", "<b>bold", "<i>x"):
        assert text not in page


def test_fifty_runs_are_offered_without_a_query_each(sample, anna, django_assert_max_num_queries):
    for seed in range(1, 51):
        scored_run(sample.world, sample.split, right=4, seed=seed)
    with django_assert_max_num_queries(51):
        page = anna.get(PAGE, {"part": "validation", "run": [1, 2, 3]})
    assert page.content.decode().count('name="run"') >= 50


def differing(client, *runs):
    return {each.name: each.values for each in compare(client, *runs).context["configuration"].rows}


def test_only_what_differs_in_the_configuration_is_shown(sample, second, anna):
    assert differing(anna, sample.run, second) == {"seed": (sample.run.seed, 1)}
    second.config = {**second.config, "metric": "other"} | {next(iter(second.config)): "changed"}
    second.save()
    assert next(iter(sample.run.config)) in differing(anna, sample.run, second)


def test_what_only_one_parser_has_stands_apart(sample, third, anna):
    shown = compare(anna, sample.run, third).context["configuration"]
    assert {"parser"} <= {each.name for each in shown.rows}
    assert {each.name for each in shown.own} >= third.config.keys() - sample.run.config.keys()
    assert all(None in each.values for each in shown.own)


def pin(client, run, query=""):
    sent = {"query": query} | ({"run": run.pk} if run else {})
    return client.post(f"{PAGE}baseline/", sent)


def test_a_pinned_baseline_comes_first_and_stays(sample, second, third, anna):
    answer = pin(anna, third, f"run={second.pk}&run={third.pk}&part=validation")
    assert compare_order(answer.url) == [third.pk, second.pk]
    assert compare_order(anna.get(PAGE).url)[0] == third.pk
    assert compare_order(compare(anna, second).url) == [third.pk, second.pk]
    assert compare(anna, sample.run, second).context["choice"].runs == (sample.run, second)
    assert compare(anna, third, second).context["baseline"] == third


def test_who_unpins_the_baseline_compares_the_two_best_again(sample, second, third, anna):
    opening = anna.get(PAGE).url
    pin(anna, third)
    pin(anna, None)
    assert anna.get(PAGE).url == opening


def test_each_reader_has_a_baseline_of_their_own(sample, second, third, anna, rene):
    opening = rene.get(PAGE).url
    pin(anna, third)
    assert rene.get(PAGE).url == opening


def test_a_run_of_another_world_is_no_baseline(sample, second, anna):
    pin(anna, None)
    anna.post(f"{PAGE}baseline/", {"run": 10**6})
    assert compare(anna, sample.run, second).context["baseline"] is None


def compare_order(url):
    return list(map(int, re.findall(r"run=(\d+)", url)))


def test_one_run_alone_is_shown_by_its_slices_and_confusions(sample, anna):
    context = compare(anna, sample.run).context
    assert context["pairs"] == [] and context["configuration"] is None
    assert sum(row.count for row in context["heat"].rows) == context["compared"].count
