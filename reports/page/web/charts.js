"use strict";

// Charts: values of reports/charts/wire.py, drawn as SVG with d3.
const charts = { views: new Map(), waiting: new Set(), late: new Set() };
const FONT = "system-ui, sans-serif", pen = document.createElement("canvas").getContext("2d");
// Pixels of text, of names and of points, and how near a pointer must come.
const TEXT = 12, NAME = 11, POINT = 4.4, NEAR = 28;
const set = (selection, given) => Object.entries(given).reduce((made, [name, value]) => made.attr(name, value), selection);

function widthOf(text, size) {
  pen.font = `${size}px ${FONT}`;
  return pen.measureText(text).width;
}

// Text without room loses its middle: codecs differ at the ends.
function fitted(text, room, size = TEXT) {
  let left = text.length, short = text;
  while (left > 2 && widthOf(short, size) > room) {
    left--;
    short = `${text.slice(0, Math.ceil(left / 2))}\u2026${text.slice(text.length - Math.floor(left / 2))}`;
  }
  return short;
}

// Columns as rows; of words a column has each once, and which of them each row has.
function rowsOf(table) {
  const rows = [];
  for (const [field, column] of Object.entries(table)) {
    const values = column.names ? column.places.map((place) => column.names[place]) : column;
    values.forEach((value, at) => ((rows[at] ??= {})[field] = value));
  }
  return rows;
}

// To where equal steps have equal lengths, and back.
const ALONG = {
  linear: () => [(value) => value, (at) => at],
  log: () => [Math.log10, (at) => 10 ** at],
  count: (bend) => [(value) => Math.sign(value) * Math.log1p(Math.abs(value) / bend), (at) => Math.sign(at) * Math.expm1(Math.abs(at)) * bend],
};

class Axis {
  constructor(axis, low, high, zoomed) {
    this.axis = axis;
    this.names = axis.names && d3.scaleBand().domain(axis.names).range([low, high].sort(d3.ascending));
    if (this.names) return;
    [this.along, this.back] = ALONG[axis.scale](axis.linear_to);
    this.scale = zoomed(d3.scaleLinear().domain(axis.domain.map(this.along)).range([low, high]));
  }

  at(value) {
    return this.names ? this.names(value) + this.names.bandwidth() / 2 : this.scale(this.along(value));
  }

  get small() {
    return this.names ? clamped(this.names.bandwidth() * 0.35, 7, NAME) : NAME;
  }

  ticks(many) {
    if (this.names) return this.axis.names.map((name) => [name, name]);
    const [low, high] = this.scale.domain().map(this.back), isInside = ([value]) => value >= low && value <= high;
    const plain = (value) => [value, String(Number(value.toPrecision(10)))], said = this.axis.ticks.filter(isInside);
    if (said.length > 1 || this.axis.has_words) return said;
    if (this.axis.scale !== "log" || high < 8 * low) return d3.ticks(low, high, many).map(plain);
    const powers = d3.range(Math.floor(Math.log10(low)), Math.log10(high)), step = Math.ceil(powers.length / many);
    const digits = Math.log10(high / low) * 3 <= many ? [1, 2, 5] : [1];
    return powers.filter((_, at) => at % step === 0).flatMap((power) => digits.map((digit) => plain(digit * 10 ** power))).filter(isInside);
  }

  // As d3 draws it: at the values, with lines of a length.
  drawn(side, ticks, length) {
    const places = this.names ? null : ticks.map(([value]) => this.along(value)), made = side(this.names ?? this.scale).tickValues(places);
    return made.tickFormat((_, at) => ticks[at][1]).tickSizeOuter(0).tickPadding(8).tickSizeInner(places ? length : 0);
  }
}

// A panel; drawn anew for another width, choice or zoom.
class View {
  constructor(plot, spec, panel, id) {
    Object.assign(this, { plot, spec, panel, id, figure: plot.closest("figure"), zoom: d3.zoomIdentity, stop: -1 });
    this.tables = panel.tables.map(rowsOf);
    this.svg = set(d3.select(plot).append("svg"), { role: "img", "font-family": FONT });
    set(d3.select(plot), { tabindex: 0, role: "group" });
    this.listen();
    if (spec.zooms) this.zooming();
    this.draw();
    new ResizeObserver(() => plot.clientWidth && Math.abs(plot.clientWidth - this.width) > 1 && this.later()).observe(plot);
  }

