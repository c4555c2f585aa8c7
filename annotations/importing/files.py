"""The files of an import: from a folder or an upload, bounded."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from django.conf import settings

from annotations.language.decoding import read_folder
from annotations.language.errors import LanguageError, Position


def gather(source: Path | str | Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files to read: name → bytes. Hidden files are left out.

    Raises:
        LanguageError: there is no such folder, there are too many files or bytes, or a name of an
            upload is a path.
    """
    files = dict(source) if isinstance(source, Mapping) else read_folder(Path(source))
    for name in files:
        if "/" in name or "\\" in name:
            raise LanguageError("a file name may not be a path", Position(name), "rename the file")
    _refuse_too_much(files)
    return {name: data for name, data in files.items() if not name.startswith(".")}


def _refuse_too_much(files: Mapping[str, bytes]) -> None:
    if len(files) > settings.UPLOAD_MAX_FILES:
        raise LanguageError(
            f"there are {len(files)} files; {settings.UPLOAD_MAX_FILES} is the limit",
            hint="import the files of one generator at a time",
        )
    total = sum(map(len, files.values()))
    if total > settings.UPLOAD_MAX_BYTES:
        raise LanguageError(
            f"the files hold {total:,} bytes; {settings.UPLOAD_MAX_BYTES:,} is the limit"
        )
