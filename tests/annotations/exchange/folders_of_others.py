"""Folders of generators in the styles that repositories have, written for these tests: path → text.

Each has what its year or team is known for: the names of its files, its headings, its wildcards, and what
stands beside its grammars.
"""

from __future__ import annotations

OBJECTS = """<?xml version="1.0" encoding="utf-8"?>
<!--
  An example for trying the generator.
//-->
<categories>
  <category name="tools" defaultLocation="workbench" room="garage">
    <object name="hammer" difficulty="easy" />
    <object name="pipe wrench" type="known" />
    <object name="nail's box" type="special" twoHands="true" canPlaceIn="true" />
  </category>
  <category name="berries" defaultLocation="counter" room="kitchen">
    <object name="gooseberry" type="alike" difficulty="moderate" fruit="true" />
  </category>
  <category name="berries" defaultLocation="shelf" room="garage">
    <object name="cranberry" type="alike" canPour="true" />
  </category>
</categories>
"""
LOCATIONS = """<?xml version="1.0" encoding="utf-8"?>
<rooms>
  <room name="garage">
    <location name="workbench" isPlacement="true" />
    <location name="shelf" isPlacement="true" isBeacon="true" />
  </room>
  <room name="kitchen"><location name="counter" isPlacement="true" isBeacon="true" />
    <location name="stool" isPlacement="false" isBeacon="true" /></room>
</rooms>"""
NAMES = """<?xml version="1.0" encoding="utf-8"?>
<names>
  <name>Robin</name>
  <name>Kim</name>
  <name gender="Male">Robin</name>
</names>


"""
GESTURES = '<gestures>\n  <gesture name="nodding" difficulty="easy" />\n</gestures>\n'
QUESTIONS = """<questions>
  <question><q>How many legs has a spider?</q><a>EIGHT</a></question>
  <question>
    <q>What's the colour of "snow"?</q>
    <a>WHITE (mostly)</a></question>
</questions>"""

RULE = "#" * 40
FORMAT = """/*******************************
*
* FORMAT
*
* ; load   some/where/else.txt
* ; import some/where/else.txt as $part
* {wildcard [type] [id] [meta:[metadata]]}
*
*******************************/

"""
HEADER = f"{RULE}\n#\n# ${{GrammarName}} Grammar\n#\n# NO RECURSIVE rules.\n{RULE}\n"
ONTOLOGY = {
    "Objects.xml": OBJECTS,
    "Locations.xml": LOCATIONS,
    "Names.xml": NAMES,
    "Gestures.xml": GESTURES,
    "Questions.xml": QUESTIONS,
}

IN_2015 = {
    **{f"Resources/{name}": text for name, text in ONTOLOGY.items()},
    "Resources/FormatSpecification.txt": FORMAT,
    "Resources/Category1Grammar.txt": f"""; grammar name Category I

$Main\t\t= $complex\x20
; $complex\t= $look and wave
$complex\t= $fetch and $hand
$complex\t= $walk

{RULE}
#
# Parts
#\x20
{RULE}
$fetch\t\t= $take the {{kobject}} from the {{location placement 1}}
$hand\t\t= pass it to $whom
$whom\t\t= me
$whom\t\t= {{name}} (at | in | which is in) the {{room}}
$whom\t\t= the {{placement 2}}
$walk\t\t= walk to the {{location beacon}}, count the ({{category}} | {{aobject}})
$walk\t\t= walk {{void meta: Robot must go to {{room 1}}}}
$take\t\t= take | grab{{void meta:Somebody stands between}} | pick up
""",
    "Resources/Category2Grammar.txt": "; grammar name Category II\n; grammar tier Moderate",
    "Resources/CountGrammar.txt": (
        "; grammar name Count\n\n$Main  = $count\n$count = count the $what and report to $whom\n"
        "$what  = objects | {category} | {aobject}\n$whom  = me | ({name} (at | in) the {room})"
    ),
}
IN_2016 = {
    **{f"CommonFiles/{name}": text for name, text in ONTOLOGY.items()},
    "CommonFiles/GrammarHeader.txt": HEADER,
    "GPSRCmdGen/Resources/Category1Grammar.txt": (
        "; grammar name Category I\n; grammar tier Easy\n\n$Main = $bring\n"
        "$bring = bring (me | to $whom) the {kobject?} from the {placement}\n$whom = {name} in the {beacon 1}\n"
        "$bring = tell me {question?} and your team's (name | country)\n"
    ),
    "EEGPSRCmdGen/Resources/eegpsr_cat5.txt": (
        "; grammar name Cat5 - People & Places\n; grammar tier High\n \n$Main = $polite $greet.\n"
        "$greet\t= Meet {male} at the {beacon 1}, then (greet | find) him\n"
        "$greet\t= Meet {female} {void meta:There is one person at {beacon 1}}\n"
        "$greet = count the people wearing a $colour-ish $top\n$colour = red | gray\n$top = (T-shirt) | coat\n"
        "$polite = {void} | Please\n"
    ),
}
IN_2017 = {
    **{f"CommonFiles/{name.upper()}": text for name, text in ONTOLOGY.items()},
    "CommonFiles/FormatSpecification.txt": FORMAT,
    "Resources/eegpsr_cat3e.txt": """; grammar name Category III - Objects (with faults)
; grammar tier High

$Main     = $task | ($polite $task)
; $task   = $unused
$task     = tell $whoE how many $what are on the {placement 1}
$task     = bring some {object where Category="berries" canPour=true} in a {object where canPlaceIn=true}
$task     = take the {category}'s $side item to the {placement 2 meta: a) move the (heavy) chair, b) wait }
$task     = say something {void meta: When asked, reply: "$reply" }
$whoE     = {name 1 meta:{name 1} is at the {beacon 3}} at the {beacon 2})
$what     = ({category} items) | $side ( {object} | {category} objects )
$side     = left | middle bottom
$reply    = a joke | the time
$later    =
#$side    = right
$polite   = Could you
""",
    "Resources/eegpsr_cat3i.txt": (
        "; grammar name Category III (incomplete)\n; grammar tier Moderate\n$Main = $find. | $polite $find.\n"
        "$find = find {name meta: {pron sub} is (sitting | standing ). Place three people there}\n"
        "$find = get the {aobject? meta: Place to } and guide {pron} to the ( {room} | {beacon} | exit )\n"
        "$polite = Please\n"
    ),
}
IN_2018 = {
    **{f"CommonFiles/{name}": text for name, text in ONTOLOGY.items()},
    "GPSRCmdGen/Resources/CommonRules.txt": (
        "#\n# This file has no main. Import it with:\n# ; import common.txt\n#\n; grammar name Common\n"
        "$deliver  = $vbplace the $object on the {placement 2}\n$vbplace  = put | place\n$spare = {sobject}\n"
    ),
    "GPSRCmdGen/Resources/Category2Grammar.txt": (
        "; grammar name Category II\n; grammar tier Moderate\n; import common.txt\n\n$Main = $deliver | $pdeliver\n"
        '$pdeliver = please $deliver\n$object = {kobject} | {object 1 where Type = "special"}\n'
    ),
    "GPSRCmdGen/Resources/Category3Grammar.txt": (
        "; grammar name Category III\n; grammar tier High\n; import common.txt\n\n"
        "$Main = $fllow | $deliver\n$object = tray\n"
        "$fllow = follow {name 1 meta: {name 1} is at the {beacon 1}} past the {Placement 2} to {pron pos} car\n"
    ),
}

