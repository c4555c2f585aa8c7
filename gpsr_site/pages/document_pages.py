"""The pages that show the documents of ``docs/``. They hold nobody's data, so everybody may read them."""

from __future__ import annotations

from django.contrib.auth.decorators import login_not_required
from django.http import FileResponse, Http404, HttpRequest, HttpResponse
from django.shortcuts import render

from annotations.people.access import plain_view
from gpsr_site.documents import INDEX, find_document, find_image, search_documents, shelves


@login_not_required
@plain_view()
def documents(request: HttpRequest) -> HttpResponse:
    """Show the first page, which lists all documents, or what they have for the words in ``q``."""
    return _show(request, INDEX)


@login_not_required
@plain_view()
def document(request: HttpRequest, shelf: str, page: str) -> HttpResponse:
    """Show a document of a shelf."""
    return _show(request, f"{shelf}/{page}")


@login_not_required
@plain_view()
def document_image(request: HttpRequest, name: str) -> FileResponse:
    """Send an image of a document."""
    path = find_image(name)
    if path is None:
        raise Http404("There is no such image.")
    return FileResponse(path.open("rb"))


def _show(request: HttpRequest, name: str) -> HttpResponse:
    document = find_document(name)
    if document is None:
        raise Http404("There is no such document.")
    words = request.GET.get("q", "").strip()
    context = {
        "document": document,
        "shelves": shelves(),
        "words": words,
        "hits": search_documents(words),
    }
    return render(request, "gpsr_site/document.html", context)
