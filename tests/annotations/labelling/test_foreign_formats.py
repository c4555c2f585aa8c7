"""Files of other programs: their utterances are taken out, or they are refused by name; never stored line by line."""

from __future__ import annotations

import json
from contextlib import suppress

import pytest

from annotations.labelling.upload_reading import read_upload
from annotations.language.texts.errors import LanguageError
from tests.timing import least_seconds

SAID = ["bring me the red cup", "go to the kitchen"]

TAKEN = {
    "Rasa YAML": 'version: "3.1"\n\nnlu:\n- intent: bring\n  examples: |\n    - bring me the [red cup](object)\n'
    '- synonym: cup\n  examples: |\n    - mug\n- intent: go\n  examples: |\n    - go to the [kitchen]{"entity": "room"}'
    "\n- regex: zip\n  examples: |\n    - \\d{5}\n- lookup: rooms\n  examples: |\n    - study\n",
    "Rasa YAML with texts": "nlu:\n- intent: bring\n  examples:\n  - text: |\n      bring me the red cup\n"
    "    metadata:\n      sentiment: neutral\n  - text: go to the kitchen\n",
    "Rasa Markdown": "## intent:bring\n- bring me the [red cup](object) <!-- hm -->\n\n## synonym:cup\n- mug\n\n"
    "## intent:go\n* go to the [kitchen](room:kitchen)\n## regex:zip\n- [0-9]{5}\n",
    "snips YAML": "---\ntype: intent\nname: bring\nslots:\n  - name: object\n    entity: object\nutterances:\n"
    "  - bring me the [object:object](red cup)\n  - go to the [room](kitchen)\n",
    "snips JSON": json.dumps(
        {
            "intents": {
                "bring": {
                    "utterances": [
                        {"data": [{"text": "bring me the "}, {"text": "red cup", "entity": "o"}]}
                    ]
                },
                "go": {"utterances": [{"data": [{"text": "go to the kitchen"}]}]},
            },
            "language": "en",
        }
    ),
    "the data set of snips": json.dumps(
        {"Go": [{"data": [{"text": "bring me the "}, {"text": "red cup", "entity": "o"}]},
                {"data": [{"text": "go to the "}, {"text": "kitchen", "entity": "r"}]}]}
    ),
    "SubRip": "1\n00:00:01,000 --> 00:00:02,500\nbring me\nthe <i>red</i> cup\n\n2\n00:00:03,000 --> 00:00:04,000\n"
    "- go to the kitchen\n",
    "WebVTT": "WEBVTT\n\nNOTE from a camera\n\ncue-1\n00:01.000 --> 00:02.500 align:start\n<v Ann>bring me the red cup"
    "\n\n00:03.000 --> 00:04.000\ngo to the kitchen\n\n",
    "CoNLL 2003": "-DOCSTART- -X- O O\n\nbring VB O O\nme PRP O O\nthe DT O O\nred JJ I-NP B-obj\ncup NN I-NP I-obj\n\n"
    "go VB O O\nto TO O O\nthe DT O O\nkitchen NN O B-room\n",
    "BIO with tabs": "bring\tO\nme\tO\nthe\tO\nred\tB-obj\ncup\tI-obj\n\ngo\tO\nto\tO\nthe\tO\nkitchen\tB-room\n",
    "CoNLL-U": "# sent_id = 1\n# text = bring me the red cup\n"
    + "".join(f"{n}\t{w}\t_\t_\t_\t_\t0\t_\t_\t_\n" for n, w in enumerate(SAID[0].split(), 1))
    + "\n"
    + "".join(f"{n}\t{w}\t_\t_\t_\t_\t0\t_\t_\t_\n" for n, w in enumerate(SAID[1].split(), 1)),
    "Kaldi": "spk1_utt001 bring me the red cup\nspk1_utt002 go to the kitchen\n",
    "Prodigy": "\n".join(
        json.dumps({"text": text, "_input_hash": 1, "answer": answer})
        for text, answer in [*zip(SAID, ["accept"] * 2, strict=True), ("no", "reject"), ("x", "ignore")]
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", TAKEN)
@pytest.mark.parametrize("end", ["", "\n\n"])
def test_utterances_are_taken_out(kind, end):
    sheet = read_upload(TAKEN[kind] + end)
    assert [row.values[sheet.column] for row in sheet.records] == SAID
    assert not sheet.problems and sheet.is_column_sure
    lines = TAKEN[kind].split("\n")
    if "snips JSON" not in kind and "data set" not in kind:
        assert SAID[1].split()[0] in lines[sheet.records[1].line - 1]


REFUSED = {
    "brat": "T1\tObject 13 20\tred cup\nT2\tRoom 30 37\tkitchen\nR1\tIn Arg1:T1 Arg2:T2\n",
    "utt2spk": "spk1_utt001 spk1_a1\nspk1_utt002 spk1_a1\n",
    "wav.scp": "spk1_utt001 /data/a.wav\nspk1_utt002 /data/b.wav\n",
    "TextGrid": 'File type = "ooTextFile"\nObject class = "TextGrid"\n\nxmin = 0\n',
    "Rasa stories": 'version: "3.1"\nstories:\n- story: happy\n  steps:\n  - action: utter\n',
    "Rasa domain": "intents:\n  - greet\n  - bye\nresponses:\n  utter_greet:\n  - text: Hey\n",
    "a workflow": "name: CI\non:\n  push:\n    branches: [main]\njobs:\n  test:\n    runs-on: x\n",
    "HTML": "<!DOCTYPE html><html><body>bring me the cup</body></html>",
    "XML": "<?xml version='1.0'?><a><b>bring</b></a>",
}


@pytest.mark.parametrize("kind", REFUSED)
def test_what_has_no_utterances_is_refused_by_name_and_says_what_to_do(kind):
    with pytest.raises(LanguageError) as refusal:
        read_upload(REFUSED[kind], "x")
    assert refusal.value.hint and refusal.value.position.source == "x"


PLAIN = [
    "Commands:\n- bring me the red cup\n- go to the kitchen",
    "user: bring me the cup\nrobot: here it is\nuser: thanks",
    "[10:32] Ann: bring me the cup\n[10:33] Bob: no",
    "2-liter bottle please\nbring me the cup",
    "go to A-1 and B-2\nI said O\nB-room is closed",
    "at 10:30 go to the kitchen\nat 11:30 come back",
    "## to do\nbring me the cup",
    "[cup](object) is what I want\nbring it",
]


@pytest.mark.parametrize("text", PLAIN)
def test_what_people_say_stays_plain_text(text):
    sheet = read_upload(text)
    assert sheet.format == "text"
    assert [row.values["text"] for row in sheet.records] == text.split("\n")


FORM = "[IN:GET_OBJECT bring me the [SL:OBJECT red cup ] ]"
TABLES = {
    "MASSIVE": (["id", "intent", "utt", "annot_utt"], ["7", "bring", "{}", "{} [object : cup]"], "utt"),
    "TOP": (["domain", "utterance", "semantic_parse"], ["home", "{}", FORM], "utterance"),
    "form first": (["semantic_parse", "sentence"], [FORM, "{}"], "sentence"),
    "commands are forms": (["command", "transcript"], ['(bring "cup {}")', "{}"], "transcript"),
    "no known name": (["a", "b", "c"], ["bring_object", "{}", f"{FORM} {{}}"], "b"),
    "labels": (["note", "what"], ["a rather long note on the recording", "{}"], "what"),
}  # fmt: skip


@pytest.mark.parametrize("kind", TABLES)
@pytest.mark.parametrize("as_json", [False, True])
def test_the_column_is_chosen_by_its_head_and_by_its_sentences(kind, as_json):
    head, cells, column = TABLES[kind]
    rows = [[cell.replace("{}", text) for cell in cells] for text in (*SAID, "take the cup away")]
    if as_json:
        text = "\n".join(json.dumps(dict(zip(head, row, strict=True))) for row in rows)
        assert read_upload(text).column == column
    else:
        text = "\n".join("\t".join(row) for row in [head, *rows])
        assert read_upload(text, has_head=True).column == column


def test_two_megabytes_of_each_format_cost_seconds_at_most():
    for text in (*TAKEN.values(), "[" * 50, "- [a](", "{\\ ", "<" * 40):
        long = (text + "\n\n") * (100_000 // len(text))

        def read(long=long):
            with suppress(LanguageError):
                read_upload(long)

        assert least_seconds(read) < 1.5
