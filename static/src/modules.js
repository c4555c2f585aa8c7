// Modules that only some pages need. Their addresses carry hashes, so the page names them.
const loading = new Map();

function loadModule(name) {
  if (!loading.has(name)) {
    const address = document.querySelector(`meta[name="module-${name}"]`).content;
    loading.set(name, import(address));
  }
  return loading.get(name);
}

/** Hands `element` to the module, once however often it is asked; `data-ready` says that this is done. */
export async function enhanceBy(name, element) {
  const { enhance } = await loadModule(name);
  if ("ready" in element.dataset) return;
  enhance(element);
  element.dataset.ready = "";
}
