// Calls back for the page and for every piece that htmx puts into it later.
import htmx from "htmx.org";

export function onContent(callback) {
  htmx.onLoad(callback);
}
