// The review page by keyboard: one answer of the example has the focus, and one key says why it is wrong.
import { actionOf, keyOf, sayIgnored, TYPING } from "./typing.js";

let isListening = false;
let focused = ""; // the run whose answer has the focus, from example to example
const open = new Set(); // the folds that stay open
let waiting = []; // keys that came while an answer was on its way to the server

const current = () => document.getElementById("case");
const answers = () => [...document.querySelectorAll("[data-answer]")];
const answerOf = (run) => answers().find((each) => each.dataset.answer === run);
const shown = () => answerOf(focused) ?? answers()[0];
const busy = () => document.querySelector("#list .htmx-request, #list.htmx-request");
const isStepping = () => Boolean(document.querySelector("#list a.htmx-request"));

/** Called for the page's example and again for each that replaces the one before. */
export function enhance(place) {
  if (!isListening) {
    isListening = true;
    focused = place.dataset.focus;
    document.addEventListener("keydown", onKey, true); // before the keys of all pages
    document.addEventListener("focusin", onFocus);
    document.addEventListener("htmx:afterSettle", goOn);
    for (const failure of ["htmx:responseError", "htmx:sendError"]) {
      document.addEventListener(failure, () => (waiting = []));
    }
  }
  if (!answerOf(focused)) focused = place.dataset.focus;
  place.querySelectorAll("details[data-fold]").forEach((fold) => {
    fold.open = open.has(fold.dataset.fold);
    fold.addEventListener("toggle", () => remember(fold));
  });
  shorten(place);
  mark();
  if (!document.activeElement?.closest(TYPING)) focus();
}

// What may be long: the utterance, its form, and the answers. CSS gives each a few lines, which scroll.
const SLACK = 8; // pixels: chips are a little higher than their line
const LONG = ".review-text, .review-label .lf > code, .review-body > .lf > code";

/** Where something is longer than its lines, show the first difference of it, and a button that shows all. */
function shorten(place) {
  const pane = place.querySelector(".review-pane");
  const button = place.querySelector("[data-show-all]");
  const isAll = open.has("all");
  pane.removeAttribute("data-shows-all");
  const cut = [...pane.querySelectorAll(LONG)].filter((each) => each.scrollHeight > each.clientHeight + SLACK);
  for (const each of cut) {
    each.tabIndex = 0; // arrow keys scroll it
    const first = each.querySelector("mark, ins, del");
    if (first) each.scrollTop = first.offsetTop - each.offsetTop;
  }
  pane.toggleAttribute("data-is-long", cut.length > 0);
  pane.toggleAttribute("data-shows-all", isAll);
  button.hidden = !cut.length;
  button.setAttribute("aria-expanded", String(isAll));
  button.querySelector("span").textContent = isAll ? "Show less" : "Show all";
  button.onclick = showAll;
}

function showAll() {
  if (!current().querySelector("[data-show-all]:not([hidden])")) return;
  if (open.has("all")) open.delete("all");
  else open.add("all");
  shorten(current());
}

function remember(fold) {
  if (fold.open) open.add(fold.dataset.fold);
  else open.delete(fold.dataset.fold);
}

function focus() {
  shown()?.focus({ preventScroll: true });
}

// The answer that has the focus is the one that keys and the error categories below are about.
function mark() {
  const answer = shown();
  if (!answer) return;
  answers().forEach((each) => each.toggleAttribute("aria-current", each === answer));
  answer.setAttribute("aria-current", "true");
  const address = new URL(location.href);
  if (address.searchParams.get("focus") !== answer.dataset.answer && answers().length > 1) {
    address.searchParams.set("focus", answer.dataset.answer);
    history.replaceState(history.state, "", address);
  }
  document.querySelectorAll("[data-review-palette] [name=run], [data-review-doubt] [name=run]").forEach((field) => {
    field.value = answer.dataset.answer;
  });
  const palette = document.querySelector("[data-review-palette]");
  if (!palette) return;
  const isWrong = "wrong" in answer.dataset;
  palette.querySelector("[data-palette-title]").textContent = isWrong
    ? `Why is the answer of ${answer.dataset.title} wrong?`
    : `The answer of ${answer.dataset.title} has no error to tag.`;
  palette.querySelectorAll("button").forEach((button) => {
    button.disabled = !isWrong;
    button.setAttribute("aria-pressed", String(button.value === answer.dataset.own));
    button.toggleAttribute("data-is-proposed", isWrong && button.value === answer.dataset.proposed);
  });
}

function onFocus(event) {
  const answer = event.target.closest?.("[data-answer]");
  if (!answer || answer.dataset.answer === focused) return;
  focused = answer.dataset.answer;
  mark();
}

function moveBy(step) {
  const all = answers();
  const to = all[all.indexOf(shown()) + step];
  if (!to) return;
  to.focus({ preventScroll: true });
  to.scrollIntoView({ block: "nearest", inline: "nearest" });
}

const press = (action, place = document.getElementById("list")) =>
  place?.querySelector(`[data-action="${action}"]:not([disabled])`)?.click();

function unfold(name) {
  const fold = shown()?.querySelector(`[data-fold="${name}"]`);
  if (!fold) return;
  const isOpen = !fold.open;
  document.querySelectorAll(`[data-fold="${name}"]`).forEach((each) => (each.open = isOpen));
}

function openDoubt() {
  const panel = document.querySelector("[data-review-doubt]");
  if (!panel) return;
  panel.open = true;
  panel.querySelector("[name=reason]").focus();
}

function openFilters() {
  const filters = document.querySelector(".review-filters");
  filters.open = true;
  filters.querySelector("input:not([type=hidden])").focus();
}

const actions = {
  next: () => press("next"),
  previous: () => press("previous"),
  differ: () => press("differ"),
  left: () => moveBy(-1),
  right: () => moveBy(1),
  note: () => shown()?.querySelector("[data-note]")?.focus(),
  dispute: openDoubt,
  undo: () => press("undo", shown()),
  accept: () => press("accept", shown()),
  tree: () => unfold("tree"),
  candidates: () => unfold("beam"),
  all: showAll,
  beside: () => document.getElementById("review-add")?.focus(),
  filters: openFilters,
  edit: () => press("edit", current()),
  queue: () => press("queue", current()),
};

function whatToDo(event, action) {
  if (Object.hasOwn(actions, action)) return actions[action];
  const tag = action === "digit" && document.querySelector(`[data-review-palette] [data-digit="${keyOf(event)}"]`);
  return tag ? () => tag.disabled || tag.click() : null;
}

function leaveField(event, key) {
  const isNote = event.target.matches("[data-note]");
  if (key === "Enter" && isNote) {
    event.target.form.requestSubmit();
  } else if (key !== "Escape" || !event.target.closest("#case")) {
    return;
  }
  event.preventDefault();
  event.target.closest("details[open]")?.removeAttribute("open");
  focus();
}

function onKey(event) {
  const key = keyOf(event);
  if (!key || !current() || document.querySelector("dialog[open]")) return;
  if (event.target.closest(TYPING)) {
    if (key === "Enter" || key === "Escape") leaveField(event, key);
    return;
  }
  const action = actionOf(event);
  const doIt = whatToDo(event, action);
  if (!doIt) return;
  event.preventDefault();
  const isStep = ["next", "previous"].includes(action);
  if (event.repeat && !isStep) return;
  if (!busy()) doIt();
  else if (!isStepping() || isStep) waiting.push(doIt);
  // A tag that comes while the next example is on its way is not for that one: nobody has read it yet.
  else sayIgnored(event);
}

function goOn() {
  if (!busy()) waiting.splice(0, 1).forEach((action) => action());
}
