// Keeps what a person types into a form with data-draft until the server has it, so that it outlives a closed tab, a
// reload, a lost connection, an expired session and a conflict. It is kept in this browser (draft-storage.js) and, with
// data-draft-url, on the server too (draft-server.js), where another device finds it. It goes once the form has arrived:
// the server answers one that it has taken with a redirect or with a fragment, and one that it has refused with
// the form itself, an error or the page for logging in. Passwords are never kept.
import { onContent } from "./content.js";
import { DraftServer } from "./draft-server.js";
import {
  keyOfDraft,
  noteSent,
  placeOf,
  readDraft,
  removeAllOf,
  removeDraft,
  takeSent,
  writeDraft,
} from "./draft-storage.js";
import { timeOf } from "./moments.js";

const TEXTS = "input:is([type=text], [type=number], [type=url], [type=email])[name]";
const TYPED = `textarea[name], select[name], input[type=radio][name], ${TEXTS}`;
// The version that was edited comes back too, so that nobody's later version is overwritten unseen.
// (A form that says what its page shows now, with data-undrafted, is sent with the version of that page.)
const KEPT = `${TYPED}, input[type=hidden]:is([name=version]:not([data-undrafted]), [name=once])`;
const servers = new WeakMap(); // form → its DraftServer
const shown = new WeakMap(); // form → its values as the page came with them
let refused = null; // the key of the draft whose form was sent and not taken; its page shows what was typed

const fieldsOf = (form) => [...form.elements].filter((field) => field.matches(KEPT));
const isUnchosen = (field) => field.type === "radio" && !field.checked;

function valuesOf(form) {
  const fields = fieldsOf(form).filter((field) => !isUnchosen(field));
  return Object.fromEntries(fields.map((field) => [field.name, field.value]));
}

function fill(form, values) {
  for (const field of fieldsOf(form)) {
    // The key of a new form is its own: an earlier one may have been sent already.
    if (values[field.name] === undefined || field.name === "once") continue;
    if (field.type === "radio") field.checked = field.value === values[field.name];
    else field.value = values[field.name];
    field.dispatchEvent(new CustomEvent("draft:restored"));
  }
  // Whoever watches the form (checker, preview) looks at it again.
  form.dispatchEvent(new Event("input", { bubbles: true }));
}

function differs(form, values) {
  const typed = fieldsOf(form).filter((field) => field.matches(TYPED) && !isUnchosen(field));
  return typed.some((field) => (values[field.name] ?? field.value) !== field.value) || hasOtherChoice(form, values);
}

const hasOtherChoice = (form, values) =>
  fieldsOf(form).some((field) => isUnchosen(field) && values[field.name] === field.value);

/** Keep what the form holds; where it is again as the page came with it, there is nothing to keep. */
function keep(form) {
  const isUntouched = shown.has(form) && !differs(form, shown.get(form));
  if (isUntouched) return readDraft(form) && discard(form);
  writeDraft(form, valuesOf(form));
  servers.get(form)?.save(valuesOf(form), placeOf(form));
}

function discard(form) {
  removeDraft(keyOfDraft(form));
  servers.get(form)?.discard();
}

function makeLine(element) {
  const line = document.createElement(element);
  line.className = "saved";
  line.role = "status";
  return line;
}

/** Say a sentence, with a button for each action: text → what it does. */
function say(line, sentence, actions = {}) {
  line.replaceChildren(sentence);
  for (const [text, action] of Object.entries(actions)) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "link-button small-button";
    button.textContent = text;
    button.addEventListener("click", action);
    line.append(" ", button);
  }
}

/** A line above the form, which a click on one of its buttons takes away. */
function showNote(form, sentence, actions) {
  form.querySelector(":scope > p.draft-note")?.remove();
  const line = makeLine("p");
  line.classList.add("draft-note");
  const closing = (action) => () => {
    line.remove();
    action();
  };
  say(line, sentence, Object.fromEntries(Object.entries(actions).map(([text, action]) => [text, closing(action)])));
  form.prepend(line);
}

function restore(form, draft) {
  const before = valuesOf(form);
  form.closest("details")?.setAttribute("open", "");
  fill(form, draft.fields);
  showNote(form, `Your draft of ${timeOf(draft.savedAt)}.`, {
    Discard: () => {
      fill(form, before);
      discard(form);
    },
  });
}

function offer(form, draft) {
  const where = draft.isElsewhere ? " from another device" : "";
  showNote(form, `You have an unsaved draft of ${timeOf(draft.savedAt)}${where}:`, {
    Restore: () => restore(form, draft),
    // What has been typed here meanwhile takes its place.
    "Discard it": () => (readDraft(form) ? keep(form) : discard(form)),
  });
}

async function offerFromServer(form, hasLocal) {
  const draft = await servers.get(form).load();
  if (!draft || (hasLocal && !draft.isElsewhere)) return;
  if (differs(form, draft.fields)) offer(form, draft);
  else servers.get(form).discard();
}

/** Where the state of the draft is said: beside the buttons, so that nothing moves. */
function stateLine(form) {
  const line = makeLine("span");
  (form.querySelector(".actions") ?? form).append(line);
  return line;
}

function enhance(form) {
  if (form.dataset.draftUrl) {
    const line = stateLine(form);
    servers.set(form, new DraftServer(form, (...said) => say(line, ...said)));
  }
  form.addEventListener("input", () => keep(form));
  form.addEventListener("change", (event) => event.target.type === "radio" && keep(form));
  // The page shows what was sent, merged or refused: newer than any draft.
  if (form.hasAttribute("data-draft-arrived")) return keep(form);
  const draft = readDraft(form);
  const hasLocal = draft !== null && differs(form, draft.fields);
  const isRefused = keyOfDraft(form) === refused;
  if (isRefused && !hasLocal) return keep(form);
  shown.set(form, valuesOf(form));
  if (hasLocal) restore(form, draft);
  else if (draft) removeDraft(keyOfDraft(form));
  if (servers.has(form)) offerFromServer(form, hasLocal);
}

document.addEventListener("submit", (event) => {
  const form = event.target;
  if (form.matches("form[data-draft]")) {
    servers.get(form)?.stop();
    writeDraft(form, valuesOf(form));
    if (!event.defaultPrevented) noteSent(form); // else a script sends it behind the scenes
  }
  if (form.dataset.logOutOf) removeAllOf(form.dataset.logOutOf);
});

// The form of a panel was sent behind the scenes, and has arrived.
document.addEventListener("draft:arrived", (event) => discard(event.target));

const SAYS_NO = 'class="message error"';

// htmx has sent a form. Where it may not show the answer, that is the page for logging in.
document.addEventListener("htmx:beforeSwap", (event) => {
  const { requestConfig, xhr, shouldSwap } = event.detail;
  const form = requestConfig.elt.closest("form[data-draft]");
  if (!form || requestConfig.verb !== "post") return;
  if (shouldSwap && xhr.status < 300 && !xhr.responseText.includes(SAYS_NO)) discard(form);
  else refused = keyOfDraft(form);
});

/** Whether the form that was sent before this page has arrived: a redirect led here, and nothing says that it failed. */
function hasArrived() {
  const [navigation] = performance.getEntriesByType("navigation");
  return navigation?.redirectCount > 0 && !document.querySelector(".messages .error");
}

const sent = takeSent();
if (sent && hasArrived()) removeDraft(sent);
else refused = sent;

onContent((root) => root.querySelectorAll("form[data-draft]").forEach(enhance));
