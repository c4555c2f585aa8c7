// The same figures as a table, below the chart.
import { watchScrolling } from "./scrolling.js";

function cell(name, text, className) {
  const made = document.createElement(name);
  made.textContent = text;
  if (className) made.className = className;
  return made;
}

const figure = (value) =>
  value == null ? "–" : Number(value).toLocaleString("en", { maximumFractionDigits: 3 });

function row(...cells) {
  const made = document.createElement("tr");
  made.append(...cells);
  return made;
}

// A row for each x, a column for each line.
function lineRows(data) {
  return [
    row(cell("th", data.x.label || ""), ...data.series.map((one) => cell("th", one.name, "number"))),
    ...data.x.values.map((x, at) =>
      row(cell("th", x), ...data.series.map((one) => cell("td", figure(one.values[at]), "number"))),
    ),
  ];
}

// A row for each point.
function pointRows(data) {
  const heads = [data.x.label, data.y.label, "from", "to"];
  return [
    row(cell("th", ""), ...heads.map((head) => cell("th", head, "number"))),
    ...data.series.flatMap((one) =>
      one.points.map((point) => row(cell("th", one.name), ...point.map((value) => cell("td", figure(value), "number")))),
    ),
  ];
}

export function showTable(chart, data) {
  const details = chart.querySelector("details");
  if (!details) return;
  const [first, ...others] = data.kind === "points" ? pointRows(data) : lineRows(data);
  const head = document.createElement("thead");
  head.append(first);
  const body = document.createElement("tbody");
  body.append(...others);
  const table = document.createElement("table");
  table.append(head, body);
  const wrap = document.createElement("div");
  wrap.className = "table-wrap table-wrap--scroll";
  wrap.append(table);
  details.querySelector(".table-wrap")?.remove();
  details.append(wrap);
  watchScrolling(wrap);
  details.hidden = false;
}
