// Drafts in this browser, under the account and the name of the form: another account never sees them.
const PREFIX = "draft:";
const key = (form) => `${PREFIX}${form.dataset.draftOf}:${form.dataset.draft}`;
const names = () => Object.keys(localStorage).filter((name) => name.startsWith(PREFIX));

// A full or forbidden storage loses the copy in this browser, not the form.
function attempt(action, otherwise = null) {
  try {
    return action();
  } catch {
    return otherwise;
  }
}

export const readDraft = (form) => attempt(() => JSON.parse(localStorage.getItem(key(form))));
export const removeDraft = (form) => attempt(() => localStorage.removeItem(key(form)));
export const writeDraft = (form, fields, isSent = false) =>
  attempt(() => localStorage.setItem(key(form), JSON.stringify({ fields, isSent })));

/** A draft that was sent and whose form is not on this page has arrived. */
export function removeArrived() {
  const here = new Set([...document.querySelectorAll("form[data-draft]")].map(key));
  attempt(() =>
    names()
      .filter((name) => !here.has(name) && JSON.parse(localStorage.getItem(name)).isSent)
      .forEach((name) => localStorage.removeItem(name)),
  );
}

export function removeAllOf(account) {
  attempt(() =>
    names()
      .filter((name) => name.startsWith(`${PREFIX}${account}:`))
      .forEach((name) => localStorage.removeItem(name)),
  );
}

/** A name by which the server tells the browsers of one person apart. */
export const deviceName = nameDevice();

function nameDevice() {
  const made = crypto.getRandomValues(new Uint32Array(2)).join("-");
  return attempt(() => {
    if (!localStorage.getItem("device")) localStorage.setItem("device", made);
    return localStorage.getItem("device");
  }, made);
}
