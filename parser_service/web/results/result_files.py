"""The results as a file, for the page and for programs."""

from __future__ import annotations

from django.http import HttpResponse, QueryDict

from annotations.models import World
from annotations.web.rest.negotiation import CONTENT_TYPES
from parser_service.results.export import export_results
from parser_service.results.result_choices import read_choices, scored_splits


def results_file(world: World, query: QueryDict, as_: str) -> HttpResponse:
    """Answer with what the results page shows for ``query``, to be kept as a file; ``as_`` is a ``ResultsFormat``."""
    choices = read_choices(query, world, scored_splits(world))
    response = HttpResponse(export_results(world, choices, as_), content_type=CONTENT_TYPES[as_])
    response["Content-Disposition"] = f'attachment; filename="{world.name}-results.{as_}"'
    return response
