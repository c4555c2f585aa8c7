"""What paraphrases are worth: the curve of the published pairs, and that of a world's own runs."""

from __future__ import annotations

from annotations.models import Split
from parser_service.models import Evaluation, TrainingRun
from parser_service.results.worth_of_paraphrases import measured_elsewhere, measured_here
from parser_service.runs import run_requests


def test_the_published_curve_has_intervals_around_each_point():
    measured = measured_elsewhere()
    [series] = measured["chart"]["series"]
    numbers = [point[0] for point in series["points"]]
    assert numbers == sorted(numbers) and numbers[0] == 0 and len(numbers) > 4
    assert all(low <= percent <= high for _, percent, low, high in series["points"])


def test_runs_with_two_numbers_of_paraphrases_make_a_curve_of_the_world(split):
    Split.objects.update(criterion="command")
    in_percent = {1: (50, 25, 75), 0.5: (37.5, 12.5, 62.5)}
    for share, (percent, low, high) in in_percent.items():
        assert measured_here(split.world) is None  # one number alone is no curve
        run, _ = run_requests.request(
            split.world, split, "knn", train_sources="gen+para", train_share=share, send=False
        )
        TrainingRun.objects.filter(pk=run.pk).update(status="succeeded")
        Evaluation.objects.create(
            run=run,
            **{"part": "validation", "test_source": "para", "count": 8, "correct": 4},
            **{"accuracy": percent / 100, "equivalent": 1, "well_formed": 1},
            **{"interval_low": low / 100, "interval_high": high / 100},
        )
    [series] = measured_here(split.world)["chart"]["series"]
    (half, *half_ends), (whole, *whole_ends) = series["points"]
    assert 0 < half < whole
    assert (tuple(half_ends), tuple(whole_ends)) == (in_percent[0.5], in_percent[1])
    Split.objects.update(criterion="logical_form")
    assert measured_here(split.world) is None
