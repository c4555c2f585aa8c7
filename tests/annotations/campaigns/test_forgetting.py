"""What a contributor wrote is nowhere once they are forgotten: a word is planted in each text that belongs to them,
and looked for in every text of the database, in the archive of the world and in a backup.

Models and columns are asked of the site itself: whatever refers to what they wrote is planted too.
"""

from __future__ import annotations

import json
import logging
import zipfile

from django.db import models

from annotations.campaigns.answering import save_answer
from annotations.campaigns.closing import forget
from annotations.campaigns.moderation import accept, mend
from annotations.campaigns.tasks import begin
from annotations.editing.commenting import SUBJECTS, add_comment, change_comment
from annotations.editing.drafts import save_draft
from annotations.editing.edits import change, delete
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import refill
from annotations.models import Comment, Contributor, Draft, Job, Origin, Paraphrase, Utterance
from annotations.models.campaigns import SubmissionKind
from annotations.rows.history import history_of
from gpsr_site.backup.backup_tables import tables
from gpsr_site.backup.backup_writing import write_backup
from tests.annotations.exchange.packing import members_of, pack
from tests.doubted_labels import doubt
from tests.gpsr_site.backup.limits import fill_every_column
from tests.launched_campaigns import small_campaign

WORD = "quxzotl"
WRITTEN = (models.CharField, models.TextField, models.JSONField, models.BinaryField)


def where_it_stands() -> set[str]:
    """The columns in which the word stands."""
    return {
        f"{table.name}.{column.name}"
        for table in tables()
        for column in table.fields
        if isinstance(column, WRITTEN)
        for value in table.model._base_manager.values_list(column.attname, flat=True)
        if WORD in text_of(value)
    }


def text_of(value: object) -> str:
    if isinstance(value, bytes | memoryview):
        return bytes(value).decode("latin-1")
    return json.dumps(value, ensure_ascii=False)


def test_no_column_of_what_refers_to_them_keeps_a_word(db):
    fill_every_column()
    theirs: set[type[models.Model]] = {Contributor, Paraphrase, Utterance}
    pending = list(theirs)
    while pending:
        for relation in pending.pop()._meta.related_objects:
            if relation.on_delete is models.CASCADE and relation.related_model not in theirs:
                theirs.add(relation.related_model)
                pending.append(relation.related_model)
    planted = 0
    for model in {*theirs, *(history_of(each).model for each in (Paraphrase, Utterance))}:
        for column in model._meta.concrete_fields:
            is_free = isinstance(column, WRITTEN[:3]) and not column.choices
            if is_free and getattr(column, "max_length", None) in (None, *range(30, 9_999)):
                value = [WORD] if isinstance(column, models.JSONField) else WORD
                model._base_manager.filter(pk=1).update(**{column.name: value})
                planted += 1
    for each in (Paraphrase, Utterance):
        history_of(each).filter(pk=1).update(id=1)
    for number, kind in ((1, "paraphrase"), (2, "utterance")):
        Comment.objects.filter(pk=number).update(kind=kind, subject=1, about=WORD, text=WORD)
        Draft.objects.filter(pk=number).update(kind=kind, subject="1-x", fields=[WORD], about=WORD)
    Comment.objects.filter(pk=1).update(world=1)
    assert planted > 40 and len(where_it_stands()) > 40
    forget(Contributor.objects.get(pk=1))
    assert not where_it_stands()


def test_a_word_of_theirs_is_nowhere(db, world, admin, annotator, tmp_path, caplog):
    caplog.set_level(logging.DEBUG)
    campaign = small_campaign(world)
    one = begin(campaign, "one")
    for place in one.submissions.order_by("position"):
        save_answer(place, f"{WORD} is {place.position}")
    mend(one.submissions.filter(kind=SubmissionKind.REWRITE).first(), f"{WORD} mended")
    assert accept(list(one.submissions.all()), admin) == 3
    paraphrase = one.paraphrases.first()
    said = one.submissions.get(kind=SubmissionKind.FREE).utterance
    for row, name in ((paraphrase, "paraphrase"), (said, "utterance")):
        comment = add_comment(world, SUBJECTS[name], row, f"Who says {WORD}? @adam", annotator)
        change_comment(comment, f"{WORD}!", comment.version)
        values = {
            "fields": {"text": WORD},
            "device": "x",
            "base_version": 1,
            "about": WORD,
            "page": "",
        }
        save_draft(annotator, world, name, str(row.pk), values)
    paraphrase = change(paraphrase, {"utterance": f"{WORD} changed"}, admin, paraphrase.version)
    store_findings(world, [doubt(paraphrase)])
    delete(one.paraphrases.last(), admin, 1)
    collect(world, [f"{WORD} mended", paraphrase.utterance], Origin.REVIEW, annotator)
    refill(world)
    assert len(where_it_stands()) > 12
    forget(one)
    assert not where_it_stands()
    archive = members_of(pack(world))
    write_backup(tmp_path / "one.zip")
    with zipfile.ZipFile(tmp_path / "one.zip") as backup:
        texts = [*archive.values(), *(backup.read(name) for name in backup.namelist())]
    assert not any(WORD.encode() in text for text in texts)
    assert WORD not in caplog.text
    assert not Job.objects.filter(world=world, report__icontains=WORD).exists()
