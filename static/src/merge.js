// On the page that merges two changes, a button with data-take puts its value into the field of that id.
document.addEventListener("click", (event) => {
  const button = event.target.closest("[data-take]");
  if (!button) return;
  const field = document.getElementById(button.dataset.take);
  field.value = button.value;
  field.dispatchEvent(new CustomEvent("draft:restored"));
  field.form.dispatchEvent(new Event("input", { bubbles: true }));
});
