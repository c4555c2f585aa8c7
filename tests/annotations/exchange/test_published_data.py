"""Fetching published data: what is checked, what is left alone, and what happens without a network."""

from __future__ import annotations

import hashlib
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import PurePosixPath

import pytest
from django.core.management import CommandError, call_command

from annotations.exchange import published_data
from annotations.exchange.published_data import DataSet, fetch, why_other

GO = b'go to the <room>\n( go " <room> " )\n'
KNOWN = f"sha256 {hashlib.sha256(GO).hexdigest()}"


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *arguments) -> None:
        pass


@pytest.fixture
def site(tmp_path):
    """A folder, and the address under which it is served."""
    folder = tmp_path / "site"
    folder.mkdir()
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield folder, f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()
    server.server_close()


def data_set(url: str, **files: str) -> DataSet:
    return DataSet("corpus", url, "https://example.org/", files)


def test_what_was_published_is_stored_once(site, tmp_path):
    folder, url = site
    (folder / "a").write_bytes(GO)
    asked = data_set(url, a=KNOWN)
    path = tmp_path / "here" / "corpus" / "a"
    assert list(fetch(asked, tmp_path / "here")) == [(path, "", False)]
    assert path.read_bytes() == GO
    (folder / "a").unlink()  # it is not asked for again
    assert list(fetch(asked, tmp_path / "here")) == [(path, "", True)]
    assert [each.name for each in path.parent.iterdir()] == ["a"]


def test_other_content_is_not_stored_and_what_is_there_is_not_replaced(site, tmp_path):
    folder, url = site
    (folder / "a").write_bytes(b"other\n")
    [(path, wrong, was_there)] = fetch(data_set(url, a=KNOWN), tmp_path)
    assert wrong and not was_there and not path.exists()
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(b"mine\n")
    [(path, wrong, was_there)] = fetch(data_set(url, a=KNOWN), tmp_path)
    assert wrong and was_there and path.read_bytes() == b"mine\n"


@pytest.mark.parametrize(
    ("known", "is_it"),
    [(KNOWN, True), ("sha256 00", False), ("lines 2", True), ("lines 3", False), ("", True)],
)
def test_what_is_known_of_a_file_is_checked(known, is_it):
    assert bool(why_other(GO, known)) is not is_it
    assert why_other(b"x" * (published_data.MOST_BYTES + 1), known)


def test_an_answer_that_leads_elsewhere_is_none(site, tmp_path):
    folder, url = site
    (folder / "below").mkdir()  # the server leads to "below/"
    [(path, wrong, _)] = fetch(data_set(url, below=""), tmp_path)
    assert "301" in wrong and not path.exists()


def test_one_file_that_is_missing_does_not_keep_the_others(site, tmp_path):
    folder, url = site
    (folder / "b").write_bytes(GO)
    first, second = fetch(data_set(url, a="", b=KNOWN), tmp_path)
    assert "404" in first[1] and second[1] == "" and second[0].exists()


def test_without_a_network_one_address_is_tried(tmp_path):
    faults = [wrong for _, wrong, _ in fetch(data_set("http://127.0.0.1:9/", a="", b=""), tmp_path)]
    assert len(set(faults)) == 1 and len(faults) == 2


def test_the_list_names_files_below_https_and_inside_their_folders():
    for each in published_data.published_data():
        assert each.url.startswith("https://") and each.url.endswith("/")
        assert each.by_hand.startswith("https://")
        for name in (each.folder, *each.files):
            parts = PurePosixPath(name).parts
            assert ".." not in parts and not PurePosixPath(name).is_absolute()


def test_the_list_knows_the_files_that_figures_were_measured_with(shared_data):
    there = [
        (shared_data / each.folder / name, known)
        for each in published_data.published_data()
        for name, known in each.files.items()
        if known.startswith("sha256") and (shared_data / each.folder / name).exists()
    ]
    assert len(there) == 32
    assert [path for path, known in there if why_other(path.read_bytes(), known)] == []


def test_the_command_says_what_to_do_by_hand(monkeypatch, tmp_path, site):
    folder, url = site
    listed = tmp_path / "list.toml"
    listed.write_text(
        f'[[data]]\nfolder = "corpus"\nurl = "{url}"\nby_hand = "https://example.org/data"\n'
        f'files = {{ a = "{KNOWN}" }}\n'
    )
    monkeypatch.setattr(published_data, "PUBLISHED_DATA", listed)
    with pytest.raises(CommandError, match=r"https://example\.org/data"):
        call_command("fetch_data", tmp_path / "here")
    (folder / "a").write_bytes(GO)
    call_command("fetch_data", tmp_path / "here")
    assert (tmp_path / "here" / "corpus" / "a").read_bytes() == GO
