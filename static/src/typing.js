// Which keys are commands, and which belong to what somebody types. Every shortcut asks here.
export const TYPING = "input, textarea, select, [contenteditable], .cm-editor";

/** Milliseconds: whoever presses a key sooner after something new is shown has not read it. */
export const READING = 250;

const BESIDE_DIGITS = { Minus: "-", Equal: "=" };

// Part of a composition is the Enter that chooses a word of an input method, and the Escape that closes its list.
// (Safari reports that Enter with the code 229.)
const isComposing = (event) => event.isComposing || event.keyCode === 229;

/**
 * The key as commands know it, such as "j", "1", "?" or "Enter"; empty for one of the browser or of a composition.
 *
 * A letter counts by what is printed on its key, whatever Caps Lock says, and where another alphabet is printed
 * there, by its place on a Latin keyboard. Digits count by their place: on AZERTY "&" is 1. With Shift a letter is
 * a capital one, and other keys are what they write.
 */
export function keyOf(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || isComposing(event)) return "";
  const { key = "", code = "", shiftKey } = event;
  const digit = /^Digit(\d)$/.exec(code);
  if (digit && !shiftKey) return digit[1];
  if (/^[a-z]$/i.test(key)) return inCase(key, shiftKey);
  const letter = /^Key([A-Z])$/.exec(code);
  if (letter && !/^[ -~]$/.test(key)) return inCase(letter[1], shiftKey);
  if (!shiftKey && !/^[-=/?]$/.test(key)) return BESIDE_DIGITS[code] ?? key;
  return key;
}

let actions; // key → what it does, on every page (annotations/showing/keys.py)

/** What a key does, by its name in the one table of keys; empty where it does nothing. */
export function actionOf(event) {
  actions ??= JSON.parse(document.getElementById("keys")?.dataset.actions ?? "{}");
  const key = keyOf(event);
  return Object.hasOwn(actions, key) ? actions[key] : "";
}

const IGNORED_MS = 3000;

/** Say that a key was not taken, since it came before anybody can have read what it would be about. */
export function sayIgnored(event) {
  const note = document.querySelector("[data-key-ignored]");
  if (!note) return;
  note.textContent = `${keyOf(event)} came too soon. Press it again.`;
  clearTimeout(note.timer);
  note.timer = setTimeout(() => (note.textContent = ""), IGNORED_MS);
}

const inCase = (letter, isCapital) => (isCapital ? letter.toUpperCase() : letter.toLowerCase());

/** Whether a key writes this character: also with AltGr, where a keyboard has it there. */
export const writes = (event, character) => event.key === character && !isComposing(event);

/** Whether this is Enter with Ctrl, or with the command key of a Mac, and no part of a composition. */
export const isCtrlEnter = (event) =>
  event.key === "Enter" && (event.ctrlKey || event.metaKey) && !isComposing(event);
