"""The files of a world, as pages and routes send them."""

from __future__ import annotations

from io import BytesIO
from zipfile import ZIP_DEFLATED, ZipFile

from django.http import Http404, HttpResponse, StreamingHttpResponse

from annotations.exchange.generator_export import GeneratorPart, files_of_part
from annotations.exchange.world_export import archive_name, world_archive
from annotations.models import User, World


def archive_of(world: World, reader: User) -> StreamingHttpResponse:
    """Return the whole world as one zip archive, packed while it is sent."""
    headers = {"Content-Disposition": f'attachment; filename="{archive_name(world)}"'}
    pieces = world_archive(world, reader)
    return StreamingHttpResponse(pieces, content_type="application/zip", headers=headers)


def file_of(world: World, part: str) -> HttpResponse:
    """Return one file as it is, several in an archive that the import page takes. Raises Http404."""
    if part not in GeneratorPart.values:
        raise Http404("There is no such part of a world.")
    files = files_of_part(world, part)
    if not files:
        raise Http404("This part of the world is empty.")
    if len(files) == 1:
        ((name, text),) = files.items()
        return _attachment(text.encode(), "text/plain; charset=utf-8", name)
    packed = BytesIO()
    with ZipFile(packed, "w", ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return _attachment(packed.getvalue(), "application/zip", f"{world.name}-{part}.zip")


def _attachment(data: bytes, kind: str, name: str) -> HttpResponse:
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return HttpResponse(data, content_type=kind, headers=headers)