  // One panel a frame.
  later() {
    if (charts.late.size === 0) requestAnimationFrame(drawLate);
    charts.late.add(this);
  }

  get chosen() {
    return this.figure.querySelector("[data-switch]")?.value;
  }

  // The rows that are shown; those without the field are, whatever is chosen.
  rows(mark) {
    const { field, all } = this.spec.switch ?? {}, { chosen } = this, rows = this.tables[mark.table];
    return !field || chosen === all ? rows : rows.filter((row) => row[field] == null || String(row[field]) === chosen);
  }

  draw() {
    const { svg, spec, panel, plot, zoom } = this, width = (this.width = plot.clientWidth || 600);
    const name = [panel.name, this.chosen !== spec.switch?.all && this.chosen].filter(Boolean).join(", ");
    svg.selectAll("*").remove();
    set(svg, { viewBox: `0 0 ${width} ${spec.top + spec.height + spec.bottom}`, "aria-label": (name && `${name}: `) + spec.label });
    plot.setAttribute("aria-label", `${name || "Chart"}. Arrow keys move from mark to mark.`);
    this.hits = [];
    this.axes();
    const { left, right, top, bottom } = this;
    if (name) set(svg.append("text"), { class: "title", x: left, y: 13 }).text(fitted(name, width - left));
    set(svg.append("clipPath").attr("id", this.id).append("rect"), { x: left - 6, y: top - 6, width: right - left + 12, height: bottom - top + 12 });
    const inner = svg.append("g").attr("clip-path", `url(#${this.id})`), outer = svg.append("g").attr("font-size", NAME);
    for (const mark of panel.marks) DRAW[mark.kind](this, mark.text ? outer : inner, mark, this.rows(mark));
    this.ring = svg.append("path").attr("class", "ring");
    this.stops = this.hits.filter((hit) => hit.stops);
    this.zoomer?.extent([[left, top], [right, bottom]]).translateExtent([[left, top], [right, bottom]]);
    svg.style("touch-action", zoom.k > 1 ? "none" : "pan-y");
  }

  // With room for their texts, and at the right for names at ends.
  axes() {
    const { svg, spec, panel, width, zoom } = this, top = (this.top = spec.top), bottom = (this.bottom = top + spec.height);
    this.y = new Axis(panel.y, bottom, top, (scale) => zoom.rescaleY(scale));
    const room = width * 0.48, beside = this.y.ticks(spec.height / 45).map(([value, text]) => [value, fitted(text, room)]);
    const left = (this.left = Math.ceil(d3.max(beside, ([, text]) => widthOf(text, TEXT)) ?? 0) + (panel.y.title ? 32 : 12));
    const ends = panel.marks.flatMap((mark) => (mark.kind === "ends" ? this.rows(mark).map((row) => widthOf(row[mark.text], NAME)) : []));
    this.hasEnds = d3.max(ends) < width - left - 200;
    const right = (this.right = width - (this.hasEnds ? Math.ceil(d3.max(ends)) + 24 : panel.x.names ? 4 : 16));
    this.x = new Axis(panel.x, left, right, (scale) => zoom.rescaleX(scale));
    let last = -Infinity;
    const below = this.x.ticks((right - left) / 50).map(([value, text]) => [value, fitted(text, 150)]).filter(([value, text]) => {
      const half = widthOf(text, TEXT) / 2, at = this.x.at(value);
      return (this.x.names || at - half > last + 4) && (last = at + half);
    });
    const group = (at) => set(svg.append("g"), { class: "axis", transform: `translate(${at})` });
    const across = group([0, bottom]).call(this.x.drawn(d3.axisBottom, below, top - bottom));
    if (panel.x.names) set(across.selectAll("text"), { "text-anchor": "end", transform: "rotate(-30)translate(-4,-4)", "font-size": this.x.small });
    // What is in a place of its own needs no line.
    const up = group([left, 0]).call(this.y.drawn(d3.axisLeft, beside, panel.y.has_words ? 0 : left - right));
    if (panel.y.names) up.selectAll("text").append("title").text((name) => name);
    svg.selectAll(".domain").remove();
    const title = (text, anchor, transform) => set(svg.append("text"), { class: "title", "text-anchor": anchor, transform }).text(text);
    title(fitted(panel.x.title, right), "end", `translate(${right},${bottom + spec.bottom - 6})`);
    title(fitted(panel.y.title, spec.height + 20), "middle", `translate(12,${(top + bottom) / 2})rotate(-90)`);
  }

