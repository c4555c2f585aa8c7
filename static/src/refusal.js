// The slider over the bounds of a risk–coverage curve (templates/parser_service/results/_refusal.html): what the page holds
// about the chosen point is shown, the chart marks it, and the URL names its bound.

function keepInAddress(bound) {
  const address = new URL(location.href);
  if (bound) address.searchParams.set("bound", bound);
  else address.searchParams.delete("bound");
  history.replaceState(history.state, "", address);
}

export function enhance(panel) {
  const points = JSON.parse(panel.querySelector(":scope > script").textContent);
  const slider = panel.querySelector("input[type=range]");
  const facts = panel.querySelectorAll("[data-refusal-fact]");
  const chart = panel.querySelector("[data-chart]");

  function show() {
    const [, shown, sentence, ...values] = points[slider.valueAsNumber];
    panel.querySelector("[data-refusal-bound]").textContent = shown;
    panel.querySelector("[data-refusal-sentence]").textContent = sentence;
    facts.forEach((fact, at) => (fact.textContent = values[at]));
    slider.setAttribute("aria-valuetext", sentence);
    chart.dataset.chartMark = slider.value;
    chart.dispatchEvent(new CustomEvent("chart:mark"));
  }

  slider.addEventListener("input", show);
  // Browsers bound how often an address may change, so it follows when the slider rests.
  slider.addEventListener("change", () => keepInAddress(points[slider.valueAsNumber][0]));
}
