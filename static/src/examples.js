// The lines of the page By example: [ puts brackets around what is selected, and what the server has made of the lines
// after a correction takes their place, so that the undo of the browser brings them back.
import { isCtrlEnter, writes } from "./typing.js";

/** Put `text` into the place between two positions of a field, as if somebody typed it. */
function write(field, start, end, text) {
  field.focus({ preventScroll: true });
  field.setSelectionRange(start, end);
  const isDone = text ? document.execCommand("insertText", false, text) : document.execCommand("delete");
  if (isDone) return;
  field.setRangeText(text, start, end, "end");
  field.dispatchEvent(new Event("input", { bubbles: true }));
}

/** Make the text of a field another one by changing what differs alone. */
function rewrite(field, text) {
  const before = field.value;
  let start = 0;
  while (start < Math.min(before.length, text.length) && before[start] === text[start]) start += 1;
  let end = 0;
  const most = Math.min(before.length, text.length) - start;
  while (end < most && before.at(-1 - end) === text.at(-1 - end)) end += 1;
  if (before === text) return;
  const focused = document.activeElement;
  write(field, start, before.length - end, text.slice(start, text.length - end));
  if (focused !== document.body) focused.focus({ preventScroll: true });
}

/** The word around a position, where nothing is selected. */
function selected(field) {
  let { selectionStart: start, selectionEnd: end } = field;
  if (start !== end) return [start, end];
  const text = field.value;
  const isWord = (letter) => letter !== undefined && !/[\s[\]]/.test(letter);
  while (isWord(text[start - 1])) start -= 1;
  while (isWord(text[end])) end += 1;
  return [start, end];
}

function mark(field) {
  let [start, end] = selected(field);
  const text = field.value;
  while (end > start && /\s/.test(text[end - 1])) end -= 1;
  while (start < end && /\s/.test(text[start])) start += 1;
  const chosen = text.slice(start, end);
  if (chosen && !/[[\]\n]/.test(chosen)) write(field, start, end, `[${chosen}]`);
  else field.focus();
}

export function enhance(page) {
  const lines = page.querySelector("textarea[name=lines]");
  const said = page.querySelector("[data-examples-try] input[name=said]");
  page.querySelector("[data-mark]").addEventListener("click", () => mark(lines));
  lines.addEventListener("keydown", (event) => {
    if (!writes(event, "[") || lines.selectionStart === lines.selectionEnd) return;
    event.preventDefault();
    mark(lines);
  });
  said.addEventListener("keydown", (event) => {
    if (!isCtrlEnter(event) || event.repeat) return;
    event.preventDefault();
    if (said.value.trim()) page.querySelector("[data-examples-teach]").click();
  });
  // What was wrong with the lines when they were sent is no longer true of others.
  lines.addEventListener("input", () => {
    lines.removeAttribute("aria-invalid");
    lines.parentElement.querySelector(".errorlist")?.remove();
  });
  // The lines that come back with their proposal need no other one.
  let isRewriting = false;
  lines.form.addEventListener("input", () => isRewriting || lines.form.dispatchEvent(new Event("typed")));
  let begun = null; // what somebody writes in a field of the proposal while another proposal comes
  page.addEventListener("htmx:beforeSwap", () => {
    const field = document.activeElement;
    const isBegun = field.matches("#proposal input") && field.value !== field.defaultValue;
    begun = isBegun ? { label: field.ariaLabel, value: field.value } : null;
  });
  page.addEventListener("htmx:afterSwap", () => {
    const rewritten = page.querySelector("[data-rewritten]");
    if (rewritten) {
      rewritten.remove();
      isRewriting = true;
      rewrite(lines, rewritten.value);
      isRewriting = false;
    }
    const field = begun && page.querySelector(`#proposal input[aria-label="${CSS.escape(begun.label)}"]`);
    if (field && field.value === field.defaultValue) {
      field.value = begun.value;
      field.focus();
    }
  });
  // What is tried is first in the list, which asks for all of its answers.
  page.querySelector("[data-examples-try]").addEventListener("submit", (event) => {
    event.preventDefault();
    const text = said.value.trim();
    if (!text) return;
    const row = document.createElement("li");
    const sent = Object.assign(document.createElement("input"), { type: "hidden", name: "said", value: text });
    row.append(sent, text);
    page.querySelector("#tried > ul").prepend(row);
    said.value = "";
    page.querySelector("#tried").dispatchEvent(new Event("renew"));
  });
  page.addEventListener("htmx:afterRequest", (event) => {
    const { elt, successful } = event.detail;
    if (successful && elt.matches("[data-examples-teach]")) said.value = "";
  });
}
