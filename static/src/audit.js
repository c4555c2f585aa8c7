// The label audit by keyboard: the row that has the focus is shown, and one key decides about it.
import { enhanceBy } from "./modules.js";
import { actionOf, keyOf, READING, sayIgnored, TYPING } from "./typing.js";

const ROW = "tr[data-finding]";

const shown = () => document.getElementById("finding");
const rowShown = () => document.querySelector(`${ROW}[aria-current]`);
const isBusy = () => Boolean(document.querySelector("#list .htmx-request"));

let isListening = false;

/** Called for the page and again for each list that replaces the one before. */
export function enhance() {
  if (!isListening) {
    isListening = true;
    document.addEventListener("keydown", onKey, true); // before the keys of all pages
    document.addEventListener("focusin", onFocus);
  }
  if (document.activeElement === document.body) rowShown()?.focus({ preventScroll: true });
}

function focusRow() {
  rowShown()?.focus({ preventScroll: true });
  rowShown()?.scrollIntoView({ block: "nearest" });
}

function onFocus(event) {
  const row = event.target;
  if (!row.matches(ROW) || row.dataset.finding === shown()?.dataset.shown) return;
  rowShown()?.removeAttribute("aria-current");
  row.setAttribute("aria-current", "true");
  row.dispatchEvent(new CustomEvent("choose"));
}

async function openEditor() {
  const panel = shown()?.querySelector("[data-audit-write]");
  if (!panel) return;
  panel.open = true;
  const field = panel.querySelector("[data-editor-later]");
  if (field) {
    field.dataset.editor = field.dataset.editorLater;
    delete field.dataset.editorLater;
    await enhanceBy("editor", field);
  }
  panel.querySelector(".cm-content")?.focus();
}

function leaveField(event, key) {
  if (!shown()?.contains(event.target) || (event.target.id !== "audit-reason" && key !== "Escape")) return;
  if (key === "Escape") shown()?.querySelector("[data-audit-write]")?.removeAttribute("open");
  event.preventDefault();
  focusRow();
}

let decidedAt = -Infinity;

// Two presses in a row are one decision: nobody has read the next label yet.
function press(button, event) {
  if (!button) return;
  if (performance.now() - decidedAt < READING) return sayIgnored(event);
  decidedAt = performance.now();
  button.click();
}

const ofAction = (action) => shown()?.querySelector(`[data-action="${action}"]`);

const actions = {
  digit: (event) => press(shown()?.querySelector(`[data-digit="${keyOf(event)}"]`), event),
  accept: (event) => press(ofAction("accept"), event),
  reject: (event) => press(ofAction("reject"), event),
  edit: openEditor,
  note: () => document.getElementById("audit-reason")?.focus(),
  undo: () => document.querySelector("form[data-take-back]")?.requestSubmit(),
};

// A key that comes while the next label is on its way is not for that one: nobody has read it yet.
function onKey(event) {
  const key = keyOf(event);
  if (!key || document.querySelector("dialog[open]")) return;
  if (!document.querySelector("[data-audit-page]")) return;
  if (event.target.closest(TYPING)) {
    if (key === "Enter" || key === "Escape") leaveField(event, key);
    return;
  }
  const action = actionOf(event);
  if (["next", "previous"].includes(action) && !event.target.matches(ROW)) focusRow();
  if (event.repeat || !Object.hasOwn(actions, action)) return;
  event.preventDefault();
  if (isBusy()) sayIgnored(event);
  else actions[action](event);
}
