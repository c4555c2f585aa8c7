"""Send requests to a workbench and read its errors."""

from __future__ import annotations

import json
from collections.abc import Mapping
from http.client import HTTPException, HTTPResponse
from typing import Any
from urllib.error import HTTPError, URLError
from urllib.parse import urlencode, urlsplit
from urllib.request import HTTPRedirectHandler, Request, build_opener

from gpsr_client.errors import Away, Refused

JSON = "application/json"
_AWAY = (502, 503, 504)


class _NoRedirects(HTTPRedirectHandler):
    """Follows nothing: the token goes to the workbench and to nobody else."""

    def redirect_request(self, *_: Any, **__: Any) -> None:
        return None


class Transport:
    """Asks the REST API at ``url`` with a token; every answer takes at most ``timeout`` seconds to begin.

    Raises ValueError for an address that is neither http nor https.
    """

    def __init__(self, url: str, token: str, timeout: float) -> None:
        if urlsplit(url).scheme not in ("http", "https"):
            raise ValueError(
                f"{url!r} is no address of a workbench, such as http://localhost:8000."
            )
        self._url = url.rstrip("/")
        self._token = token
        self._timeout = timeout
        self._opener = build_opener(_NoRedirects)

    def __repr__(self) -> str:
        return f"Transport({self._url!r})"

    def get(self, path: str, **query: object) -> Any:
        """Return the JSON at ``path``. Raises Refused and Away."""
        return _read_json(self.open("GET", path, query=query))

    def post(self, path: str, body: Mapping[str, object], key: str = "") -> Any:
        """Return the JSON answer to a POST; requests with the same ``key`` do their work only once."""
        headers = {"Idempotency-Key": key} if key else {}
        data = json.dumps(body).encode()
        return _read_json(self.open("POST", path, data, headers=headers))

    def open(
        self,
        method: str,
        path: str,
        data: bytes | None = None,
        content_type: str = JSON,
        query: Mapping[str, object] | None = None,
        headers: Mapping[str, str] | None = None,
    ) -> HTTPResponse:
        """Send a request and return the answer, still to be read. Raises Refused and Away."""
        asked = {name: value for name, value in (query or {}).items() if value is not None}
        address = f"{self._url}/api/v1/{path}" + (f"?{urlencode(asked)}" if asked else "")
        request = Request(address, data=data, method=method, headers=dict(headers or {}))
        request.add_header("Authorization", f"Bearer {self._token}")
        if data is not None:
            request.add_header("Content-Type", content_type)
        try:
            response: HTTPResponse = self._opener.open(request, timeout=self._timeout)
        except HTTPError as error:
            with error:
                raise _refusal(error) from error
        except (URLError, HTTPException, OSError) as error:
            raise Away(f"{self._url} does not answer: {error}") from error
        return response


def _read_json(response: HTTPResponse) -> Any:
    try:
        with response:
            return json.loads(response.read())
    except (HTTPException, OSError, ValueError, RecursionError) as error:
        raise Away(f"The answer broke off: {error}") from error


def _refusal(error: HTTPError) -> Away | Refused:
    """Return what an answer with an error says (application/problem+json)."""
    try:
        problem = json.loads(error.read())
        detail, problems = str(problem["detail"]), list(problem.get("problems", ()))
        code = str(problem.get("code", ""))
    except (HTTPException, OSError, ValueError, KeyError, TypeError, RecursionError):
        detail, problems, code = f"The workbench answered with status {error.code}.", [], ""
    if error.code in _AWAY:
        return Away(detail, code)
    return Refused(error.code, detail, problems, code)
