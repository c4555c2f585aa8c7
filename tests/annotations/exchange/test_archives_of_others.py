"""Archives as the programs of others pack them: through every import, the same rows as from the folder."""

from __future__ import annotations

import gzip
import io
import struct
import tarfile
import unicodedata
import zipfile

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.background import claim
from annotations.background.carrying_out_jobs import carry_out
from annotations.campaigns.crowd_jobs import read_results
from annotations.exchange import archives
from annotations.exchange.competition_import import gather_competition
from annotations.exchange.gathered_files import gather
from annotations.exchange.pair_files import gather_pairs, read_pair_folder
from annotations.exchange.source_files import clean_path
from annotations.language.texts.errors import LanguageError
from annotations.models import Job
from tests.annotations.language.world.test_competition_folder import FOLDER

RULES = "$Main = bring me the caf\u00e9 cup\n"
PAIRS = 'go to the kitchen\n( go " kitchen " )\n'
TABLE = "WorkerId,Input.command1,Answer.utterance1\nw,go,please go\n"
FILES = {
    "R/gpsr.txt": RULES,
    "R/caf\u00e9.txt": "$x = go\n",
    "R/names.xml": "<names><name>Ada</name></names>",
    "R/gen/train.txt": PAIRS,
    "R/gen/val.txt": PAIRS,
    **{f"R/{path}": text for path, text in FOLDER.items()},
    "R/results/table.csv": TABLE,
    "R/logo.png": "\x89PNG",
}


def zipped(files, rename=lambda name: name, is_utf8=None, around=(), streamed=False, **options):
    target = io.BytesIO()
    sink = Unseekable(target) if streamed else target
    with zipfile.ZipFile(sink, "w", zipfile.ZIP_DEFLATED, **options) as archive:
        for name, data in around:
            archive.writestr(name, data)
        for path, text in files.items():
            info = zipfile.ZipInfo(rename(path))
            info.compress_type = zipfile.ZIP_DEFLATED
            with archive.open(info, "w", force_zip64=bool(options.get("allowZip64"))) as file:
                file.write(encoded(text))
    return target.getvalue()


class Unseekable(io.RawIOBase):
    """Makes zipfile write data descriptors behind the data."""

    def __init__(self, target):
        self.target = target

    def writable(self):
        return True

    def write(self, data):
        return self.target.write(bytes(data))


def encoded(text):
    return text if isinstance(text, bytes) else text.encode()


def without_flag(data, old, new):
    """Clear the flag of UTF-8 names, and write their bytes in another encoding of the same length or a shorter one."""
    data = bytearray(data.replace(old, new))
    for mark, at in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        start = data.find(mark)
        while start >= 0:
            flags = struct.unpack_from("<H", data, start + at)[0]
            struct.pack_into("<H", data, start + at, flags & ~0x800)
            start = data.find(mark, start + 4)
    return bytes(data)


def tarred(files, mode="w:gz", format=tarfile.PAX_FORMAT):
    target = io.BytesIO()
    with tarfile.open(fileobj=target, mode=mode, format=format) as archive:
        for path, text in files.items():
            info = tarfile.TarInfo(path)
            info.size = len(encoded(text))
            archive.addfile(info, io.BytesIO(encoded(text)))
    return target.getvalue()


