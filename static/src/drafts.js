// Keeps what a person types into a form with data-draft until the server has it, so that it outlives a reload, a lost
// connection, an expired session, and can be taken up on another device. It is kept in this browser (draft-storage.js)
// and, with data-draft-url, on the server (draft-server.js). Sending the form only marks the copy in this browser,
// because an expired session may swallow it; it is removed when the server has shown another page, or the same form
// with the same values. Passwords are never kept.
import { onContent } from "./content.js";
import { DraftServer } from "./draft-server.js";
import { readDraft, removeAllOf, removeArrived, removeDraft, writeDraft } from "./draft-storage.js";

const TYPED = "textarea[name], select[name], input:is([type=text], [type=number])[name]";
// The version that was edited comes back too, so that nobody's later version is overwritten unseen.
// (A form that says what its page shows now, with data-undrafted, is sent with the version of that page.)
const KEPT = `${TYPED}, input[type=hidden]:is([name=version]:not([data-undrafted]), [name=once])`;
const servers = new WeakMap(); // form → its DraftServer

const fieldsOf = (form) => [...form.elements].filter((field) => field.matches(KEPT));
const valuesOf = (form) => Object.fromEntries(fieldsOf(form).map((field) => [field.name, field.value]));

function fill(form, values) {
  for (const field of fieldsOf(form)) {
    // The key of a new form is its own: an earlier one may have been sent already.
    if (values[field.name] === undefined || field.name === "once") continue;
    field.value = values[field.name];
    field.dispatchEvent(new CustomEvent("draft:restored"));
  }
  // Whoever watches the form (checker, preview) looks at it again.
  form.dispatchEvent(new Event("input", { bubbles: true }));
}

function differs(form, values) {
  const typed = fieldsOf(form).filter((field) => field.matches(TYPED));
  return typed.some((field) => (values[field.name] ?? field.value) !== field.value);
}

function keep(form) {
  writeDraft(form, valuesOf(form));
  servers.get(form)?.save(valuesOf(form));
}

function discard(form) {
  removeDraft(form);
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
  const line = makeLine("p");
  const closing = (action) => () => {
    line.remove();
    action();
  };
  say(line, sentence, Object.fromEntries(Object.entries(actions).map(([text, action]) => [text, closing(action)])));
  form.prepend(line);
}

function restore(form, draft) {
  const shown = valuesOf(form);
  form.closest("details")?.setAttribute("open", "");
  fill(form, draft.fields);
  showNote(form, "Restored your unsaved draft.", {
    Discard: () => {
      fill(form, shown);
      discard(form);
    },
  });
}

function offer(form, draft) {
  const where = draft.isElsewhere ? " from another device" : "";
  showNote(form, `You have an unsaved draft of ${draft.clock}${where}:`, {
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
  const line = stateLine(form);
  if (form.dataset.draftUrl) servers.set(form, new DraftServer(form, (...said) => say(line, ...said)));
  form.addEventListener("input", () => keep(form));
  // The page shows what was sent, merged: newer than any draft.
  if (form.hasAttribute("data-draft-arrived")) return keep(form);
  const draft = readDraft(form);
  const hasLocal = draft !== null && differs(form, draft.fields);
  if (hasLocal) restore(form, draft);
  else if (draft) removeDraft(form);
  if (servers.has(form)) offerFromServer(form, hasLocal);
}

document.addEventListener("submit", (event) => {
  const form = event.target;
  if (form.matches("form[data-draft]")) {
    writeDraft(form, valuesOf(form), true);
    servers.get(form)?.stop();
  }
  if (form.dataset.logOutOf) removeAllOf(form.dataset.logOutOf);
});

// The form of a panel was sent behind the scenes, and has arrived.
document.addEventListener("draft:arrived", (event) => discard(event.target));

removeArrived();
onContent((root) => root.querySelectorAll("form[data-draft]").forEach(enhance));