  colour(mark, row) {
    if (mark.rest && row[mark.rest]) return mark.text ? "var(--muted)" : "var(--faint)";
    return mark.css ?? (mark.named.includes("colour") ? this.look("colour", mark, row) : row[mark.colour]);
  }

  look(name, mark, row) {
    return mark.named.includes(name) ? this.spec[name].looks[row[this.spec[name].field]] : mark[name];
  }

  place(mark, row) {
    return [this.x.at(row[mark.x]), this.y.at(row[mark.y])];
  }

  // Elements, each with its codec. The colour is a variable, for which A and B have another.
  put(group, tag, mark, data, given) {
    // A line through several codecs is of none.
    const rowOf = (one) => one[0] ?? one, codec = (one) => (one.some?.((row) => row.codec !== one[0].codec) ? "" : rowOf(one).codec ?? null);
    const made = group.selectAll(null).data(data).enter().append(tag).style("--colour", (one) => this.colour(mark, rowOf(one)));
    const is = tag === "line" || mark.kind === "lines" ? "stroked" : "filled";
    return set(made, { class: `${mark.kind} ${is}`, "data-codec": codec, ...given });
  }

  groups(mark, rows) {
    return d3.nest().key((row) => JSON.stringify((mark.by ?? []).map((field) => row[field]))).entries(rows).map(({ values }) => values);
  }

  // What a pointer finds: a place, a box, or a line to the next one.
  hit(mark, row, at, more) {
    const hit = { mark, row, at, box: [0, 0], stops: true, ...more };
    if (mark.tips) this.hits.push(hit);
    return hit;
  }

