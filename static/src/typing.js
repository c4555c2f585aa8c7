// Which keys are commands, and which belong to what somebody types.
export const TYPING = "input, textarea, select, [contenteditable], .cm-editor";

/** Milliseconds: whoever presses a key sooner after something new is shown has not read it. */
export const READING = 250;

/** Whether a key may be a command: neither one of the browser nor part of a composition, as the Enter that chooses
 * a word of an input method is and the Escape that closes its list. (Safari reports that Enter with the code 229.) */
export const isPlain = (event) =>
  !(event.ctrlKey || event.metaKey || event.altKey || event.isComposing || event.keyCode === 229);
