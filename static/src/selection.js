// Rows are selected by their check boxes; Shift selects a range; the bulk bar says how many.
let anchor = null;

const boxOf = (row) => row.querySelector("input[type=checkbox]:not([data-select-all])");
const boxesOf = (table) => [...table.tBodies].flatMap((body) => [...body.rows].map(boxOf)).filter(Boolean);

function show(table) {
  const boxes = boxesOf(table);
  const count = boxes.filter((box) => box.checked).length;
  boxes.forEach((box) => box.closest("tr").classList.toggle("is-selected", box.checked));
  const all = table.querySelector("[data-select-all]");
  if (all) {
    all.checked = count > 0 && count === boxes.length;
    all.indeterminate = count > 0 && count < boxes.length;
  }
  const bar = (table.closest("form") ?? document).querySelector("[data-bulk]");
  if (!bar) return;
  bar.hidden = count === 0;
  const label = bar.querySelector("[data-bulk-count]");
  if (label) label.textContent = `${count} selected`;
}

function selectRange(table, box) {
  const boxes = boxesOf(table);
  const from = boxes.indexOf(anchor);
  const to = boxes.indexOf(box);
  if (from < 0 || to < 0) return;
  boxes.slice(Math.min(from, to), Math.max(from, to) + 1).forEach((each) => {
    each.checked = box.checked;
  });
}

/** Turn a row's selection; with `isRange`, give that of the row to all since the last one. */
export function selectRow(row, isRange) {
  const box = boxOf(row);
  if (!box) return;
  box.checked = isRange ? true : !box.checked;
  if (isRange) selectRange(row.closest("table"), box);
  anchor = box;
  show(row.closest("table"));
}

document.addEventListener("click", (event) => {
  const box = event.target;
  if (!box.matches?.("table[data-rows] input[type=checkbox]")) return;
  const table = box.closest("table");
  if (box.hasAttribute("data-select-all")) {
    boxesOf(table).forEach((each) => {
      each.checked = box.checked;
    });
  } else {
    if (event.shiftKey) selectRange(table, box);
    anchor = box;
  }
  show(table);
});
