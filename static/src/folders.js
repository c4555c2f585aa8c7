// A field of files takes a whole folder, too: chosen with the button beside it, or dropped on it.
import { onContent } from "./content.js";

const READ = /\.(?:txt|md|xml|json|csv|tsv|ccg|zip|tar|tgz|gz)$/i;
const isRead = (path) =>
  READ.test(path) && !path.split("/").some((part) => part.startsWith(".") || part === "__MACOSX");

/** Put files with their paths into the field; the server reads both in the same order. */
function take(field, input, found) {
  const read = found.filter(({ path }) => isRead(path));
  const transfer = new DataTransfer();
  read.forEach(({ file }) => transfer.items.add(file));
  input.files = transfer.files;
  setPaths(field, read.map(({ path }) => path));
  const left = found.length - read.length;
  const beside = left ? `; ${left} that no import reads ${left === 1 ? "is" : "are"} left out` : "";
  field.querySelector("[role=status]").textContent = `${read.length} file${read.length === 1 ? "" : "s"} chosen${beside}.`;
}

function setPaths(field, paths) {
  field.querySelectorAll("[name=paths]").forEach((each) => each.remove());
  paths.forEach((path) => {
    const hidden = document.createElement("input");
    Object.assign(hidden, { type: "hidden", name: "paths", value: path });
    field.append(hidden);
  });
}

async function filesIn(entry) {
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
    return [{ file, path: entry.fullPath.replace(/^\//, "") }];
  }
  const reader = entry.createReader();
  const found = [];
  for (;;) {
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject)); // a hundred at a time
    if (!some.length) return found;
    for (const each of some) found.push(...(await filesIn(each)));
  }
}

function enhance(input) {
  const field = input.closest(".field");
  const folder = document.createElement("input");
  Object.assign(folder, { type: "file", webkitdirectory: true, hidden: true });
  const button = document.createElement("button");
  Object.assign(button, { type: "button", className: "small-button", textContent: "Choose a folder" });
  const status = document.createElement("span");
  status.className = "help";
  status.setAttribute("role", "status");
  status.textContent = "Or drop files, a folder or an archive here.";
  input.after(button, folder, status);
  button.addEventListener("click", () => folder.click());
  folder.addEventListener("change", () => {
    take(field, input, [...folder.files].map((file) => ({ file, path: file.webkitRelativePath })));
  });
  input.addEventListener("change", () => {
    setPaths(field, []);
    status.textContent = "";
  });
  field.addEventListener("dragover", (event) => {
    event.preventDefault();
    field.dataset.dropping = "";
  });
  field.addEventListener("dragleave", () => delete field.dataset.dropping);
  field.addEventListener("drop", async (event) => {
    event.preventDefault();
    delete field.dataset.dropping;
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
    take(field, input, (await Promise.all(entries.map(filesIn))).flat());
  });
}

onContent((root) => root.querySelectorAll("input[data-folder]").forEach(enhance));