# A team that glues kinds and ids together and keeps notes about the grammar in the same folder.
TEAM_WITH_NOTES = {
    **ONTOLOGY,
    "gpsr.txt": (
        "\ufeff; grammar name Ours\r\n$Main = bring {object1} to {beacon2}\r\n"
        "$Main = swap {kobject1} and {kobject2} in the {room1 meta: not {room2}}\r\n"
        '$Main = get the {object1 where Category="{category 1}"} there)\r\n'
    ),
    "notes.txt": (
        "what is odd about the grammar\n\nwhere is a plum //a or the?\n**go after sounds bad\n"
        "$follow = (go | come) after\n$bad = $warn take the {planet 2}\n/* never done\n"
    ),
    "bugs.txt": "1) the third (of four rules fails\n",
    "README.md": "# Ours\n",
    "README.txt": "$Main = this is how a rule looks\n",
    "requirements.txt": "numpy==1.14.0\nlark-parser>=0.6 # of 2018\n",
}
# A team with templates, slot-filling rules and the notation of both in the folder of the generator.
TEAM_WITH_TEMPLATES = {
    **{name.lower(): text for name, text in ONTOLOGY.items()},
    "common_rules.txt": "$vbfind = find | spot\n",
    "ours_category_1_grammar.txt": (
        "; import common.txt\n$Main = $vbfind the {object} and {object1} in the {room?}\n$Main = greet {name}\n"
    ),
    "ours_category_1_semantics.txt": (
        "# pattern = form\n$vbfind the {object} and {object1} in the {room?} = "
        "(find (λ$1:e (is_a $1 {object}) (near $1 {object1}) (at $1 {room?})))\ngreet {name} = (greet {name})\n"
    ),
    "ours_category_1_slot.txt": (
        "#$Main = $vbfind\n$vbfind the {object} = $vbfind O B-OBJECT\n$deliver = {deliver} $deliver\n"
    ),
    "common_rules_slot.txt": "{room} = ROOM\n",
    "ours_category_2_semantics.txt": "",
    "grammar_ebnf.txt": 'start: (rule)*\nrule: "$" /[a-z]+/ "=" expansion\n',
    "categories.txt": "name plural, name singular\ntools , tool\nberries, berry\n",
    "whattosay.txt": "a joke\nthe time\n",
    "paraphrasings.txt": 'spot a hammer\nfind the hammer\n( find ( " hammer " ) )\n',
}
# A team whose releases lie beside each other, with pairs for training among them.
TEAM_WITH_RELEASES = {
    "errands.txt": "$Main = visit the {room}\n",
    **ONTOLOGY,
    "2016/Objects.xml": OBJECTS.replace("hammer", "saw"),
    "2016/Locations.xml": LOCATIONS,
    "gen/Train.txt": 'visit the <room>\n( go " <room> " )\n',
    "release-notes.txt": "Release 2\n=========\n* rooms have names; doors = closed\n",
}
FOLDERS = {
    "2015": IN_2015,
    "2016": IN_2016,
    "2017": IN_2017,
    "2018": IN_2018,
    "a team with notes": TEAM_WITH_NOTES,
    "a team with templates": TEAM_WITH_TEMPLATES,
    "a team with releases": TEAM_WITH_RELEASES,
}