MACOS = [("__MACOSX/._R", b"\0\5\x16\7"), ("R/.DS_Store", b"\0"), ("__MACOSX/R/._gpsr.txt", b"\0")]
FOLDERS = [("R/", b""), ("R/gen/", b""), ("R/desktop.ini", b"[x]"), ("R/Thumbs.db", b"\0")]
WAYS = {
    "Python": lambda files: zipped(files),
    "Info-ZIP with folders": lambda files: zipped(files, around=FOLDERS),
    "Windows with backslashes": lambda files: zipped(files, lambda name: name.replace("/", "\\")),
    "Windows with code page 437": lambda files: without_flag(
        zipped(files, lambda name: name.replace("\u00e9", "\u00e9\u00e9")),
        "\u00e9\u00e9".encode(),
        b"\x82\x20\x20\x20",
    ),
    "raw UTF-8 without the flag": lambda files: without_flag(zipped(files), b"", b""),
    "Finder": lambda files: zipped(
        files, lambda name: unicodedata.normalize("NFD", name), around=MACOS, streamed=True
    ),
    "data descriptors": lambda files: zipped(files, streamed=True),
    "zip64": lambda files: zipped(files, allowZip64=True),
    "a code host": lambda files: zipped(files, lambda name: f"repo-4f3a9c/{name}"),
    "absolute": lambda files: zipped(files, lambda name: f"C:\\work/{name}"),
    "out of its folder": lambda files: zipped(files, lambda name: f"../../{name}"),
    "BZIP2": lambda files: zipped(files),
    "tar.gz": tarred,
    "GNU tar": lambda files: tarred(files, format=tarfile.GNU_FORMAT),
    "tar": lambda files: tarred(files, "w"),
}
TEXTS = {
    "as they are": lambda text: text,
    "CRLF": lambda text: text.replace("\n", "\r\n"),
    "a mark": lambda text: b"\xef\xbb\xbf" + text.encode(),
}


def as_folder(files, folder):
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(encoded(text))
    return folder


def uploaded(data, name):
    return [SimpleUploadedFile(name, data)]


def names(files):
    return {name.replace(" ", ""): data for name, data in files.items()}


def read_all(source):
    """What each import reads of a source: files, pairs and problems."""
    pairs = read_pair_folder(gather_pairs(source))
    competition = gather_competition(source)
    return (
        names(gather(source).files),
        {key: [each.utterance for each in rows] for key, rows in pairs.pairs.items()},
        sorted(path.split("/")[-1] for path in competition.files),
        sorted(each.message for each in pairs.problems),
    )


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("way", WAYS)
def test_every_archive_gives_what_its_folder_gives(tmp_path, way, text):
    files = {
        path: TEXTS[text](each) if ".png" not in path else each for path, each in FILES.items()
    }
    data = WAYS[way](files)
    name = "x.tar.gz" if "tar" in way else "x.zip"
    expected = read_all(as_folder(files, tmp_path / "folder"))
    assert expected[0] and expected[1] and len(expected[2]) == 4
    assert read_all(uploaded(data, name)) == expected
    (tmp_path / name).write_bytes(data)
    assert read_all(tmp_path / name) == expected
    table, _ = read_results(*uploaded(data, name))
    assert [each.text for row in table.assignments for each in row.rewrites] == ["please go"]


def test_files_of_a_folder_that_a_browser_sent_are_those_of_the_folder(tmp_path):
    uploads = []
    for path, text in FILES.items():
        uploads.append(SimpleUploadedFile(path, text.encode()))
        uploads[-1].sent_path = path
    assert read_all(uploads) == read_all(as_folder(FILES, tmp_path))


@pytest.mark.parametrize("way", ["Python", "Windows with backslashes", "tar.gz"])
def test_no_problem_names_a_folder_of_the_server(way):
    source = uploaded(
        WAYS[way]({"R/README.md": "nothing"}), "x.tar.gz" if "tar" in way else "x.zip"
    )
    problems = read_pair_folder(gather_pairs(source)).problems
    assert problems and not any("gpsr-" in str(each) or "tmp" in str(each) for each in problems)


def bomb():
    return gzip.compress(tarred({"R/gpsr.txt": b"a" * 300_000_000}, "w"))


REFUSED = {
    "an Excel sheet": lambda: zipped({"[Content_Types].xml": "", "xl/workbook.xml": ""}),
    "7z": lambda: b"7z\xbc\xaf\x27\x1c" + b"\0" * 300,
    "RAR": lambda: b"Rar!\x1a\7" + b"\0" * 300,
    "a packed text": lambda: gzip.compress(b"$Main = go\n"),
    "half a zip": lambda: zipped(FILES)[:200],
    "half a tar": lambda: tarred(FILES)[:100],
    "a packed bomb": bomb,
}


