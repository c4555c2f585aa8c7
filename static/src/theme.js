// Light or dark, and the notation of forms, set before the first paint. A classic script for that reason.
// Without a choice of the person's the system decides.
const root = document.documentElement;
const system = matchMedia("(prefers-color-scheme: dark)");

function stored(key) {
  try {
    return localStorage.getItem(key);
  } catch {
    return null; // storage may be forbidden; the choice then lasts for the page
  }
}

function show(theme) {
  if (theme) root.dataset.theme = theme;
  root.dataset.resolvedTheme = theme || (system.matches ? "dark" : "light");
  root.dispatchEvent(new CustomEvent("theme:change"));
}

function toggle() {
  const theme = root.dataset.resolvedTheme === "dark" ? "light" : "dark";
  try {
    localStorage.setItem("theme", theme);
  } catch {
    // see stored()
  }
  show(theme);
}

show(stored("theme"));
root.dataset.notation = stored("notation") || "reading";
system.addEventListener("change", () => show(root.dataset.theme));
addEventListener("storage", (event) => event.key === "theme" && show(event.newValue));
document.addEventListener("click", (event) => {
  if (event.target.closest("[data-theme-toggle]")) toggle();
});
