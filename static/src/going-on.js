// The focus after an action: whoever sent a form, or pressed what htmx replaced, goes on from where they were. That is the
// same control, or the next of its kind; the editor after "Save and next"; else the part that is new.
import { onContent } from "./content.js";

const KEY = "going-on";
const LASTS = 60_000; // milliseconds: an answer that comes later is to nothing that somebody still thinks of
const PRESSED = "button, a[href], summary, input[type=submit]";
const main = () => document.getElementById("main");
const isNowhere = () => !document.activeElement || document.activeElement === document.body;
const textOf = (element) => element.textContent.replace(/\s+/g, " ").trim();
const sameText = (text, within) =>
  [...within.querySelectorAll(PRESSED)].filter((each) => textOf(each) === text && each.checkVisibility());

// A browser that keeps nothing for a site refuses both.
function keep(text) {
  try {
    sessionStorage.setItem(KEY, text);
  } catch {
    // The next page begins at its top.
  }
}

function taken() {
  try {
    const text = sessionStorage.getItem(KEY);
    sessionStorage.removeItem(KEY);
    return JSON.parse(text);
  } catch {
    return null;
  }
}

// An editor stands in the place of its field.
const fieldOf = (element) => element.closest(".editor")?.previousElementSibling ?? element;

function describe(element, isNext = false) {
  const field = fieldOf(element);
  const text = field.matches(PRESSED) ? textOf(field) : "";
  return {
    id: field.id,
    name: field.matches("input, select, textarea") ? field.name : "",
    text,
    index: text ? Math.max(0, sameText(text, main() ?? document).indexOf(field)) : 0,
    isNext,
    at: Date.now(),
  };
}

function find(left, within) {
  if (left.isNext) {
    const editor = within.querySelector("form[data-keys-of-page] [data-editor]");
    if (editor) return editor;
  }
  const byId = left.id && document.getElementById(left.id);
  if (byId) return byId;
  if (left.name) return within.querySelector(`[name="${CSS.escape(left.name)}"]:not([type=hidden])`);
  const alike = left.text ? sameText(left.text, within) : [];
  return alike[Math.min(left.index, alike.length - 1)] ?? null;
}

function focusOn(element, options) {
  const shown = element.hidden ? (element.nextElementSibling?.querySelector(".cm-content") ?? element) : element;
  if (!shown.matches("a[href], button, input, select, textarea, summary, [tabindex], [contenteditable]")) shown.tabIndex = -1;
  shown.focus(options);
  return document.activeElement === shown;
}

function isInSight(element) {
  const { top, bottom } = element.getBoundingClientRect();
  return top >= 0 && bottom <= innerHeight;
}

// Pages that lead the focus from one item to the next.
const LEADING = "[data-label-page], [data-audit-page], [data-review-page]";

function goOn(left, fresh) {
  if (!isNowhere() || document.querySelector(LEADING)) return;
  const place = main();
  const control = place && find(left, place);
  // What is out of sight would scroll away what the page says of the action.
  if (control && (left.isNext || fresh || isInSight(control)) && focusOn(control, { preventScroll: !left.isNext })) return;
  const part = fresh?.isConnected ? fresh : place;
  if (part) focusOn(part, { preventScroll: true });
}

document.addEventListener(
  "submit",
  (event) => {
    if (event.target.getAttribute("method") !== "post") return;
    const from = isNowhere() ? event.submitter : document.activeElement;
    if (from) keep(JSON.stringify(describe(from, event.submitter?.name === "next")));
  },
  true,
);

let sent = taken();
onContent((root) => {
  if (root !== document.body || !sent || Date.now() - sent.at > LASTS) return;
  const left = sent;
  sent = null;
  setTimeout(() => goOn(left, null)); // after what a page focuses by itself, such as its first error
});

let replaced = null;
document.addEventListener("htmx:beforeSwap", (event) => {
  const { target, shouldSwap } = event.detail;
  if (shouldSwap && target.contains(document.activeElement)) replaced = describe(document.activeElement);
});
document.addEventListener("htmx:afterSettle", (event) => {
  if (!replaced) return;
  const left = replaced;
  replaced = null;
  goOn(left, event.detail.elt);
});
