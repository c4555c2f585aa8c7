// Copying: what a button names goes into the clipboard. Where a browser lets no page copy, as without HTTPS, it is shown
// and selected. A note beside the button says so, aloud too. Secrets that are shown once are selected as one comes to them.

const SHOWN_MS = 3000;

/** Put a text into the clipboard, or let `select` show it selected; say which in `note`, an element with role status. */
export async function copyText(text, note, select) {
  try {
    await navigator.clipboard.writeText(text);
    say(note, "Copied");
  } catch {
    select();
    say(note, "Selected: press Ctrl+C");
  }
}

function say(note, text) {
  note.textContent = "";
  // In the next frame: a screen reader notices what changes in an element that is there.
  requestAnimationFrame(() => (note.textContent = text));
  clearTimeout(note.timer);
  note.timer = setTimeout(() => (note.textContent = ""), SHOWN_MS);
}

/** Return the note beside an element, made where there is none. */
export function noteBeside(element) {
  const there = element.parentElement.querySelector(":scope > .copy-note");
  if (there) return there;
  const note = document.createElement("span");
  note.className = "copy-note";
  note.role = "status";
  element.after(note);
  return note;
}

function copyField(button) {
  const field = document.getElementById(button.dataset.copyField);
  const select = () => {
    field.hidden = false;
    field.select();
    field.focus();
  };
  if (!field.hidden) select();
  return copyText(field.value, noteBeside(button), select);
}

document.addEventListener("click", (event) => {
  const button = event.target.closest("[data-copy-field]");
  if (button) copyField(button);
});

document.addEventListener("focusin", (event) => {
  if (event.target.matches?.("[data-secret]")) event.target.select();
});
