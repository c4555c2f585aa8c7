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
    axisLabel: { color: palette.quiet, fontSize: 12, hideOverlap: true },
    axisLine: { lineStyle: { color: palette.line } },
    axisTick: { show: false },
  };
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
  const longest = Math.max(...data.series.map((one) => one.name.length));
  return {
    textStyle: { fontFamily: palette.font, color: palette.ink },
    aria: { enabled: true },
    grid: {
      left: 8,
      right: longest * 6.5 + 12,
      top: 32,
      bottom: data.x.label ? 32 : 8,
      containLabel: true,
    },
    tooltip: tooltipOf(palette),
    xAxis: categoryAxis(data.x, palette),
    yAxis: valueAxis(data.y, palette),
    series: data.series.map((one, at) => ({
      ...lineOf(one, palette.series[at]),
      markLine: at === 0 ? markOf(data.mark, palette) : undefined,
    })),
  };
}
