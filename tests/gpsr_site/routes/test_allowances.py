"""A view that takes files says so, and whoever may send them there can: asked of every route of the site."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from rest_framework.parsers import FileUploadParser, MultiPartParser

from annotations.people.allowances import allowance_at
from gpsr_site import web
from gpsr_site.web.body_limits import ORDINARY_BYTES
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import ALL_ROUTES, VIEWS, ApiRoute

TOO_MUCH = 413


def reads_files(view) -> bool:
    """Whether a view reads files: a route that parses their encoding, or code that names ``request.FILES``."""
    if hasattr(view, "cls"):
        if not ApiRoute(view.cls, getattr(view, "actions", {})).methods & {"post", "put", "patch"}:
            return False
        takes = view.initkwargs.get("parser_classes", view.cls.parser_classes)
        return any(issubclass(each, MultiPartParser | FileUploadParser) for each in takes)
    return "request.FILES" in inspect.getsource(inspect.unwrap(view))


TAKING = sorted(name for name, view in VIEWS.items() if reads_files(view))


def test_every_route_is_looked_at():
    assert VIEWS.keys() == ALL_ROUTES.keys() - {"admin:index"}
    assert {"import", "api:import", "world_import", "api:import-world"} <= set(TAKING)


def test_a_view_declares_that_it_takes_files_if_it_does(sample):
    allowances = {name: allowance_at(address(name, sample).partition("?")[0]) for name in VIEWS}
    assert sorted(name for name, each in allowances.items() if each.takes_files) == TAKING
    assert all(allowances[name].may_take_long for name in TAKING)


@pytest.mark.parametrize("name", TAKING)
def test_files_of_the_largest_size_arrive_where_they_are_taken(name, sample, client_as, settings):
    settings.UPLOAD_MAX_BYTES = 2 * ORDINARY_BYTES
    path = address(name, sample)
    client = client_as("superuser")
    assert sent(client, path, settings.UPLOAD_MAX_BYTES) != TOO_MUCH
    assert sent(client, path, settings.UPLOAD_MAX_BYTES + ORDINARY_BYTES) == TOO_MUCH


@pytest.mark.parametrize("name", TAKING)
@pytest.mark.parametrize("person", ["stranger", "reviewer"])
def test_files_of_people_who_may_not_send_them_there_are_refused_by_their_size(
    name, person, sample, client_as
):
    assert sent(client_as(person), address(name, sample), ORDINARY_BYTES + 1) == TOO_MUCH


def sent(client, path: str, size: int) -> int:
    """Return the status of a request that brings a file of ``size`` bytes which no form asks for."""
    answer = client.post(path, {"nothing": SimpleUploadedFile("nothing", b"a" * size)})
    return int(answer.status_code)


@pytest.mark.parametrize("page", ["generate", "split_new", "split_renew", "download"])
def test_a_page_and_its_route_may_both_take_long(page, sample):
    route = {"split_new": "api:split-list"}.get(page, "api:" + page.replace("_", "-"))
    assert all(allowance_at(address(name, sample)).may_take_long for name in (page, route))


@pytest.mark.parametrize(
    "path",
    [
        *(
            "",
            "/",
            "//",
            "/w/",
            "*",
            "/w/%00/import/",
            "/w/\x00/import/",
            "/w/é/import/",
            "/\ud83d/",
        ),
        *("/w/x/import/" + "a" * 30_000, "/w/" + "x/" * 15_000, "/jobs/" + "9" * 30_000 + "/"),
    ],
)
def test_an_odd_address_takes_no_files_and_costs_little(path):
    assert not allowance_at(path).takes_files


def test_no_limit_goes_by_a_pattern_of_addresses():
    for module in ("body_limits", "thread_shares"):
        source = Path(web.__file__).with_name(f"{module}.py").read_text()
        assert not re.search(r"""["']\^?/(w|api|worlds)\b""", source), module
