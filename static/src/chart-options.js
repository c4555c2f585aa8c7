// From our chart data to ECharts' options, in the colours of the theme that holds now.

// What the labels of the right axis take.
const AXIS_WIDTH = 34;
// Below this share of the axis a bar has no room for its name.
const SHORT = 0.4;
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
    series: series.map((one, at) => read(one.class ? `--class-${one.class}` : HUES[at % HUES.length])),
    font: getComputedStyle(element).fontFamily,
  };
  done();
  return palette;
}

function valueAxis(axis, palette, position) {
  return {
    type: "value",
    position,
    name: [axis?.label, axis?.unit].filter(Boolean).join(", "),
    nameTextStyle: { color: palette.quiet, align: position === "right" ? "right" : "left" },
    min: axis?.min ?? 0, // bars and losses start at zero
    max: axis?.max,
    interval: axis?.max === 100 ? 25 : undefined,
    splitNumber: 4,
    axisLabel: { color: palette.quiet, fontSize: 12 },
    splitLine: { show: position === "left", lineStyle: { color: palette.line } },
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
    axisLabel: { color: palette.quiet, fontSize: 12, hideOverlap: true },
    axisLine: { lineStyle: { color: palette.line } },
    axisTick: { show: false },
  };
}

const isRight = (one) => one.axis === "right";

function lineOf(one, colour, shift) {
  return {
    type: "line",
    name: one.name,
    data: one.values,
    connectNulls: true, // a curve may be measured at some epochs only
    yAxisIndex: isRight(one) ? 1 : 0,
    symbol: "circle",
    symbolSize: 4,
    showSymbol: one.values.length < 40,
    lineStyle: { width: 2, color: colour, type: isRight(one) ? [5, 3] : "solid" },
    itemStyle: { color: colour },
    // The name stands at the end of its line, beyond the right axis where there is one.
    endLabel: { show: true, formatter: "{a}", color: colour, fontSize: 12, lineHeight: 16, offset: [shift, 0] },
    labelLayout: { moveOverlap: "shiftY" },
    emphasis: { disabled: true },
  };
}

// A bar carries its series' name and value, upright; a short one has them above itself.
function labelOf(value, top, palette) {
  const isShort = value / top < SHORT;
  return {
    show: value != null,
    position: isShort ? "top" : "insideBottom",
    distance: isShort ? 16 : 8,
    rotate: 90,
    align: "left",
    verticalAlign: "middle",
    formatter: "{a}  {c}",
    color: isShort ? palette.ink : palette.surface,
    fontSize: 12,
  };
}

function barOf(one, colour, top, palette) {
  return {
    type: "bar",
    name: one.name,
    data: one.values.map((value) => ({ value, label: labelOf(value, top, palette) })),
    barMaxWidth: 36,
    itemStyle: { color: colour, borderRadius: [3, 3, 0, 0] },
    emphasis: { disabled: true },
  };
}

function whisker(x, low, high, style) {
  const line = (x1, y1, x2, y2) => ({ type: "line", shape: { x1, y1, x2, y2 }, style });
  return [line(x, low, x, high), line(x - 4, low, x + 4, low), line(x - 4, high, x + 4, high)];
}

// Intervals are drawn over their bars; the bars of several series stand side by side.
function intervalOf(one, at, count, palette) {
  return {
    type: "custom",
    name: `${one.name} interval`,
    silent: true,
    z: 5,
    tooltip: { show: false },
    data: one.values.map((_, index) => [index, one.low[index], one.high[index]]),
    renderItem(params, api) {
      const [x, low] = api.coord([api.value(0), api.value(1)]);
      const high = api.coord([api.value(0), api.value(2)])[1];
      const band = Math.min(api.size([1, 0])[0] * 0.8, 36 * 1.3 * count);
      const centre = x + (at - (count - 1) / 2) * (band / count);
      // An edge in the colour of the ground keeps the mark legible over its bar.
      return { type: "group", children: [
        ...whisker(centre, low, high, { stroke: palette.surface, lineWidth: 4 }),
        ...whisker(centre, low, high, { stroke: palette.ink, lineWidth: 1.5 }),
      ] };
    },
  };
}

function barsOf({ series, y }, palette) {
  const top = y?.max ?? Math.max(...series.flatMap((one) => one.values));
  const bars = series.map((one, at) => barOf(one, palette.series[at], top, palette));
  const intervals = series
    .map((one, at) => one.low && one.high && intervalOf(one, at, series.length, palette))
    .filter(Boolean);
  return [...bars, ...intervals];
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

/** ECharts' options for our `data`, drawn into `element`. */
export function optionOf(data, element) {
  const palette = paletteOf(element, data.series);
  const hasRight = data.series.some(isRight);
  const isBars = data.kind === "bars";
  const yAxes = [valueAxis(data.y, palette, "left")];
  if (hasRight) yAxes.push(valueAxis(data.y_right, palette, "right"));
  const longest = Math.max(...data.series.map((one) => one.name.length));
  return {
    textStyle: { fontFamily: palette.font, color: palette.ink },
    aria: { enabled: true },
    grid: {
      left: 8,
      right: isBars ? 8 : longest * 6.5 + 12,
      top: 32,
      bottom: data.x.label ? 32 : 8,
      containLabel: true,
    },
    tooltip: tooltipOf(palette),
    xAxis: categoryAxis(data.x, palette),
    yAxis: yAxes,
    series: isBars
      ? barsOf(data, palette)
      : data.series.map((one, at) => lineOf(one, palette.series[at], hasRight ? AXIS_WIDTH : 0)),
  };
}
