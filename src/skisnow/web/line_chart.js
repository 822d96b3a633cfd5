// Lines over one quantity, as SVG: small, so that a page with several is there at once and follows the hand.
import { toRaw } from "vue";

const LEFT = 70, RIGHT = 12, EDGE = 10, BOTTOM = 48, TICK = 6, LEGEND = 22, LETTER = 8.2;
const FONT = "14px system-ui, sans-serif", APART = 8, ROW = 18, ONE_ROW = 6 + LEGEND;
const INK = "#14181c", GRID = "#d8dee4", ZERO = "#8b96a1";

function made(kind, attributes, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", kind);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

const canvas = document.createElement("canvas").getContext("2d");

function wide(text) {
  canvas.font = FONT;
  return canvas.measureText(text).width;
}

// Whether the name of the axis and the words at its ends lie over one another in one row of this length.
const crowded = (name, ends, length) => wide(name) / 2 + Math.max(...ends.map(wide)) + APART > length / 2;

// 1, 2 or 5 times a power of ten, so that at most `most` steps lie between the ends.
function stepOf(span, most) {
  const power = 10 ** Math.floor(Math.log10(span / most));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => span / step <= most);
}

function extent(values, fromZero) {
  let low = Infinity, high = -Infinity;
  for (const value of values) if (Number.isFinite(value)) { low = Math.min(low, value); high = Math.max(high, value); }
  if (low > high) [low, high] = [0, 1];
  if (fromZero) low = Math.min(low, 0);
  const margin = 0.05 * (high - low) || Math.abs(high) * 0.1 || 1;
  return [fromZero && low === 0 ? 0 : low - margin, high + margin];
}

function ticks([first, second], length, apart) {
  const low = Math.min(first, second), high = Math.max(first, second);
  const step = stepOf(high - low, Math.max(2, length / apart));
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i <= high / step + 1e-9; i += 1) {
    found.push([i * step, (i * step).toFixed(digits).replace("-", "−").replace(/^−(0(\.0+)?)$/, "$1")]);
  }
  return found;
}

const scale = ([from, to], low, high) => (value) => low + ((value - from) / (to - from)) * (high - low);

function pathOf(line, across, up) {
  let text = "", pen = "M";
  line.x.forEach((x, i) => {
    const y = line.y[i];
    if (x === null || y === null || y === undefined) { pen = "M"; return; }
    text += `${pen}${across(x).toFixed(1)} ${up(y).toFixed(1)}`;
    pen = "L";
  });
  return text;
}

// One path however many there are: lines of no length with round ends.
function pointsOf(line, across, up) {
  let text = "";
  line.x.forEach((x, i) => {
    if (x !== null && line.y[i] !== null) text += `M${across(x).toFixed(1)} ${up(line.y[i]).toFixed(1)}h0`;
  });
  return text;
}

function drawn(line, { colour, dash, width, point }, across, up) {
  const style = line.points
    ? { d: pointsOf(line, across, up), "stroke-width": point, "stroke-linecap": "round", class: "points" }
    : { d: pathOf(line, across, up), "stroke-width": width, "stroke-dasharray": dash, class: "line" };
  return made("path", { ...style, stroke: colour, fill: "none" });
}

// A row of names, each behind a piece of its line; a name that does not fit begins another row. The height of it all.
function legend(lines, styles, from, to) {
  let x = from, y = EDGE + 6;
  const found = [];
  for (const line of lines.filter((each) => each.name)) {
    const { colour, dash } = styles[line.style], wide = 34 + LETTER * line.name.length;
    if (x > from && x + wide > to) [x, y] = [from, y + LEGEND - 2];
    const sample = line.points ? { d: `M${x + 12} ${y}h0`, "stroke-width": 9, "stroke-linecap": "round" }
      : { d: `M${x} ${y}h24`, "stroke-width": 2.5, "stroke-dasharray": dash };
    found.push(made("path", { ...sample, stroke: colour, fill: "none" }));
    found.push(made("text", { x: x + 30, y: y + 5, class: "name" }, line.name));
    x += wide + 14;
  }
  return [found, found.length ? y + LEGEND - EDGE : EDGE];
}

const SHARPNESS = 2; // pixels of a picture for each of the page

// All charts of the page one below the other, as one drawing with its size.
function drawing() {
  const whole = made("svg", { xmlns: "http://www.w3.org/2000/svg" });
  let width = 0, height = 0;
  for (const chart of document.querySelectorAll("[data-drawn] > svg")) {
    const copy = chart.cloneNode(true);
    for (const [name, value] of [["y", height], ["width", chart.clientWidth]]) copy.setAttribute(name, value);
    whole.append(copy);
    width = Math.max(width, chart.clientWidth), height += Number(chart.getAttribute("height"));
  }
  for (const [name, value] of [["width", width], ["height", height]]) whole.setAttribute(name, value);
  whole.prepend(made("rect", { width, height, fill: "#fff" }));
  return [new Blob([new XMLSerializer().serializeToString(whole)], { type: "image/svg+xml" }), width, height];
}

async function picture([svg, width, height]) {
  const image = new Image(), page = document.createElement("canvas");
  image.src = URL.createObjectURL(svg);
  await image.decode();
  URL.revokeObjectURL(image.src);
  page.width = SHARPNESS * width, page.height = SHARPNESS * height;
  page.getContext("2d").drawImage(image, 0, 0, page.width, page.height);
  return new Promise((done) => page.toBlob(done));
}