@pytest.mark.parametrize("kind", REFUSED)
@pytest.mark.parametrize("read", [gather, gather_pairs, gather_competition])
def test_what_is_no_archive_is_refused_with_its_name(kind, read, monkeypatch):
    monkeypatch.setattr(archives, "MOST_UNPACKED", 2_000_000)
    with pytest.raises(LanguageError) as refusal:
        read(uploaded(REFUSED[kind](), "sent.bin"))
    assert refusal.value.position.source == "sent.bin" and refusal.value.hint


@pytest.mark.parametrize(
    ("written", "path"),
    [
        ("a\\b.txt", "a/b.txt"),
        ("./a//b.txt", "a/b.txt"),
        ("/etc/b.txt", "etc/b.txt"),
        ("C:\\x\\b.txt", "x/b.txt"),
        ("../../b.txt", "b.txt"),
        ("caf\u0065\u0301.txt", "caf\u00e9.txt"),
        *(
            (hidden, "")
            for hidden in ("__MACOSX/._b.txt", "a/.git/b.txt", "Thumbs.db", "a/", "a\\")
        ),
    ],
)
def test_paths_have_one_form(written, path):
    assert clean_path(written) == path


@pytest.mark.parametrize("way", ["page", "rest"])
def test_a_folder_of_pairs_is_sent_with_its_paths(world, adam, way):
    address = f"/{'w' if way == 'page' else 'api/v1/worlds'}/home/import/pairs/"
    paths = ["Walker/gen/train.txt", "Walker/gen/val.txt"]
    sent = [SimpleUploadedFile(path, PAIRS.encode()) for path in paths]
    adam.post(address, {"name": "w", "archive": sent, "paths": paths})
    assert world.splits.get(name="w-command").examples.count() == 2


@pytest.mark.parametrize("way", ["page", "rest"])
def test_an_arena_is_asked_for_and_chosen(world, admin, adam, way, settings, tmp_path):
    settings.VAR_DIR = tmp_path
    files = {path.replace(".md", "_b.md"): text for path, text in FOLDER.items()}
    files |= {path.replace(".md", "_a.md"): text for path, text in FOLDER.items()}
    data = uploaded(zipped(files), "x.zip")
    start = f"/{'w' if way == 'page' else 'api/v1/worlds'}/home/import/competition/"
    adam.post(start, {"files": data})
    job = Job.objects.get()
    assert job.is_waiting_for_answer and job.report["arenas"] == ["a", "b"]
    answer = (
        f"/jobs/{job.pk}/answer/" if way == "page" else f"/api/v1/worlds/home/jobs/{job.pk}/answer/"
    )
    options = {} if way == "page" else {"content_type": "application/json"}
    for arena in "cb":  # there is no arena c
        adam.post(answer, {"arena": arena}, **options)
    answered = Job.objects.latest("pk")
    assert answered.pk != job.pk
    carry_out(claim("a worker", "quick", Job, answered))
    answered.refresh_from_db()
    assert answered.report["entities"]["room"] == 2 and not answered.report["is_waiting"]


@pytest.mark.parametrize("form", ["（go “kitchen”）", "(go «kitchen»)", "(go ‘kitchen’)"])
def test_forms_of_word_processors_are_read_in_files(world, form):
    pairs = read_pair_folder(
        gather_pairs({"gen/train.txt": f"go to the kitchen\n{form}\n".encode()})
    )
    ((pair,),) = pairs.pairs.values()
    assert pair.canonical_form == '( go " kitchen " )' and not pairs.problems


def test_an_archive_with_one_table_is_utterances(world, adam):
    data = zipped({"R/said.csv": "id,text\n1,bring me the plum\n", "__MACOSX/R/._said.csv": "x"})
    adam.post("/api/v1/worlds/home/uploads/", {"file": uploaded(data, "x.zip")[0]})
    assert world.utterances.get().text == "bring me the plum"
