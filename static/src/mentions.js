// A button with data-mention puts a name into the comment beside it, where the cursor is.
document.addEventListener("click", (event) => {
  const button = event.target.closest("[data-mention]");
  if (!button) return;
  const field = button.form.elements.text;
  field.setRangeText(button.dataset.mention, field.selectionStart, field.selectionEnd, "end");
  field.dispatchEvent(new Event("input", { bubbles: true }));
  field.focus();
});
