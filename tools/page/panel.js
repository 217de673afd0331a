// The panel beside the picture.

const byId = (id) => document.getElementById(id);

/** Cells with numbers are right-aligned. */
const isNumber = (text) => /^[-+]?[\d.,]+(e[-+]?\d+)?$/i.test(text);

/** Tables of names and values, as in most reports, need no column headings. */
function propertyTable(rows) {
  return element("table", { class: "properties" }, element("tbody", {}, ...rows.map(([name, value]) =>
    element("tr", {}, element("th", {}, name), element("td", {}, value)))));
}

function tableElement({ columns, rows }) {
  if (columns.length === 2 && columns[0] === "property") return propertyTable(rows);
  const numeric = columns.map((column, i) =>
    rows.length > 0 && rows.every((row) => row[i] === "" || row[i] === "-" || isNumber(row[i])));
  const cell = (kind, text, i) => element(kind, numeric[i] ? { class: "number" } : {}, text);
  const head = element("tr", {}, ...columns.map((text, i) => cell("th", text, i)));
  const body = rows.map((row) => element("tr", {}, ...row.map((text, i) => cell(i === 0 ? "th" : "td", text, i))));
  return element("div", { class: "scroll", tabindex: 0 },
    element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)));
}

/** A section that opens under its heading; `open`: initially open. */
function fold(title, open, ...content) {
  return element("details", { open }, element("summary", {}, title), ...content);
}

function fillHeader(page) {
  byId("verb").textContent = `vmesh ${page.verb}`;
  byId("title").textContent = page.title;
  for (const [name, value] of page.facts)
    byId("facts").append(element("div", {}, element("dt", {}, name),
      element("dd", value === "no" ? { class: "bad" } : {}, value)));
  byId("warnings").append(...page.warnings.map((text) => element("p", {}, text)));
  byId("warnings").hidden = page.warnings.length === 0;
}

/** `go(i)` is called for the place chosen. Returns a function that marks a place in the list. */
function fillPlaces(page, go) {
  const list = byId("places");
  page.places.forEach((place, i) => {
    list.append(element("li", {}, element("button", { type: "button", onclick: () => go(i), "data-place": i + 1,
      title: `at ${place.at.map((x) => numberText(x)).join(", ")} mm` },
      element("span", { class: "badge" }, String(i + 1)), element("span", { class: "what" }, place.label),
      element("span", { class: "value" }, place.value))));
  });
  if (page.frames) byId("places-title").textContent = "Moved farthest";
  byId("places-part").hidden = page.places.length === 0;
  return (chosen) => {
    [...list.children].forEach((item, i) => item.firstChild.setAttribute("aria-current", String(i === chosen)));
  };
}

function fillHistograms(page) {
  for (const h of page.histograms) {
    const scale = makeScale(h);
    const say = (value) => numberText(value, h.high - h.low > 50 ? 1 : 3);
    const text = `mean ${say(h.mean)} · 95 % below ${say(h.p95)} · ${say(h.min)} to ${say(h.max)}`;
    byId("histograms").append(element("figure", {},
      element("figcaption", {}, element("b", {}, withUnit(h.title, h.unit)), element("span", {}, text)),
      drawHistogram(h, scale.color)));
  }
  byId("histograms-part").hidden = page.histograms.length === 0;
}

function fillReport(page) {
  for (const [caption, source] of page.pictures)
    byId("pictures").append(element("figure", {}, element("img", { src: source, alt: caption }),
      element("figcaption", {}, caption)));
  byId("report").append(...page.tables.map((table, i) => fold(table.title, i === 0, tableElement(table))));
  byId("report-part").hidden = page.tables.length === 0 && page.pictures.length === 0;
  byId("command").textContent = page.command_line;
  byId("options").textContent = page.options;
  byId("options-part").hidden = page.options === "";
  byId("generator").textContent = `${page.generator.name} ${page.generator.version}`;
}

function fillSelect(select, options) {
  select.replaceChildren(...options.map(([value, text]) => element("option", { value }, text)));
}

/** Shows the values of a vertex, and of the face on which it was picked. */
function showPicked(surface, vertex, face, origin) {
  const rows = [];
  const where = [0, 1, 2].map((axis) => numberText(surface.positions[3 * vertex + axis] + origin[axis], 2));
  rows.push(["Position, mm", where.join("  ")]);
  for (const attribute of surface.attributes) {
    const value = attribute.value(attribute.onFaces ? face : vertex);
    const name = attribute.onFaces ? `${attribute.label} of face ${face}` : attribute.label;
    const text = attribute.labels && value < 0 ? "none" : numberText(value, attribute.digits);
    rows.push([withUnit(name, attribute.unit), text]);
  }
  byId("picked-name").textContent = `Vertex ${vertex}`;
  byId("picked-values").replaceChildren(...rows.map(([name, value]) =>
    element("div", {}, element("dt", {}, name), element("dd", {}, value))));
  byId("picked").hidden = false;
}
