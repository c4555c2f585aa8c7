"""Ways to join three commands, and talk around one or none: written before the cutter was first asked."""

from __future__ import annotations

WAYS = (
    # formal
    "I have three assignments for you. Your initial assignment: {0}. The subsequent assignment is as follows: {1}. "
    "The concluding assignment would be to {2}.",
    "Would you be so kind as to {0}? Having accomplished that, kindly {1}. To conclude, {2}.",
    "Item one: {0}. Item two: {1}. Item three: {2}.",
    "Instruction no. 1: {0}; instruction no. 2: {1}; instruction no. 3: {2}.",
    "It would be great to have you {0}. I would also appreciate it a lot to see you {1}. Lastly, I must ask you to {2}.",
    "In the first place {0}, in the second place {1}, in the last place {2}.",
    "We would like three services: the first would be to {0}, the second would be to {1}, the third would be to {2}.",
    "Before anything else, {0}. Straight afterwards, {1}. Ultimately, {2}.",
    # lists
    "(a) {0} (b) {1} (c) {2}",
    "a) {0}, b) {1}, c) {2}",
    "- {0}\n- {1}\n- {2}",
    "* {0}\n* {1}\n* {2}\n",
    "#1 {0} #2 {1} #3 {2}",
    "I) {0} II) {1} III) {2}",
    "Step 1. {0}. Step 2. {1}. Step 3. {2}.",
    "1: {0} 2: {1} 3: {2}",
    "To-do list: {0}; {1}; {2}",
    "{0} / {1} / {2}",
    "{0} | {1} | {2}",
    "{0} -> {1} -> {2}",
    "{0}... {1}... {2}...",
    "Agenda for today – {0} – {1} – {2}",
    # childish
    "and first you have to {0} and then you have to {1} and then and then you have to {2}",
    "okay so um you gotta {0} and after you did it you gotta {1} and last you gotta {2}",
    "robot my first thing is {0} my other thing is {1} and my very last thing is {2}",
    "You know what, {0}! And you know what else, {1}! And guess what, {2}!",
    # speech without signs
    "{0} {1} {2}",
    "task number one {0} task number two {1} task number three {2}",
    "first up {0} next up {1} and to finish off {2}",
    "the first one is {0} the second one is {1} and the third one is {2}",
    "{0} and when you come back {1} and when you come back again {2}",
    "my number one priority is {0} my number two priority is {1} and number three {2}",
    # British and American
    "Right then, {0}. Once you've got that sorted, {1}. Oh, and one more thing: {2}.",
    "Hey buddy, I'm gonna need you to {0}. Next thing on the list: {1}. And for the grand finale, {2}.",
    "Alrighty, here's the deal: {0}, {1}, and {2}. Got it?",
    "Hang on a tick... okay: {0}. Now: {1}. And now: {2}. Cheers!",
    "Let's get started, {0}. With that out of the way, {1}. By way of a finish, {2}.",
    # statements and requests
    "My wishes are these. {0}. {1}. {2}. Thank you, that is all.",
    "What I want is three things. Number one is {0}. Number two is {1}. Number three is {2}. Off you go!",
    "Begin with this: {0}. Carry on with this: {1}. Finish with this: {2}.",
    "Listen carefully. Job A is {0}. Job B is {1}. Job C is {2}.",
    "Please {0}. Please {1}. Please {2}.",
    "Could you {0}, could you {1} and could you {2}?",
    "{0}, then please {1}, then please {2}",
)

# What is said → the commands in it that may be acted on, and those of its pieces that may not, in order.
TALK = {
    "bring me the cocoa. Don't go to the galley.": ["bring me the cocoa"],
    "Bring me the cocoa and do not go to the galley": ["bring me the cocoa"],
    "don't bring me the cocoa, find the quince in the galley": [],
    "Never mind the cocoa. Find the quince in the galley. Greet Maria in the lobby.": [
        "find the quince in the galley",
        "greet Maria in the lobby",
    ],
    "if Maria is in the lobby, bring me the cocoa. Find the quince in the galley.": [
        "find the quince in the galley"
    ],
    "find the quince in the galley. Bring me the cocoa unless Maria has it.": [
        "find the quince in the galley"
    ],
    "find the quince in the galley, and bring me the cocoa if it is cold": [],
    "bring me the cocoa. Actually, forget it. Find the quince in the galley.": [
        "find the quince in the galley"
    ],
    "bring me the cocoa. No, cancel that. Find the quince in the galley.": [
        "find the quince in the galley"
    ],
    "instead of bringing me the cocoa, find the quince in the galley": [],
    "I wonder whether you could tell me a joke about how to find the quince in the galley": [],
    "I wonder how people find the quince in the galley and how they greet Maria in the lobby": [],
    "she told me to find the quince in the galley and he told me to greet Maria in the lobby": [],
    "Why did you bring me the cocoa? Why did you find the quince in the galley?": [],
    "how do I find the quince in the galley and how do I greet Maria in the lobby": [],
    "bring me the cocoa and open the window and greet Maria in the lobby": [
        "bring me the cocoa",
        "greet Maria in the lobby",
    ],
    "bring me the cocoa, then turn off the lights, then greet Maria in the lobby": [
        "bring me the cocoa",
        "greet Maria in the lobby",
    ],
    "find the quince in the galley. Bring the flurb to Maria. Greet Otto in the lobby.": [
        "find the quince in the galley",
        "greet Otto in the lobby",
    ],
    "find the quince in the galley. Bring me the flurb. Greet Otto in the lobby.": [
        "find the quince in the galley",
        "greet Otto in the lobby",
    ],
    "bring me the cocoa for my grandmother and greet Maria in the lobby": [
        "greet Maria in the lobby"
    ],
    "bring me the cocoa that stands beside the ladle and greet Maria in the lobby": [
        "greet Maria in the lobby"
    ],
    "Command one: bring me the cocoa": ["bring me the cocoa"],
    "My first and only task for you is: bring me the cocoa.": ["bring me the cocoa"],
    "1. bring me the cocoa": ["bring me the cocoa"],
    "yesterday my sister said that you bring me the cocoa": [],
    "I have three things for you.": [],
    "the weather is lovely today, is it not?": [],
    "what a day. I am so tired. Goodbye.": [],
    "": [],
    "...": [],
    "!?": [],
    "everybody loves the cocoa in the galley": [],
    "you should have seen how Maria was waving in the lobby": [],
}
