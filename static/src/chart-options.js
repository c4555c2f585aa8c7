// From our chart data to ECharts' options, in the colours of the theme that holds now.

// Not the hues of the entity classes, which mean something.
const HUES = ["--accent", "--ink-2", "--good", "--warn", "--bad", "--ink-3"];

// Custom properties keep light-dark() unresolved, so that an element is asked for the colour.
function colourReader(element) {
  const probe = document.createElement("i");
  element.append(probe);
  const read = (name) => {
    probe.style.color = `var(${name})`;
    return getComputedStyle(probe).color;
  };
  return [read, () => probe.remove()];
}

function paletteOf(element, series) {
  const [read, done] = colourReader(element);
  const palette = {
    ink: read("--ink"),
    quiet: read("--ink-2"),
    line: read("--line"),
    surface: read("--surface"),
    series: series.map((_, at) => read(HUES[at % HUES.length])),
    font: getComputedStyle(element).fontFamily,
  };
  done();
  return palette;
}

function valueAxis(axis, palette) {
  return {
    type: "value",
    name: [axis?.label, axis?.unit].filter(Boolean).join(", "),
    nameTextStyle: { color: palette.quiet, align: "left" },
    min: axis?.min ?? 0, // losses and accuracies start at zero
    max: axis?.max,
    interval: axis?.max === 100 ? 25 : undefined,
    splitNumber: 4,
    axisLabel: { color: palette.quiet, fontSize: 12 },
    splitLine: { lineStyle: { color: palette.line } },
  };
}

function categoryAxis(axis, palette) {
  return {
    type: "category",
    data: axis.values.map(String),
    name: axis.label,
    nameLocation: "middle",
    nameGap: 26,
    nameTextStyle: { color: palette.quiet },
    axisLabel: { color: palette.quiet, fontSize: 12, hideOverlap: true, ...(axis.ticks && roundLabels(axis)) },
    axisLine: { lineStyle: { color: palette.line } },
    axisTick: { show: false },
  };
}

// Labels at round numbers, each where the nearest of the values stands.
function roundLabels({ values, ticks }) {
  const distance = (tick) => (at) => Math.abs(values[at] - tick);
  const nearest = (tick) => [...values.keys()].reduce((best, at) => (distance(tick)(at) < distance(tick)(best) ? at : best));
  const labels = new Map(ticks.map((tick) => [nearest(tick), String(tick)]));
  return { interval: (at) => labels.has(at), formatter: (_, at) => labels.get(at) ?? "" };
}

function lineOf(one, colour) {
  return {
    type: "line",
    name: one.name,
    data: one.values,
    connectNulls: true, // a curve may be measured at some epochs only
    symbol: "circle",
    symbolSize: 4,
    showSymbol: one.values.length < 40,
    lineStyle: { width: 2, color: colour },
    itemStyle: { color: colour },
    // The name stands at the end of its line.
    endLabel: { show: true, formatter: "{a}", color: colour, fontSize: 12, lineHeight: 16 },
    labelLayout: { moveOverlap: "shiftY" },
    emphasis: { disabled: true },
  };
}

// Bars side by side. The name, with a square in their colour, stands above the chart, `right` pixels from its left edge
// at most: on the bars it would cover those of another series.
function barsOf(one, colour, right) {
  return {
    type: "bar",
    name: one.name,
    data: one.values.map((value, at) => (at === 0 ? { value, label: { show: true } } : value)),
    barGap: "0%",
    barCategoryGap: "20%",
    itemStyle: { color: colour },
    label: { formatter: "\u25a0 {a}", color: colour, fontSize: 12 },
    labelLayout: { x: right, y: 12, align: "right", verticalAlign: "middle" },
    emphasis: { disabled: true },
  };
}

const BAR_NAME = 6.5; // pixels of a letter
const widthOfName = (one) => BAR_NAME * one.name.length + 28;

// A line across the chart at one value of x.
function markOf(mark, palette) {
  if (mark == null) return undefined;
  return {
    silent: true,
    symbol: "none",
    animation: false,
    label: { show: false },
    lineStyle: { color: palette.ink, type: "solid", width: 1 },
    data: [{ xAxis: mark }],
  };
}

// Points [x, y, low, high] as a line, and each interval as a bar with ends. The name, at most `width` wide, stands at the end.
function pointsOf(one, colour, width) {
  return [
    {
      type: "line",
      name: one.name,
      data: one.points.map(([x, y]) => [x, y]),
      symbol: "circle",
      symbolSize: 7,
      lineStyle: { width: 2, color: colour },
      itemStyle: { color: colour },
      endLabel: { show: true, formatter: "{a}", color: colour, fontSize: 12, lineHeight: 16, width, overflow: "break" },
      labelLayout: { moveOverlap: "shiftY" },
      emphasis: { disabled: true },
    },
    {
      type: "custom",
      name: one.name,
      data: one.points,
      encode: { x: 0, y: [2, 3] },
      tooltip: { show: false },
      silent: true,
      renderItem: (_, api) => barWithEnds(api, colour),
    },
  ];
}

function barWithEnds(api, colour) {
  const [x, low] = api.coord([api.value(0), api.value(2)]);
  const [, high] = api.coord([api.value(0), api.value(3)]);
  const line = (x1, y1, x2, y2) => ({ type: "line", shape: { x1, y1, x2, y2 }, style: { stroke: colour, lineWidth: 1, opacity: 0.6 } });
  return {
    type: "group",
    children: [line(x, low, x, high), line(x - 4, low, x + 4, low), line(x - 4, high, x + 4, high)],
  };
}

function tooltipOf(palette) {
  return {
    trigger: "axis",
    renderMode: "richText", // no HTML, hence nothing that the page's policy refuses
    backgroundColor: palette.surface,
    borderColor: palette.line,
    textStyle: { color: palette.ink, fontSize: 13 },
    axisPointer: { type: "line", lineStyle: { color: palette.line } },
    valueFormatter: (value) => (value == null ? "–" : Number(value).toLocaleString("en", { maximumFractionDigits: 3 })),
  };
}

function numberAxis(axis, palette) {
  return {
    ...categoryAxis({ ...axis, values: [] }, palette),
    type: "value",
    data: undefined,
    min: 0,
    splitLine: { show: false },
  };
}

/** ECharts' options for our `data`, drawn into `element`. */
export function optionOf(data, element) {
  const palette = paletteOf(element, data.series);
  const isPoints = data.kind === "points";
  const isBars = data.kind === "bars";
  const longest = Math.max(...data.series.map((one) => one.name.length)) * 6.5;
  const nameWidth = isPoints ? Math.min(longest, 0.35 * element.clientWidth) : longest;
  return {
    textStyle: { fontFamily: palette.font, color: palette.ink },
    aria: { enabled: true },
    grid: {
      left: 8,
      right: isBars ? 8 : nameWidth + 12,
      top: 32,
      bottom: data.x.label ? 32 : 8,
      containLabel: true,
    },
    tooltip: tooltipOf(palette),
    xAxis: isPoints ? numberAxis(data.x, palette) : categoryAxis(data.x, palette),
    yAxis: valueAxis(data.y, palette),
    series: data.series.flatMap((one, at) => {
      const colour = palette.series[at];
      if (isPoints) return pointsOf(one, colour, nameWidth + 12);
      if (isBars) {
        const after = data.series.slice(at + 1).reduce((width, each) => width + widthOfName(each), 0);
        return barsOf(one, colour, element.clientWidth - 8 - after);
      }
      return { ...lineOf(one, colour), markLine: at === 0 ? markOf(data.mark, palette) : undefined };
    }),
  };
}
