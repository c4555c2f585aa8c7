// Drafts in this browser, under the account, the key of the world and the name of the form: another account never
// sees them, and a world that is renamed keeps them. The oldest go first, and none stays longer than half a year.
const PREFIX = "draft:";
const MOST = 200;
const KEPT_MS = 183 * 24 * 60 * 60 * 1000;
const WORLD = /^\/w\/[^/]+\//;

export const keyOfDraft = (form) => `${PREFIX}${form.dataset.draftOf}:${form.dataset.draft}`;

// A full or forbidden storage loses the copy in this browser, not the form.
export function attempt(action, otherwise = null) {
  try {
    return action();
  } catch {
    return otherwise;
  }
}

const names = () => Object.keys(localStorage).filter((name) => name.startsWith(PREFIX));
const read = (key) => attempt(() => JSON.parse(localStorage.getItem(key)));

export const readDraft = (form) => read(keyOfDraft(form));
export const removeDraft = (key) => attempt(() => localStorage.removeItem(key));
export const putDraft = (key, draft) => attempt(() => localStorage.setItem(key, JSON.stringify(draft)));

/** What lists call the draft of a form, and where the form stands below the address of its world. */
export const placeOf = (form) => ({
  about: form.dataset.draftAbout ?? "",
  page: form.dataset.draftPage ?? `${location.pathname.replace(WORLD, "")}${location.search}`,
});

/** Keep these fields. The draft is as old as its last change. */
export function writeDraft(form, fields) {
  const before = readDraft(form);
  if (before && sameTexts(before.fields, fields)) return;
  putDraft(keyOfDraft(form), { fields, savedAt: Date.now(), ...placeOf(form) });
  if (!before) removeOld();
}

// The key of a new form is another one each time.
const sameTexts = (a, b) => JSON.stringify({ ...a, once: "" }) === JSON.stringify({ ...b, once: "" });

/** All drafts of an account in this browser as pairs of key and draft, the newest first. */
export function draftsOf(account) {
  const mine = attempt(() => names().filter((name) => name.startsWith(`${PREFIX}${account}:`)), []);
  return mine.map((key) => [key, read(key)]).sort(([, a], [, b]) => b.savedAt - a.savedAt);
}

export const removeAllOf = (account) => draftsOf(account).forEach(([key]) => removeDraft(key));

function removeOld() {
  const ages = attempt(() => names(), []).map((key) => [key, Date.now() - (read(key)?.savedAt ?? 0)]);
  const newestFirst = ages.sort(([, a], [, b]) => a - b);
  newestFirst.filter(([, age], place) => place >= MOST || !(age < KEPT_MS)).forEach(([key]) => removeDraft(key));
}

removeOld();

// Which form this window has sent last. Until a page says that it has arrived, its draft stays.
const SENT = "draft-sent";

export const noteSent = (form) => attempt(() => sessionStorage.setItem(SENT, keyOfDraft(form)));

/** Return the key of the draft that was sent last, and forget that it was. */
export function takeSent() {
  const key = attempt(() => sessionStorage.getItem(SENT));
  attempt(() => sessionStorage.removeItem(SENT));
  return key;
}
