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

export function showTable(chart, data) {
  const details = chart.querySelector("details");
  if (!details) return;
  const head = document.createElement("thead");
  head.append(
    row(cell("th", data.x.label || ""), ...data.series.map((one) => cell("th", one.name, "number"))),
  );
  const body = document.createElement("tbody");
  data.x.values.forEach((x, at) => {
    body.append(row(cell("th", x), ...data.series.map((one) => cell("td", figure(one.values[at]), "number"))));
  });
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
