"""Which addresses people may be sent to, and which pages may frame a campaign."""

from __future__ import annotations

import pytest

from annotations.campaigns.addresses import BadAddress, origins_in, require_public_address
from annotations.people.local_names import is_local_link

GOOD = [
    "https://app.prolific.com/submissions/complete?cc=C1",
    "https://www.mturk.com/mturk/externalSubmit",
    "https://market.example:8443/a?s={assignment}",
    "https://münchen.example/x",
]
BAD = [
    *("http://market.example/", "ftp://market.example/", "javascript:alert(1)", "//market.example"),
    *("https://me:secret@market.example/", "https://me@market.example/", "https:///x", "https://"),
    *("https://localhost/", "https://127.0.0.1/", "https://[::1]/", "https://10.0.0.7/x"),
    *("https://2130706433/", "https://0x7f.1/", "https://127.1/", "https://8.8.8.8/"),
    *("https://printer.local/", "https://wiki/", "https://a.internal/", "https://LOCALHOST./"),
    *("https://[::ffff:10.0.0.1]/", "https://market.example:99999/", "https://evil.example\\@good.example/"),
    *("https://-a.example/", "https://a..example/", "https://a b.example/", "http://localhost:8000/"),
]  # fmt: skip


@pytest.mark.parametrize("address", GOOD)
def test_a_public_address_is_taken(address):
    require_public_address(address)


@pytest.mark.parametrize("address", BAD)
def test_another_address_is_refused(address):
    with pytest.raises(BadAddress):
        require_public_address(address)


def test_a_site_of_this_computer_may_send_people_to_itself(settings):
    settings.ALLOWED_HOSTS = settings.LOCAL_HOSTS
    for address in ("http://localhost:8000/x", "http://127.0.0.1/x", "http://[::1]:1/x"):
        require_public_address(address)
    for address in ("http://market.example/", "http://me:x@localhost/", "ftp://localhost/"):
        with pytest.raises(BadAddress):
            require_public_address(address)


def test_origins_are_written_in_one_way():
    text = " https://Worker.mturk.com/, https://a.example:8443\nhttps://worker.mturk.com"
    assert origins_in(text) == "https://worker.mturk.com https://a.example:8443"
    assert origins_in(" ") == ""


@pytest.mark.parametrize(
    "text",
    [
        *("*", "https://*.mturk.com", "https://a.example/path", "https://a.example?x", "'self'"),
        *("https://a.example; script-src *", "http://a.example", "a.example", "https:", "data:"),
        *("https://a.example;script-src", "https://a.example#x", "https://münchen.example"),
        " ".join(f"https://a{number}.example" for number in range(9)),
    ],
)
def test_what_is_no_origin_is_refused(text):
    with pytest.raises(BadAddress):
        origins_in(text)


@pytest.mark.parametrize(
    ("link", "is_local"),
    [
        *((f"http://{name}/p/x/", True) for name in ("localhost:8000", "127.0.0.1", "127.9.9.9")),
        *((f"http://{name}/p/x/", True) for name in ("[::1]:1", "0.0.0.0:80", "a.localhost")),
        *((f"http://{name}/p/x/", False) for name in ("10.0.0.7", "lab.example", "localhost.example")),
        *((each, False) for each in ("a-token", "", "gpsr_127.0.0.1")),
    ],
)  # fmt: skip
def test_a_link_that_only_this_computer_opens_is_known(link, is_local):
    assert is_local_link(link) == is_local
