// Directions of the patient (LPS: x to the left, y to the back, z up) and the small axes that show and select them.

const DIRECTIONS = {
  A: { name: "anterior", at: [0, -1, 0] }, P: { name: "posterior", at: [0, 1, 0] },
  L: { name: "left", at: [1, 0, 0] }, R: { name: "right", at: [-1, 0, 0] },
  S: { name: "superior", at: [0, -0.0001, 1] }, I: { name: "inferior", at: [0, -0.0001, -1] },
};
const AXES = [["R", "L"], ["A", "P"], ["I", "S"]];

/** Draws axes into `svg` whenever the scene is drawn; a click on a letter moves the camera there. */
function addAxes(svg, scene, look) {
  const reach = 27;
  const parts = AXES.map(([minus, plus]) => {
    const line = element("line", { class: "axis-line" });
    const letters = [minus, plus].map((letter) => {
      const text = element("text", { "text-anchor": "middle", dy: "0.35em" }, letter);
      const disc = element("circle", { r: 9 });
      const button = element("g", { class: "axis-letter", role: "button", tabindex: 0,
        "aria-label": `look from ${DIRECTIONS[letter].name}`,
        onclick: () => look(letter),
        onkeydown: (event) => {
          if (event.key === "Enter") look(letter);
        } }, element("title", {}, `from ${DIRECTIONS[letter].name}`), disc, text);
      return { letter, button };
    });
    svg.append(line);
    return { line, letters };
  });
  for (const { letters } of parts) svg.append(...letters.map(({ button }) => button));
  scene.afterDrawing.push(() => {
    const turn = scene.camera.quaternion.clone().invert();
    for (const { line, letters } of parts) {
      const ends = letters.map(({ letter, button }) => {
        const v = new THREE.Vector3(...DIRECTIONS[letter].at).normalize().applyQuaternion(turn);
        const x = 40 + reach * v.x;
        const y = 40 - reach * v.y;
        button.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
        button.classList.toggle("behind", v.z < -0.3);
        button.classList.toggle("covered", v.z < -0.93);
        return { x, y };
      });
      line.setAttribute("x1", ends[0].x);
      line.setAttribute("y1", ends[0].y);
      line.setAttribute("x2", ends[1].x);
      line.setAttribute("y2", ends[1].y);
    }
  });
}
