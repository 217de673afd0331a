// Colour scales, computed in OKLab (Ottosson, 2020), whose L is perceived lightness. Along a scale of values L
// rises evenly, so that it remains readable with colour blindness.

function linearRgb(L, a, b) {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

function encoded(channel) {
  const c = Math.min(1, Math.max(0, channel));
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
}

/** sRGB of a lightness, chroma and hue in degrees; with less chroma where sRGB cannot represent it. */
function oklch(L, chroma, hue) {
  const angle = (hue * Math.PI) / 180;
  for (let share = 1; ; share -= 0.05) {
    const a = share * chroma * Math.cos(angle);
    const b = share * chroma * Math.sin(angle);
    const rgb = linearRgb(L, a, b);
    if (share <= 0 || rgb.every((c) => c >= -0.001 && c <= 1.001)) return rgb.map(encoded);
  }
}

const MISSING = [150, 150, 150];
const SCALE_STEPS = 256;

function table(color) {
  const colors = [];
  for (let i = 0; i < SCALE_STEPS; ++i) colors.push(color(i / (SCALE_STEPS - 1)));
  return colors;
}

/** From violet over teal to yellow. */
const SEQUENTIAL = table((t) => oklch(0.3 + 0.62 * t, 0.15, 300 - 195 * t));
/** From light blue over dark grey to light orange: for values below and above zero, the farthest from it brightest. */
const DIVERGING = table((t) => {
  const s = 2 * t - 1;
  return oklch(0.32 + 0.54 * Math.abs(s), 0.15 * Math.abs(s), s < 0 ? 245 : 65);
});

/** A colour for a label: distinct hues, and three lightnesses for colour blindness. */
function labelColor(label) {
  if (!(label >= 0)) return MISSING;
  return oklch([0.72, 0.55, 0.85][label % 3], 0.12, (25 + 137.508 * label) % 360);
}

/**
 * Values from `low` to `high` to colours, so that what is farthest from zero is brightest. Values on both sides of zero
 * get the scale that is dark there.
 */
function makeScale({ low, high, labels = false }) {
  if (labels) return { labels, low, high, color: labelColor };
  const reach = Math.max(-low, high);
  const signed = Math.min(-low, high) > 0.2 * reach;  // if one side has hardly any values, the other gets all colours
  const falling = !signed && -low > high;
  const from = signed ? -reach : low;
  const to = signed ? reach : high;
  const colors = signed ? DIVERGING : SEQUENTIAL;
  const width = to > from ? to - from : 1;
  const color = (value) => {
    if (!isFinite(value)) return MISSING;
    const t = Math.min(1, Math.max(0, (value - from) / width));
    return colors[Math.round((falling ? 1 - t : t) * (SCALE_STEPS - 1))];
  };
  return { labels, low: from, high: to, color };
}

const cssColor = (rgb) => `rgb(${rgb.join(",")})`;
