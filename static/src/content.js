// Calls back for the page and for every piece that htmx puts into it later.
import htmx from "htmx.org";

// What a script puts into the page by itself, with attributes of htmx in it.
document.addEventListener("content:added", (event) => htmx.process(event.target));

export function onContent(callback) {
  htmx.onLoad(callback);
}
