// Filters that are not set stay out of the address that a form leads to.
document.addEventListener("formdata", ({ target: form, formData }) => {
  if ((form.getAttribute("method") ?? "get") !== "get" || form.hasAttribute("hx-post")) return;
  for (const name of new Set(formData.keys())) {
    const given = formData.getAll(name).filter((value) => value !== "");
    formData.delete(name);
    given.forEach((value) => formData.append(name, value));
  }
});
