// The list of what somebody has typed and not saved: beside the drafts on the server, those of this browser alone.
// One that is discarded stays in its line, with Undo, until the page is left.
import { postDraft } from "./draft-post.js";
import { draftsOf, putDraft, removeDraft } from "./draft-storage.js";
import { timeOf } from "./moments.js";

// What the list is about, once its page is there.
let page, account, worlds;
const keyOf = (row) => `draft:${account}:${row.dataset.key}`;
const rows = () => [...page.querySelectorAll("tr[data-key]")];

/** The longest text that was typed, as the server says it. */
function excerptOf(fields) {
  const texts = Object.entries(fields).filter(([name]) => name !== "version" && name !== "once");
  return texts.reduce((longest, [, text]) => (text.length > longest.length ? text : longest), "").slice(0, 200);
}

function addRow(key, draft) {
  const name = key.slice(`draft:${account}:`.length);
  const world = worlds[name.split("-", 1)[0]];
  if (!world || rows().some((row) => row.dataset.key === name)) return; // on the server, and listed
  const row = page.querySelector("template[data-draft-row]").content.cloneNode(true).querySelector("tr");
  row.dataset.key = name;
  const about = row.querySelector("[data-about]");
  about.textContent = draft.about;
  about.href = `${world.url}${draft.page}`;
  row.querySelector("[data-name]").textContent = ` ${draft.about}`;
  row.querySelector("[data-excerpt]").textContent = excerptOf(draft.fields);
  row.querySelector("[data-world]").textContent = world.name;
  row.querySelector("[data-when]").textContent = timeOf(draft.savedAt);
  page.querySelector("[data-drafts=browser] tbody").append(row);
}

function showWhatThereIs() {
  for (const section of page.querySelectorAll("[data-drafts]")) section.hidden = !section.querySelector("tr[data-key]");
  page.querySelector("[data-no-drafts]").hidden = rows().length > 0;
}

const discarded = new WeakMap(); // row → what brings its draft back

async function discard(row) {
  const { url } = row.dataset;
  const local = localStorage.getItem(keyOf(row));
  let kept = null;
  if (url) {
    const answer = await fetch(url, { headers: { accept: "application/json" } });
    kept = (await answer.json()).draft;
    await send(url, { discard: true });
  }
  removeDraft(keyOf(row));
  discarded.set(row, async () => {
    if (kept) await send(url, kept);
    if (local) putDraft(keyOf(row), JSON.parse(local));
  });
}

async function send(url, sent) {
  const answer = await postDraft(url, Number(account), sent);
  if (!answer.ok || answer.redirected) throw new Error("not taken");
}

/** Do it, and say in the line what came of it. The focus goes to the button that takes it back. */
async function change(row, action, isDiscarded) {
  const said = row.querySelector("[data-said]");
  const [discarding, undo] = [row.querySelector("[data-discard]"), row.querySelector("[data-undo]")];
  try {
    await action();
  } catch {
    said.textContent = "The server does not answer. Try again.";
    return;
  }
  said.textContent = isDiscarded ? "Discarded." : "";
  row.classList.toggle("is-discarded", isDiscarded);
  discarding.hidden = isDiscarded;
  undo.hidden = !isDiscarded;
  (isDiscarded ? undo : discarding).focus();
}

/** Called for the page. */
export function enhance(place) {
  page = place;
  account = page.dataset.myDrafts;
  worlds = JSON.parse(document.getElementById("worlds-of-drafts").textContent);
  page.addEventListener("click", (event) => {
    const row = event.target.closest("tr[data-key]");
    if (event.target.closest("[data-discard]")) change(row, () => discard(row), true);
    if (event.target.closest("[data-undo]")) change(row, () => discarded.get(row)(), false);
  });
  draftsOf(account).forEach(([key, draft]) => addRow(key, draft));
  showWhatThereIs();
}
