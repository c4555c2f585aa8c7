"""Printed pages have what one reads, light and whole, whatever the theme; ``test_every_page`` prints all of them."""

from __future__ import annotations

import pytest

from gpsr_site.pages.rail import all_entries
from tests.browser.faults import SETTLED, only_faults, printed
from tests.gpsr_site.routes.addresses import address
from tests.parser_service.made_up import make_split
from tests.sample_world import scored_run

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_a_chosen_theme_is_not_printed(page_of, live_server, sample, admin):
    page, reports = page_of(admin), {}
    for entry in all_entries():
        answer = page.goto(live_server.url + address(entry.page, sample))
        assert answer.status < 400, entry
        page.evaluate("document.documentElement.dataset.theme = 'dark'")
        reports[entry.label] = printed(page)
    assert only_faults(reports) == {}


def test_all_columns_of_results_are_on_the_paper(page_of, live_server, sample, admin):
    for name in ("second", "third", "a-split-with-a-long-name"):
        split = make_split(sample.world, name)
        for parser in ("knn", "linear", "seq2seq"):
            run = scored_run(sample.world, split, parser)
            for source in ("para", "mixed"):
                score = run.evaluations.get(test_source="gen")
                score.pk, score.test_source = None, source
                score.save()
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/results/?measure=all&published=yes")
    assert page.locator(".accuracy-table thead th").count() > 8
    assert only_faults({"results": printed(page)}) == {}


def test_the_legend_of_results_is_printed(page_of, live_server, sample, admin):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/results/")
    page.evaluate(SETTLED)
    legend = page.get_by_role("tooltip", include_hidden=True)
    assert not legend.is_visible()
    page.emulate_media(media="print")
    assert legend.is_visible()
