"""Middleware: an address of the API is the same with and without its last slash."""

from __future__ import annotations

from collections.abc import Callable

from django.http import HttpRequest, HttpResponse
from django.urls import is_valid_path

from annotations.people.allowances import with_last_slash


class ApiAddresses:
    """Answers at the address without its last slash, too. A redirect would lose what was sent."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        path = with_last_slash(request.path_info)
        if path != request.path_info and is_valid_path(path):
            request.path_info, request.path = path, f"{request.path}/"
        return self.get_response(request)
