// What is there at first: the panel and the surface at rest. All the rest runs after they are on the screen.

const byId = (id) => document.getElementById(id);

function fillPanel(data) {
  byId("title").textContent = data.title;
  byId("generator").textContent = data.generator;
  byId("command").textContent = data.command;
  for (const [name, value] of Object.entries(data.facts)) {
    const fact = document.createElement("div");
    fact.append(Object.assign(document.createElement("dt"), { textContent: name }),
      Object.assign(document.createElement("dd"), { textContent: value.toLocaleString("en") }));
    byId("facts").append(fact);
  }
}

/** After what was drawn is on the screen. */
const drawn = () => new Promise((done) => { requestAnimationFrame(() => setTimeout(done, 0)); });

/** Runs the scripts that wait for the first picture, in their order. */
function runTheRest() {
  for (const text of document.querySelectorAll("script.after-first")) {
    const script = document.createElement("script");
    script.textContent = text.textContent;
    text.replaceWith(script);
  }
}

const contents = contentsOf(JSON.parse(byId("page-data").textContent));
fillPanel(contents.data);
addPoster(byId("picture"), contents.surface);
document.addEventListener("DOMContentLoaded", async () => {
  await drawn();
  contents.firstPicture_ms = performance.now();
  runTheRest();
});
