// A `details[data-remembered]` stays as somebody has left it, on every page that has one of that name. Until then it is
// as the page has it.
import { onContent } from "./content.js";

const keyOf = (panel) => `${panel.dataset.remembered}-open`;

function remembered(panel) {
  try {
    return localStorage.getItem(keyOf(panel));
  } catch {
    return null;
  }
}

function remember(panel) {
  try {
    localStorage.setItem(keyOf(panel), panel.open ? "yes" : "no");
  } catch {
    // then it lasts for this page
  }
}

onContent((root) => {
  root.querySelectorAll("[data-remembered]").forEach((panel) => {
    const before = remembered(panel);
    if (before) panel.open = before === "yes";
    let isOpen = panel.open;
    panel.addEventListener("toggle", () => {
      if (panel.open === isOpen) return; // the browser tells of the state that the page came with, too
      isOpen = panel.open;
      remember(panel);
    });
  });
});