  nearest(x, y) {
    let found = null, least = NEAR;
    for (const hit of this.hits) {
      const [x0, y0] = hit.at, [x1, y1] = (hit.next ?? hit).at, [w, h] = hit.box;
      const share = clamped(((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2) || 0, 0, 1);
      const gap = (value, from, to, size) => Math.max(0, Math.abs(value - from - share * (to - from)) - size / 2);
      const away = Math.hypot(gap(x, x0, x1, w), gap(y, y0, y1, h));
      if (away < least) [found, least] = [share > 0.5 ? hit.next : hit, away];
    }
    return found;
  }

  listen() {
    const { plot } = this, node = this.svg.node();
    const under = ({ clientX, clientY }) => {
      const box = node.getBoundingClientRect(), scale = this.width / box.width;
      return this.nearest((clientX - box.left) * scale, (clientY - box.top) * scale);
    };
    node.addEventListener("pointermove", (event) => this.show(under(event), event.clientX, event.clientY));
    node.addEventListener("pointerleave", () => this.show(null));
    node.addEventListener("click", (event) => {
      pick(event.target.dataset.codec || under(event)?.row.codec, event.shiftKey);
    });
    plot.addEventListener("blur", () => this.show(null));
    plot.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const { stops, stop, zoomer } = this, { key } = event;
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1, Home: -Infinity, End: Infinity }[key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (step && stops.length) this.go(clamped(stop + step, 0, stops.length - 1));
    else if (key === "Enter" && stops[stop]) pick(stops[stop].row.codec, event.shiftKey);
    else if (key === "Escape") this.show(null);
    else if (key === "+" && zoomer) this.svg.call(zoomer.scaleBy, 1.5);
    else if (key === "0" && zoomer) this.svg.call(zoomer.transform, d3.zoomIdentity);
    else return;
    event.preventDefault();
  }

  go(stop) {
    const box = this.svg.node().getBoundingClientRect(), hit = this.stops[(this.stop = stop)];
    this.show(hit, box.left + hit.at[0], box.top + hit.at[1]);
    this.figure.querySelector("[data-said]").textContent = `${told(hit).map((said) => said.join(" ")).join(", ")}; ${stop + 1} of ${this.stops.length}`;
  }

  show(hit, x, y) {
    const [w, h] = (hit?.box ?? []).map((size) => size || 14);
    this.ring.attr("d", hit ? `M${hit.at[0] - w / 2},${hit.at[1] - h / 2}h${w}v${h}h${-w}z` : null);
    this.svg.style("cursor", hit?.row.codec ? "pointer" : null);
    tooltip(hit, x, y);
  }

  // The wheel zooms where the plot has the focus, and else moves the page.
  zooming() {
    const isOurs = ({ type, ctrlKey, button, touches }) => {
      if (type === "wheel") return ctrlKey || document.activeElement === this.plot;
      return type === "dblclick" || touches?.length > 1 || (!button && this.zoom.k > 1);
    };
    const reset = element("button", { type: "button", "data-reset": "", hidden: "" }, "Show all");
    reset.addEventListener("click", () => this.svg.call(this.zoomer.transform, d3.zoomIdentity));
    this.figure.querySelector("[data-tools]").append(reset);
    this.zoomer = d3.zoom().scaleExtent([1, 40]).duration(0).filter(() => isOurs(d3.event)).on("zoom", () => {
      this.zoom = d3.event.transform;
      reset.hidden = this.zoom.k === 1;
      this.later();
    });
    this.svg.call(this.zoomer);
  }
}

const restLast = (mark, rows) => [false, true].flatMap((is) => rows.filter((row) => Boolean(row[mark.rest]) === is));

const DRAW = {
  points(view, group, mark, rows) {
    view.put(group, "path", mark, restLast(mark, rows).reverse(), { d: (row) => view.look("shape", mark, row), transform: (row) => `translate(${view.place(mark, row)})scale(${POINT})` });
    for (const row of rows) view.hit(mark, row, view.place(mark, row));
  },

  lines(view, group, mark, rows) {
    const shape = d3.line().x((row) => view.x.at(row[mark.x])).y((row) => view.y.at(row[mark.y])), lines = view.groups(mark, rows);
    if (mark.is_stepped) shape.curve(d3.curveStepAfter);
    const dash = (line) => view.look("dash", mark, line[0]) || null, [width, opacity] = mark.is_faint ? [1.2, 0.75] : [1.6, null];
    view.put(group, "path", mark, lines, { d: shape, "stroke-opacity": opacity, "stroke-dasharray": dash }).style("--width", width);
    for (const line of lines) line.map((row) => view.hit(mark, row, view.place(mark, row))).reduce((one, next) => ((one.next = next), next));
  },

  areas(view, group, mark, rows) {
    const shape = d3.area().x((row) => view.x.at(row[mark.x])).y1((row) => view.y.at(row[mark.y])).y0((row) => view.y.at(row[mark.y2]));
    if (mark.is_stepped) shape.curve(d3.curveStepAfter);
    const areas = view.groups(mark, rows);
    view.put(group, "path", mark, areas, { d: shape });
    for (const area of areas) {
      const top = d3.max(area, (row) => row[mark.y]);
      for (const row of area) view.hit(mark, row, view.place(mark, row), { stops: row[mark.y] === top });
    }
  },

  rules(view, group, mark, rows) {
    const [x, y, x2, y2] = ["x", "y", "x2", "y2"].map((name) => (row) => view[name[0]].at(row[mark[name] ?? mark[name[0]]]));
    view.put(group, "line", mark, rows, { x1: x, y1: y, x2, y2 });
  },

  bars(view, group, mark, rows) {
    const ends = (row) => [mark.x, mark.x2].map((field) => view.x.at(row[field])), high = view.y.names.bandwidth() * 0.7;
    boxes(view, group, mark, rows, (row) => [d3.mean(ends(row)), view.y.at(row[mark.y])], (row) => [Math.max(...ends(row)) - Math.min(...ends(row)), high]);
  },

  cells(view, group, mark, rows) {
    const { low, high } = view.spec.shades, size = [view.x.names.bandwidth(), view.y.names.bandwidth()];
    const shade = (row) => d3.interpolateViridis(clamped(Math.log(row[mark.colour] / low) / Math.log(high / low), 0, 1));
    boxes(view, group, mark, rows, (row) => view.place(mark, row), () => size).style("fill", shade);
  },

  texts(view, group, mark, rows) {
    const [away, anchor] = view.x.names ? [0, "middle"] : [4, "start"];
    const given = { x: (row) => view.x.at(row[mark.x]) + away, y: (row) => view.y.at(row[mark.y]), dy: "0.35em", "text-anchor": anchor, "font-size": view.x.small };
    view.put(group, "text", mark, rows, given).text((row) => (away ? fitted(row[mark.text], view.width - given.x(row), NAME) : row[mark.text]));
  },

  // Names near their points. Others without room are seen as A or B.
  labels(view, group, mark, rows) {
    const taken = Array.from(covered(view));
    for (const row of restLast(mark, rows)) {
      const [x, y] = view.place(mark, row), text = String(row[mark.text]);
      if (x !== clamped(x, view.left, view.right) || y !== clamped(y, view.top, view.bottom)) continue;
      const { at, anchor, box, over, foot } = free(view, x, y, widthOf(text, NAME) + 2, taken), isHidden = row[mark.rest] && over > 0;
      if (!isHidden) taken.push(box);
      if (Math.hypot(at[0] - x, foot - y) > 14) leader(view, group, mark, [row], () => [[x, y], [at[0], foot]]).classed("unplaced", isHidden);
      const given = { x: at[0], y: at[1], dy: "0.35em", "text-anchor": anchor };
      view.put(group, "text", mark, [row], given).classed("unplaced", isHidden).text(text);
    }
  },

  ends(view, group, mark, rows) {
    const { right, top, bottom } = view, y = (row) => bottom - row.end * (bottom - top);
    if (!view.hasEnds) return;
    leader(view, group, mark, rows, (row) => [view.place(mark, row), [right + 14, y(row)]]);
    view.put(group, "text", mark, rows, { x: right + 18, y, dy: "0.35em" }).text((row) => row[mark.text]);
  },
};

function leader(view, group, mark, rows, endsOf) {
  const [x1, y1, x2, y2] = [0, 1, 2, 3].map((at) => (row) => endsOf(row).flat()[at]);
  return view.put(group, "line", { ...mark, kind: "leader" }, rows, { x1, y1, x2, y2 });
}

function boxes(view, group, mark, rows, middleOf, sizeOf) {
  for (const row of rows) view.hit(mark, row, middleOf(row), { box: sizeOf(row) });
  const [width, height] = [0, 1].map((side) => (row) => sizeOf(row)[side]);
  const [x, y] = [0, 1].map((side) => (row) => middleOf(row)[side] - sizeOf(row)[side] / 2);
  return view.put(group, "rect", mark, rows, { x, y, width, height });
}

const around = ([x, y], size) => [x - size, y - size, x + size, y + size];

// What points, lines and rules cover: left, top, right, bottom.
function* covered(view) {
  for (const mark of view.panel.marks) {
    const rows = view.rows(mark), place = (row) => view.place(mark, row);
    if (mark.kind === "points") for (const row of rows) yield around(place(row), 5);
    if (mark.kind === "rules") for (const row of rows) yield* along(place(row), view.place({ x: mark.x2 ?? mark.x, y: mark.y2 ?? mark.y }, row));
    if (mark.kind !== "lines") continue;
    for (const [a, b] of view.groups(mark, rows).flatMap((line) => d3.pairs(line.map(place)))) {
      const corner = mark.is_stepped ? [b[0], a[1]] : b;
      yield* along(a, corner);
      yield* along(corner, b);
    }
  }
}

function* along(a, b) {
  const at = d3.interpolate(a, b), many = Math.ceil(Math.hypot(b[0] - a[0], b[1] - a[1]) / 5);
  for (let step = 0; step <= many; step++) yield around(at(step / many || 0), 3);
}

// The nearest place of a name that lies over nothing, or else over the least.
function free(view, x, y, width, taken) {
  const { distances, angles } = view.spec.around;
  let best = null;
  for (const [far, turn] of d3.cross(distances, d3.range(angles))) {
    const [dx, dy] = [Math.cos, Math.sin].map((f) => far * 1.2 * f((2 * Math.PI * turn) / angles));
    const [anchor, share, up] = Math.abs(dy) > Math.abs(dx) ? ["middle", 0.5, Math.sign(dy)] : dx > 0 ? ["start", 0, 0] : ["end", 1, 0];
    const left = x + dx - share * width, top = y + dy - NAME * 0.6;
    const box = [left, top, left + width, top + NAME * 1.2];
    const isOut = left < view.left || box[2] > view.width || top < view.top - 4 || box[3] > view.bottom;
    const over = 2 * isOut + taken.filter((one) => one[0] <= box[2] && box[0] <= one[2] && one[1] <= box[3] && box[1] <= one[3]).length;
    if (!best || over < best.over) best = { at: [x + dx, y + dy], anchor, box, over, foot: y + dy - up * NAME * 0.6 };
    if (!over) break;
  }
  return best;
}

function told({ mark, row }) {
  return mark.tips.filter(([field]) => (row[field] ?? "") !== "").map(([field, title]) => [title, String(row[field])]);
}
