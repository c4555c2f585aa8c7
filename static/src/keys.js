// The keys of all pages: they move through the rows of a table and turn its pages, search, undo, and press what a page
// names by `data-page-action`. Which key does what stands in annotations/showing/keys.py. Ctrl+Enter sends a form.
import { copyForm } from "./forms.js";
import { pressSend } from "./sending.js";
import { actionOf, isCtrlEnter, keyOf, READING, sayIgnored } from "./typing.js";

const TYPING = "input:not([type=checkbox], [type=radio]), textarea, select, [contenteditable], .cm-editor";

// A row that only goes on with the one above it, or says that there is none, cannot have the focus.
const rows = () =>
  [...document.querySelectorAll("table[data-rows] > tbody > tr[tabindex]")].filter((row) => row.offsetParent);
const currentRow = () => document.activeElement?.closest?.("table[data-rows] > tbody > tr");

function focusRow(row) {
  if (!row) return;
  row.focus({ preventScroll: true });
  row.scrollIntoView({ block: "nearest" });
}

function moveBy(step) {
  const all = rows();
  const at = all.indexOf(currentRow());
  focusRow(at < 0 ? all[step > 0 ? 0 : all.length - 1] : all[at + step]);
}

function open(row) {
  (row.querySelector("a.row-link") ?? row.querySelector("a[href]"))?.click();
}

function search() {
  (document.querySelector("[data-search]") ?? document.querySelector("main input[type=search]"))?.focus();
}

function dialog(isOpen) {
  const keys = document.getElementById("keys");
  if (isOpen) keys?.showModal();
  else keys?.close();
}

const turn = (direction) => document.querySelector(`main a[rel=${direction}]`)?.click();

const actions = {
  next: () => moveBy(1),
  previous: () => moveBy(-1),
  next_page: () => turn("next"),
  previous_page: () => turn("prev"),
  search,
  keys: () => dialog(true),
  copy: () => copyForm(currentRow()?.querySelector("[data-form]") ?? document.querySelector("[data-tools]")),
};

// A decision that comes sooner is about the page before: nobody has read this one yet.
const DECISIONS = ["accept", "reject"];
const shownAt = performance.now();

// What a page has for an action: a button or a link is pressed, a field gets the focus.
function onThePage(action) {
  const element = action && document.querySelector(`[data-page-action="${action}"]`);
  if (!element) return null;
  return () => (element.matches("input, textarea") ? element.focus() : element.click());
}

/** Whether a key belongs to a field or a dialog, and is no command. */
export const isTyping = (event) => Boolean(event.target.closest(TYPING) || document.querySelector("dialog[open]"));

function onKey(event) {
  const key = keyOf(event);
  if (event.defaultPrevented || !key) return;
  if (key === "Escape" && event.target.matches("input[type=search]") && !event.target.closest("details")) {
    event.preventDefault(); // a browser would empty it
    event.target.blur();
  }
  if (isTyping(event)) return;
  const action = actionOf(event);
  const ofPage = onThePage(action);
  if (action === "open" && event.target === currentRow()) {
    event.preventDefault();
    open(event.target);
  } else if (action === "tick" && currentRow()?.querySelector("input[type=checkbox]")) {
    currentRow().querySelector("input[type=checkbox]").click();
  } else if (ofPage) {
    event.preventDefault();
    if (DECISIONS.includes(action) && performance.now() - shownAt < READING) sayIgnored(event);
    else if (!event.repeat) ofPage();
  } else if (Object.hasOwn(actions, action)) {
    event.preventDefault();
    actions[action]();
  }
}

/** Ctrl+Enter, with Shift or without, presses the button of the form that says so; an editor does it by itself.
 * Outside of any form it is the one that the page is about. */
function onSend(event) {
  // A key that is held down sends one form, not the next one too.
  if (event.defaultPrevented || event.repeat || !isCtrlEnter(event)) return;
  const ofPage = document.querySelector("body:not(:has(dialog[open])) form[data-keys-of-page]");
  const form = event.target.form ?? ofPage;
  if (pressSend(form, event.shiftKey)) event.preventDefault();
}

document.addEventListener("keydown", onKey);
document.addEventListener("keydown", onSend);
document.addEventListener("click", (event) => {
  if (event.target.closest("[data-keys-open]")) dialog(true);
  const tick = event.target.closest("[data-tick-all]");
  if (tick) for (const box of document.getElementsByName(tick.dataset.tickAll)) box.checked = true;
  if (event.target.closest("[data-keys-close]") || event.target.id === "keys") dialog(false);
});
