// Charts from data that the page or the server gives (see templates/_chart.html):
// {x: {label, values}, y: {label, max, unit}, series: [{name, values}], mark, done}, or of the kind "points", with a number
// on the x axis too: {kind, x: {label}, y, series: [{name, points: [[x, y, low, high], …]}], done}
// The kind "bars" has the data of lines.
// A mark is the place of a value of x; the figure's data-chart-mark, with the event chart:mark, moves it.
import { BarChart, CustomChart, LineChart } from "echarts/charts";
import { AriaComponent, GridComponent, MarkLineComponent, TooltipComponent } from "echarts/components";
import { init, use } from "echarts/core";
import { LabelLayout } from "echarts/features";
import { CanvasRenderer } from "echarts/renderers";
import { optionOf } from "./chart-options.js";
import { showTable } from "./chart-table.js";

use([BarChart, CustomChart, LineChart, AriaComponent, GridComponent, MarkLineComponent, TooltipComponent, LabelLayout, CanvasRenderer]);

const EVERY = 5000;
const reduced = matchMedia("(prefers-reduced-motion: reduce)");

function readEmbedded(figure) {
  const script = figure.querySelector('script[type="application/json"]');
  return script ? JSON.parse(script.textContent) : null;
}

async function fetchData(address) {
  const answer = await fetch(address, { headers: { Accept: "application/json" } });
  const type = answer.headers.get("Content-Type") ?? "";
  return answer.ok && type.includes("json") ? answer.json() : null;
}

class Chart {
  constructor(figure) {
    this.figure = figure;
    this.canvas = figure.querySelector(".chart-canvas");
    this.drawn = init(this.canvas, null, { renderer: "canvas" });
    this.data = null;
    this.text = "";
    this.resizing = new ResizeObserver(() => this.drawn.resize());
    this.resizing.observe(this.canvas);
    this.redraw = () => this.draw();
    document.documentElement.addEventListener("theme:change", this.redraw);
    figure.addEventListener("chart:mark", this.redraw);
  }

  show(data) {
    const text = JSON.stringify(data);
    if (text === this.text) return;
    this.text = text;
    this.data = data;
    this.draw();
    showTable(this.figure, data);
  }

  draw() {
    if (!this.data) return;
    const { chartMark } = this.figure.dataset;
    const data = chartMark === undefined ? this.data : { ...this.data, mark: Number(chartMark) };
    const motion = { animation: !reduced.matches, animationDuration: 120 };
    this.drawn.setOption({ ...optionOf(data, this.canvas), ...motion }, { notMerge: true });
  }

  // A chart that htmx took away is let go.
  isGone() {
    if (this.figure.isConnected) return false;
    this.resizing.disconnect();
    document.documentElement.removeEventListener("theme:change", this.redraw);
    this.drawn.dispose();
    return true;
  }

  async follow(address) {
    if (this.isGone()) return;
    const data = document.hidden ? null : await fetchData(address).catch(() => null);
    if (data) this.show(data);
    if (!data?.done) setTimeout(() => this.follow(address), EVERY);
  }
}

export function enhance(figure) {
  const chart = new Chart(figure);
  const embedded = readEmbedded(figure);
  if (embedded) chart.show(embedded);
  if (figure.dataset.chartUrl) chart.follow(figure.dataset.chartUrl);
}
