// The buttons that send a form by key.

/** Press the button of a form for Ctrl+Enter, or for Ctrl+Shift+Enter. Returns whether there is one. */
export function pressSend(form, hasShift) {
  const button = form?.querySelector(`button[title="Ctrl+${hasShift ? "Shift+" : ""}Enter"]`);
  if (button) form.requestSubmit(button);
  return Boolean(button);
}
