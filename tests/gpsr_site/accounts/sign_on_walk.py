"""Walks through single sign-on in a process of its own, whose settings name a server that runs beside.

Usage: python -m tests.gpsr_site.accounts.sign_on_walk FOLDER; exits with an error where something is wrong.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler, HTTPServer
from urllib.parse import parse_qs, urlsplit

from django.test import Client

PERSON = {"sub": "1"}  # who signs on next, as the server says
TOKEN: dict[str, object] = {}  # what the server gives beside the access token


class Server(BaseHTTPRequestHandler):
    """An OpenID Connect server that believes everybody."""

    def do_GET(self) -> None:
        base = f"http://127.0.0.1:{self.server.server_port}"
        if self.path.endswith("openid-configuration"):
            self.answer(
                {
                    "issuer": base,
                    "authorization_endpoint": f"{base}/authorize",
                    "token_endpoint": f"{base}/token",
                    "userinfo_endpoint": f"{base}/me",
                    "jwks_uri": f"{base}/keys",
                }
            )
        else:
            self.answer(PERSON)

    def do_POST(self) -> None:
        self.rfile.read(int(self.headers["Content-Length"]))
        self.answer({"access_token": "t", "token_type": "Bearer", "expires_in": 60, **TOKEN})

    def answer(self, values: dict[str, object]) -> None:
        body = json.dumps(values).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *args: object) -> None:
        """Say nothing."""


def sign_on(client, sub: str, name: str, process: str = "login", next_page: str = ""):
    """Let ``client`` go to the server and come back as ``sub``; returns the last response."""
    return come_back(client, sub, name, begin(client, next_page, process))


def begin(client, next_page: str, process: str = "login") -> str:
    """Let ``client`` go to the server; returns the state with which it comes back."""
    sent = client.post("/sso/site/login/", {"process": process, "next": next_page})
    assert sent.status_code == 302, sent.content
    query = parse_qs(urlsplit(sent["Location"]).query)
    assert query["code_challenge_method"] == ["S256"]
    return query["state"][0]


def come_back(client, sub: str, name: str, state: str):
    PERSON.update(sub=sub, preferred_username=name, email=f"{name}@example.org")
    return client.get("/sso/site/login/callback/", {"code": "c", "state": state})


def walk() -> None:
    """Check what single sign-on does for people who are invited, unknown, members and gone."""
    from annotations.models import Invitation, User, World
    from annotations.models.worlds import Role

    world = World.objects.create(name="home")
    adam = User.objects.create_superuser("adam", password="correct horse")
    _, key = Invitation.issue(world, [Role.ANNOTATOR], adam, 7, 1, "")
    page = f"/join/{key}/"
    join_by_invitation(world, page)
    sign_on_again()
    refuse_strangers(page)
    connect_an_account()
    refuse_a_foreign_issuer()
    refuse_a_closed_account()
    refuse_what_is_made_up()
    take_the_only_place(world, adam)


def join_by_invitation(world, page: str) -> None:
    nora = Client()
    assert "Continue with the lab" in nora.get(page).content.decode()
    assert "form-action 'self' http://127.0.0.1:" in nora.get(page)["Content-Security-Policy"]
    back = sign_on(nora, "n", "nora", next_page=page)
    assert (back.status_code, back.get("Location")) == (302, page), back.content
    assert nora.post(page)["Location"] == "/w/home/"
    assert world.memberships.get().user.username == "nora"


def sign_on_again() -> None:
    from annotations.models import AuditEntry

    again = Client()
    assert sign_on(again, "n", "nora")["Location"] == "/w/home/"  # her only world
    assert again.get("/w/home/").status_code == 200
    entry = AuditEntry.objects.latest("pk")
    assert (entry.who_name, entry.subject) == ("nora", "single sign-on")


def refuse_strangers(page: str) -> None:
    from annotations.models import User

    stranger = Client()
    for next_page in ("", page, "/join/guess/", "//elsewhere.example"):
        refused = sign_on(stranger, "s", "stina", next_page=next_page)
        assert refused.status_code == 403 and b"ask for an invitation" in refused.content
    assert not User.objects.filter(username="stina").exists()

    other_nora = Client()  # nobody gets an account by its name alone
    assert sign_on(other_nora, "x", "adam").status_code == 403


def connect_an_account() -> None:
    adams = Client()
    adams.post("/login/", {"username": "adam", "password": "correct horse"})
    assert sign_on(adams, "a", "adam", process="connect")["Location"] == "/account/"
    later = Client()
    sign_on(later, "a", "adam")
    assert "You are adam." in later.get("/account/").content.decode()


def refuse_a_foreign_issuer() -> None:
    """A token that names another issuer or is for another site lets nobody in, whoever it says they are."""
    import jwt

    now = int(time.time())
    ours = {"iss": os.environ["SSO_SERVER_URL"], "aud": "site", "sub": "n"}
    for claims, is_ours in (
        (ours, True),
        ({**ours, "iss": "https://elsewhere.example"}, False),
        ({**ours, "aud": "another site"}, False),
    ):
        sent = {**claims, "iat": now, "exp": now + 60}
        TOKEN["id_token"] = jwt.encode(sent, "a key of forty characters, as it has to be", "HS256")
        nora = Client()
        answer = sign_on(nora, "n", "nora")
        assert (answer.status_code == 302) is is_ours, (claims, answer.status_code)
        assert (nora.get("/w/home/").status_code == 200) is is_ours, claims
    TOKEN.clear()


def refuse_a_closed_account() -> None:
    from annotations.models import User

    User.objects.filter(username="nora").update(is_active=False)
    closed = sign_on(Client(), "n", "nora")
    assert closed.status_code == 403 and b"This account is closed." in closed.content


def refuse_what_is_made_up() -> None:
    assert b"Continue with the lab" in Client().get("/sso/site/login/").content
    made_up = Client().get("/sso/site/login/callback/", {"code": "c", "state": "made up"})
    assert made_up.status_code == 403 and b"did not succeed" in made_up.content
    assert Client().get("/sso/signup/").status_code in (302, 404)


def take_the_only_place(world, adam) -> None:
    """Three begin while the link is open and come back after each other: the place makes one account."""
    from annotations.models import Invitation, User
    from annotations.models.worlds import Role

    _, key = Invitation.issue(world, [Role.REVIEWER], adam, 7, 1, "")
    page = f"/join/{key}/"
    browsers = {name: Client() for name in ("olga", "pia", "rosa")}
    states = {name: begin(client, page) for name, client in browsers.items()}
    statuses = [come_back(browsers[name], name, name, states[name]).status_code for name in states]
    assert statuses == [302, 403, 403], statuses
    assert not User.objects.filter(username__in=["pia", "rosa"]).exists()
    assert world.memberships.get(role=Role.REVIEWER).user.username == "olga"
    assert browsers["olga"].get(page)["Location"] == "/w/home/"


def main() -> None:
    server = HTTPServer(("127.0.0.1", 0), Server)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    os.environ.pop("DATABASE_URL", None)
    os.environ |= {
        "DJANGO_SETTINGS_MODULE": "gpsr_site.settings",
        "GPSR_VAR_DIR": sys.argv[1],
        "ALLOWED_HOSTS": "testserver",
        "SSO_SERVER_URL": f"http://127.0.0.1:{server.server_port}",
        "SSO_CLIENT_ID": "site",
        "SSO_CLIENT_SECRET": "secret",
        "SSO_NAME": "the lab",
    }
    import django
    from django.conf import settings

    django.setup()
    plain = "django.contrib.staticfiles.storage.StaticFilesStorage"
    settings.STORAGES = {**settings.STORAGES, "staticfiles": {"BACKEND": plain}}
    from django.core.management import call_command

    call_command("migrate", verbosity=0)
    walk()


if __name__ == "__main__":
    main()
