"""The runs stand in the window without scrolling to the side."""

from __future__ import annotations

import pytest

from annotations.models import Split
from parser_service.models import TrainingRun
from tests.browser.variants import NARROW_DARK, WIDE_LIGHT, Variant
from tests.parser_service.web.results.test_result_pages import by_form
from tests.sample_world import scored_run

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]
LONG = "seq2seq-glove-bert-large"
FAILURE = "Training diverged in epoch 1: the loss is not a number. Try a learning rate below 0.01."


@pytest.mark.parametrize("variant", [WIDE_LIGHT, NARROW_DARK], ids=str)
def test_the_table_of_runs_fits_the_window(variant: Variant, page_of, live_server, sample, admin):
    by_form(sample)
    spoken = sample.run.evaluations.all()
    for score in list(spoken):
        score.pk, score.test_source = None, "para"
        score.save()
    Split.objects.update(name="walker2019-by-logical_form")
    failed = scored_run(sample.world, sample.split, "seq2seq", seed=12)
    TrainingRun.objects.filter(pk=failed.pk).update(parser=LONG, status="failed", failure=FAILURE)
    TrainingRun.objects.update(seconds_trained=12345, created_by=admin, train_share=0.25)
    page = page_of(admin, variant=variant)
    page.goto(f"{live_server.url}/w/home/runs/")
    table = page.locator("#runs-table")
    assert table.locator("tbody tr").count() == 2
    assert "unseen 50.0 · known 75.0" in " ".join(table.inner_text().split())
    wider = table.evaluate("wrap => wrap.scrollWidth - wrap.clientWidth")
    assert wider <= 0, f"the table is {wider} pixels wider than the window"
