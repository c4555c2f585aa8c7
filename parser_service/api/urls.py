"""Routes below ``/api/v1/`` that need a parser."""

from __future__ import annotations

from django.urls import path

from parser_service.api.parsing import ParseRoute

urlpatterns = [
    path("worlds/<slug:world>/parse/", ParseRoute.as_view(), name="parse"),
]
