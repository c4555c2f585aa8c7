// Modules that only some pages need. Their addresses carry hashes, so the page names them.
const loading = new Map();

export function loadModule(name) {
  if (!loading.has(name)) {
    const address = document.querySelector(`meta[name="module-${name}"]`).content;
    loading.set(name, import(address));
  }
  return loading.get(name);
}
