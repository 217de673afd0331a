// The colour scale with its ticks, and histograms.

/** Round numbers from low to high, about `count` of them. */
function niceTicks(low, high, count) {
  if (!(high > low)) return [low];
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6 * step; ++i) ticks.push(i * step);
  return ticks;
}

/** All numbers with the digits that the finest of them needs. */
function tickTexts(ticks) {
  const step = ticks.length > 1 ? ticks[1] - ticks[0] : Math.abs(ticks[0]) || 1;
  const digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-6));
  return ticks.map((tick) => numberText(tick, digits));
}

function element(name, attributes = {}, ...children) {
  const svg = ["svg", "g", "rect", "line", "text", "path", "title", "circle"].includes(name);
  const node = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "class") node.setAttribute("class", value);
    else if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (value !== false && value !== undefined) node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

const withUnit = (text, unit) => (unit ? `${text}, ${unit}` : text);

function gradient(scale) {
  const stops = [];
  for (let i = 0; i <= 24; ++i) stops.push(cssColor(scale.color(scale.low + ((scale.high - scale.low) * i) / 24)));
  return `linear-gradient(to right, ${stops.join(",")})`;
}

/** Round numbers well within a scale, for between those at its ends. */
function innerTicks(scale) {
  const room = 0.2 * (scale.high - scale.low);
  return niceTicks(scale.low, scale.high, 4).filter((t) => t > scale.low + room && t < scale.high - room);
}

/** The labels that a legend has room for, and what tells of the others. */
function shownLabels({ low, high }) {
  const first = Math.max(0, low);
  const end = Math.min(high + 1, first + 10);
  const labels = [];
  for (let label = first; label < end; ++label) labels.push(label);
  return { labels, rest: high + 1 > end ? `to ${high}` : "" };
}

/** Fills `box` with the scale of an attribute. Both ends have their numbers. */
function drawLegend(box, attribute, scale) {
  box.replaceChildren(element("div", { class: "legend-title" }, withUnit(attribute.label, attribute.unit)));
  if (scale.labels) {
    const row = element("div", { class: "legend-labels" });
    const { labels, rest } = shownLabels(attribute);
    for (const label of labels)
      row.append(element("span", { style: `--swatch:${cssColor(scale.color(label))}` }, String(label)));
    if (rest) row.append(element("em", {}, rest));
    box.append(row);
    return;
  }
  const axis = element("div", { class: "legend-ticks" });
  const ticks = scale.high > scale.low ? innerTicks(scale) : [];
  const texts = tickTexts(ticks);
  ticks.forEach((tick, i) => {
    const at = (100 * (tick - scale.low)) / (scale.high - scale.low);
    axis.append(element("span", { style: `left:${at.toFixed(2)}%` }, texts[i]));
  });
  for (const end of ["low", "high"]) axis.append(element("span", { class: end }, brief(scale[end])));
  box.append(element("div", { class: "legend-bar", style: `background:${gradient(scale)}` }), axis);
}

/** Counts in bins as an SVG; `color`: of a value. */
function drawHistogram(h, color) {
  const width = 340;
  const height = 96;
  const left = 4;
  const base = 72;
  const most = Math.max(1, ...h.counts);
  const bin = (width - 2 * left) / h.counts.length;
  const x = (value) => left + ((value - h.low) / (h.high - h.low || 1)) * (width - 2 * left);
  const svg = element("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": h.title });
  h.counts.forEach((count, i) => {
    if (count === 0) return;
    const tall = Math.max(1, ((base - 6) * count) / most);
    const from = h.low + ((h.high - h.low) * i) / h.counts.length;
    const to = h.low + ((h.high - h.low) * (i + 1)) / h.counts.length;
    svg.append(element("rect", { x: left + i * bin + 0.5, y: base - tall, width: Math.max(0.5, bin - 1), height: tall,
      fill: cssColor(color((from + to) / 2)) },
    element("title", {}, `${numberText(from)} to ${numberText(to)}: ${count.toLocaleString("en")}`)));
  });
  svg.append(element("line", { x1: left, x2: width - left, y1: base, y2: base, class: "axis" }));
  const ticks = niceTicks(h.low, h.high, 5);
  const texts = tickTexts(ticks);
  ticks.forEach((tick, i) => {
    const anchor = x(tick) < 14 ? "start" : x(tick) > width - 14 ? "end" : "middle";
    svg.append(element("line", { x1: x(tick), x2: x(tick), y1: base, y2: base + 4, class: "axis" }),
      element("text", { x: x(tick), y: base + 17, "text-anchor": anchor }, texts[i]));
  });
  for (const kind of ["halo", "mean"])
    svg.append(element("line", { x1: x(h.mean), x2: x(h.mean), y1: 2, y2: base, class: kind }));
  return svg;
}