window.saveCharts = async (file) => {
  const drawn = drawing(), link = document.createElement("a");
  link.href = URL.createObjectURL(file.endsWith(".png") ? await picture(drawn) : drawn[0]);
  link.download = file;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
};

export default {
  template: '<div><svg role="img" style="display: block; width: 100%; touch-action: pan-y"></svg></div>',
  props: { panel: Object, height: Number, styles: Array },
  mounted() {
    this.svg = this.$el.firstChild;
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(this.$el);
    this.svg.addEventListener("pointermove", (event) => this.read(event));
    this.svg.addEventListener("pointerleave", () => this.reading?.remove());
    this.draw();
  },
  unmounted() { this.observer.disconnect(); },
  watch: { panel() { this.draw(); } },
  methods: {
    draw() {
      // without Vue's watching of each number, which takes longer than the drawing
      const panel = toRaw(this.panel), width = this.$el.clientWidth;
      if (!width) return;
      const lines = panel.lines;
      const xRange = extent(lines.flatMap((line) => line.x), panel.from_zero.includes("x"));
      const yRange = panel.range || extent(lines.flatMap((line) => line.y), panel.from_zero.includes("y"));
      const right = width - RIGHT;
      const [before, behind] = panel.ends ?? ["", ""];
      const ends = [before && `◂ ${before}`, behind && `${behind} ▸`];
      const row = (before || behind) && crowded(panel.x, ends, right - LEFT) ? ROW : 0;
      const [names, top] = legend(lines, this.styles, LEFT, right);
      const height = this.height + row + Math.max(0, top - ONE_ROW);
      const bottom = this.bottom = height - BOTTOM - row;
      this.top = top;
      this.across = scale(xRange, LEFT, right);
      this.up = scale(yRange, bottom, top);
      const children = names;
      for (const [value, text] of ticks(xRange, right - LEFT, 70)) {
        const x = this.across(value);
        children.push(made("path", { d: `M${x} ${top}V${bottom + TICK}`, stroke: value === 0 ? ZERO : GRID }));
        children.push(made("text", { x, y: bottom + 20, "text-anchor": "middle" }, text.replace(".", panel.mark)));
      }
      for (const [value, text] of ticks(yRange, bottom - top, 38)) {
        const y = this.up(value);
        children.push(made("path", { d: `M${LEFT - TICK} ${y}H${right}`, stroke: value === 0 ? ZERO : GRID }));
        children.push(made("text", { x: LEFT - 10, y: y + 5, "text-anchor": "end" }, text.replace(".", panel.mark)));
      }
      children.push(made("text", { x: (LEFT + right) / 2, y: height - 8 - row, "text-anchor": "middle" }, panel.x));
      if (before) children.push(made("text", { x: LEFT, y: height - 8, class: "end" }, ends[0]));
      if (behind) children.push(made("text", { x: right, y: height - 8, "text-anchor": "end", class: "end" }, ends[1]));
      const middle = Math.max((top + bottom) / 2, wide(panel.y) / 2 + 2);
      children.push(made("text", { x: 16, y: middle, "text-anchor": "middle", transform: `rotate(-90 16 ${middle})` }, panel.y));
      // a clip area for values beyond the range
      const inside = made("svg", { x: LEFT, y: top, width: Math.max(0, right - LEFT), height: bottom - top,
                                   viewBox: `${LEFT} ${top} ${Math.max(1, right - LEFT)} ${bottom - top}` });
      inside.append(...lines.map((line) => drawn(line, this.styles[line.style], this.across, this.up)));
      this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      this.svg.setAttribute("height", height);
      this.svg.setAttribute("aria-label", panel.label);
      this.svg.style.font = FONT;
      this.svg.style.fill = INK;
      this.svg.replaceChildren(...children, inside);
      this.$el.dataset.drawn = Number(this.$el.dataset.drawn || 0) + 1;
    },
    // Values at the pointer.
    read(event) {
      this.reading?.remove();
      const x = (event.clientX - this.svg.getBoundingClientRect().left);
      const nearest = toRaw(this.panel).lines.filter((line) => this.styles[line.style].read).map((line) => {
        let best = -1;
        line.x.forEach((value, i) => {
          if (value === null) return;
          if (best < 0 || Math.abs(this.across(value) - x) < Math.abs(this.across(line.x[best]) - x)) best = i;
        });
        return best < 0 ? null : [line.x[best], line.y[best]];
      }).filter((pair) => pair && pair[1] !== null && pair[1] !== undefined);
      if (!nearest.length) return;
      const at = this.across(nearest[0][0]), text = nearest.map((pair) => pair[1].toPrecision(3)).join(" · ");
      this.reading = made("g", { "aria-hidden": "true" });
      this.reading.append(
        made("path", { d: `M${at} ${this.top}V${this.bottom}`, stroke: INK }),
        made("text", { x: at > this.svg.clientWidth / 2 ? at - 6 : at + 6, y: this.top + 14, "font-weight": 700,
                       "text-anchor": at > this.svg.clientWidth / 2 ? "end" : "start",
                       stroke: "#fff", "stroke-width": 4, "paint-order": "stroke" },
             `${nearest[0][0].toFixed(3)}: ${text}`.replaceAll("-", "−").replaceAll(".", toRaw(this.panel).mark)));
      this.svg.append(this.reading);
    },
  },
};
