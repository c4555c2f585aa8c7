"""What commands change is in the audit log; old entries of it can be deleted."""

from __future__ import annotations

import io
import pkgutil
from datetime import timedelta

import pytest
from django.core.management import CommandError, call_command, load_command_class
from django.utils import timezone

import annotations.management.commands
import gpsr_site.management.commands
import parser_service.management.commands
from annotations.generation.split_statistics import store_figures
from annotations.management.base import ReportingCommand
from annotations.models import AuditEntry, User, World
from annotations.people.audit_log import prune
from parser_service.runs.promoting import promoted_run
from tests.annotations.commands.run_command import run
from tests.annotations.exchange.packing import pack
from tests.parser_service.made_up import make_split

PACKAGES = (annotations, gpsr_site, parser_service)
# Commands that change nothing that others see, or serve what writes the log itself.
READING = {
    *("audit_labels", "benchmark", "backup", "expand_grammar", "export_split", "export_world"),
    *("export_rephrased", "export_vocabulary", "leakage", "parse", "parse_server", "serve", "work"),
    *("export_run", "fetch_data"),
}
# They make an installation: from a backup, whose log it becomes, or from an older version.
RESTORING = {"restore", "migrate"}
# They call record_command themselves.
RECORDING = {"changepassword", "createsuperuser", "issue_token", "quickstart", "train"}


def entries() -> list[tuple[str, str, str, str]]:
    rows = AuditEntry.objects.order_by("pk")
    return list(rows.values_list("who_name", "what", "subject", "world_name"))


def test_every_command_is_in_the_log_or_has_a_reason_not_to_be():
    for package in PACKAGES:
        folder = package.management.commands.__path__
        for module in pkgutil.iter_modules(folder):
            command = load_command_class(package.__name__, module.name)
            is_audited = isinstance(command, ReportingCommand) and bool(command.audited)
            others = READING | RESTORING | RECORDING
            assert is_audited != (module.name in others), module.name


def test_a_world_that_is_built_by_commands(db, tiny_folder, tmp_path):
    for command in (
        ("import_generator", tiny_folder, "--world", "flat"),
        ("generate_pairs", "flat"),
        ("freeze_split", "flat", "--name", "first"),
    ):
        assert run(*command)[1] is None
    archive = tmp_path / "flat.zip"
    archive.write_bytes(pack(World.objects.get(name="flat")).getvalue())
    assert run("import_world", archive, "--world", "again")[1] is None
    assert entries() == [
        ("command line", "import files", str(tiny_folder), "flat"),
        ("command line", "generate commands", "", "flat"),
        ("command line", "freeze a split", "first", "flat"),
        ("command line", "import a world", "flat.zip", "again"),
    ]


def test_what_was_refused_is_not_in_it(db, tiny_folder):
    (tiny_folder / "tiny_category_1_grammar.txt").write_text("$Main = $Main")
    assert run("import_generator", tiny_folder, "--world", "flat")[1]
    assert run("freeze_split", "flat", "--name", "first")[1]
    assert entries() == []


def test_accounts_tokens_and_passwords_without_a_secret(db, monkeypatch):
    secret = "a battery staple"
    call_command("createsuperuser", "--no-input", username="root", email="", stdout=io.StringIO())
    out = io.StringIO()
    call_command("issue_token", "root", "--name", "arm", "--scope", "train", stdout=out)
    monkeypatch.setattr("getpass.getpass", lambda prompt: secret)
    call_command("changepassword", "root", stdout=io.StringIO())
    assert User.objects.get().check_password(secret)
    assert entries() == [
        ("command line", "make an account", "root, administrator of the site", ""),
        ("command line", "make a token", "arm (train) for root", ""),
        ("command line", "change password", "of root", ""),
    ]
    written = str(list(AuditEntry.objects.values()))
    assert secret not in written and out.getvalue().strip() not in written


def test_a_password_that_stays_is_not_in_it(superuser, monkeypatch):
    monkeypatch.setattr("getpass.getpass", lambda prompt: "1")
    with pytest.raises(CommandError):
        call_command("changepassword", "root", stdout=io.StringIO(), stderr=io.StringIO())
    assert entries() == []


def test_a_run_and_its_promotion(world, transactional_db, settings, tmp_path):
    settings.RUNS_DIR = tmp_path
    split = make_split(world)
    known = split.examples.get(part="train", source="paraphrased", position=1)
    asked = split.examples.filter(part="validation")
    asked.update(utterance=known.utterance, logical_form=known.logical_form)
    store_figures(split)
    report, _ = run("train", "knn", "--world", "home", "--split", "home", "--sources", "gen,para")
    promoted = promoted_run(world)
    assert promoted is not None and report["status"] == "succeeded"
    name = f"run {promoted.pk}"
    assert entries() == [
        ("rule", "promote a run", f"{name}: {promoted.promotions.get().reason}", "home"),
        ("command line", "start a run", name, "home"),
    ]


def aged(world: World | None, *days: int) -> None:
    for age in days:
        at = timezone.now() - timedelta(days=age)
        name = world.name if world else ""
        AuditEntry.objects.create(
            world=world, world_name=name, who_name="anna", what="label", at=at
        )


def test_old_entries_are_deleted_and_that_is_an_entry(world, other_world):
    aged(world, 400, 366, 364, 0)
    aged(other_world, 400)
    aged(None, 400)
    report, failure = run("prune_audit_log", "--older-than", 365, "--world", "home")
    assert failure is None and report["deleted"] == 2
    assert entries()[-1][:2] == ("command line", "prune the audit log")
    assert entries()[-1][2].startswith("2 entries from before 2")
    assert AuditEntry.objects.filter(world=other_world).exists()
    report, _ = run("prune_audit_log", "--older-than", 365)
    assert report["deleted"] == 2
    assert AuditEntry.objects.filter(what="label").count() == 2


def test_pruning_goes_on_in_short_transactions(world, monkeypatch):
    monkeypatch.setattr("annotations.people.audit_log.MOST_AT_ONCE", 2)
    aged(world, *[10] * 5)
    assert prune(timezone.now() - timedelta(days=9)) == 5


@pytest.mark.parametrize("days", [0, -3, 10**9])
def test_ages_that_make_no_sense_are_refused(days, world):
    aged(world, 400)
    report, failure = run("prune_audit_log", "--older-than", days)
    assert report is None and "--older-than is" in str(failure)
    assert AuditEntry.objects.count() == 1
