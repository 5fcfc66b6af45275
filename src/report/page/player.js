// The player: what is shown, and what the reader does about it.

const $ = (id) => document.getElementById(id);
const AXES = ["x", "y", "z"];

class Player {
  constructor(reel, facts) {
    this.reel = reel;
    this.facts = facts;
    this.label = facts.label;
    this.fields = fieldsOf(reel, facts.label);
    this.frame = 0;
    this.field = 0;
    this.normal = 2; // the axis that the plane stands on
    this.depth = Math.floor(reel.shape[2] / 2);
    this.held = null; // the point that a click has chosen, as indices along the three axes
    this.turn = 0; // of drawing: what comes late is not drawn
    this.timer = 0;
    this.whole = null; // where something is, once it was asked for
  }

  // --- what is shown -------------------------------------------------------------------------------------------

  /// The plane through the values: x and y of it are two axes of the domain.
  planeOf(values) {
    const { reel } = this;
    const [across, up] = [0, 1, 2].filter((axis) => axis !== this.normal);
    const strides = [1, reel.shape[0], reel.shape[0] * reel.shape[1]];
    const start = this.depth * strides[this.normal];
    return {
      nx: reel.shape[across],
      ny: reel.shape[up],
      across,
      up,
      step: reel.step,
      names: [AXES[across], AXES[up]],
      at: (x, y) => values[start + x * strides[across] + y * strides[up]],
      x: (index) => reel.coordinate(across, index),
      y: (index) => reel.coordinate(up, index),
    };
  }

  /// The point of the plane that the cuts go through: the one that is held, else that of the largest value.
  markOf(plane) {
    if (this.held) return [this.held[plane.across], this.held[plane.up]];
    let mark = [0, 0];
    let most = -1;
    for (let y = 0; y < plane.ny; ++y)
      for (let x = 0; x < plane.nx; ++x) {
        const size = Math.abs(plane.at(x, y));
        if (size > most) [most, mark] = [size, [x, y]];
      }
    return mark;
  }

  /// The part of the grid where the density is a hundredth of its largest value or more, at any time, and a margin.
  async placeOfSomething() {
    const { reel } = this;
    const [low, high] = reel.rangeOf("rho");
    const least = 0.01 * Math.max(-low, high);
    const place = reel.shape.map((points) => [points - 1, 0]);
    for (let frame = 0; frame < reel.frames.length; ++frame) {
      const values = await reel.values(frame, "rho");
      for (let i = 0, z = 0; z < reel.shape[2]; ++z)
        for (let y = 0; y < reel.shape[1]; ++y)
          for (let x = 0; x < reel.shape[0]; ++x, ++i)
            if (Math.abs(values[i]) >= least)
              [x, y, z].forEach((index, axis) => (place[axis] = [Math.min(place[axis][0], index), Math.max(place[axis][1], index)]));
    }
    return place.map(([first, last], axis) => {
      if (first > last) return [0, reel.shape[axis] - 1];
      const margin = Math.ceil((last - first + 1) / 8);
      return [Math.max(0, first - margin), Math.min(reel.shape[axis] - 1, last + margin)];
    });
  }

  async viewOf(plane) {
    if (!$("zoom").checked) return { x0: 0, x1: plane.nx - 1, y0: 0, y1: plane.ny - 1 };
    this.whole ??= await this.placeOfSomething();
    const [[x0, x1], [y0, y1]] = [this.whole[plane.across], this.whole[plane.up]];
    return { x0, x1, y0, y1 };
  }

  async draw() {
    const turn = ++this.turn;
    const field = this.fields[this.field];
    const values = await field.values(this.frame);
    field.shown ??= colourRange(await field.range(), field.isError);
    const plane = this.planeOf(values ?? new Float64Array(this.reel.shape.reduce((a, b) => a * b)).fill(NaN));
    const view = await this.viewOf(plane);
    const extra = await this.overlays(plane);
    const curves = await this.curvesOf(field, plane);
    if (turn !== this.turn) return;
    const range = field.shown;
    const name = $("colours").value || (field.shown.signed ? this.facts.signed : this.facts.plain);
    const colours = coloursOf(this.facts.maps[name]);
    const { draw, box } = drawMap($("map"), plane, view, range, colours);
    if (this.volume && values) {
      this.volume.show(values, range, colours);
      this.lookAgain();
    }
    if (extra.places) drawPoints(draw, box, extra.places);
    if (extra.arrows) drawArrows(draw, box, apart(extra.arrows, box, extra.apart), extra.most(box));
    const mark = this.markOf(plane);
    if (this.held) drawCross(draw, box, mark);
    this.shown = { plane, box, values, mark };
    this.drawCuts(plane, view, mark, curves, range);
    this.tell();
  }

  /// Particles as places in the plane, and arrows there or on a grid of their own.
  async overlays(plane) {
    const { reel, frame } = this;
    const extra = {};
    const column = (name) => reel.values(frame, name);
    const index = (value, axis) => (value - reel.origin[axis]) / reel.step;
    const [a, b] = [plane.across, plane.up];
    if ($("particles").checked || ($("arrows").checked && !reel.has("arrows.u"))) {
      const places = await Promise.all([a, b].map((axis) => column(`particles.${AXES[axis]}`)));
      if (places[0]) {
        const points = Array.from(places[0], (x, j) => [index(x, a), index(places[1][j], b)]);
        if ($("particles").checked) extra.places = points;
        const speeds = await Promise.all([a, b].map((axis) => column(`particles.${"uvw"[axis]}`)));
        if ($("arrows").checked && !reel.has("arrows.u") && speeds[0]) {
          extra.arrows = points.map(([x, y], j) => [x, y, speeds[0][j], speeds[1][j]]);
          extra.apart = 30;
          extra.most = () => 26;
        }
      }
    }
    const onGrid = $("arrows").checked && reel.stream(frame, "arrows.u");
    if (onGrid) {
      const speeds = await Promise.all([a, b].map((axis) => column(`arrows.${"uvw"[axis]}`)));
      const ratio = onGrid.every / reel.every_point;
      const strides = [1, onGrid.shape[0], onGrid.shape[0] * onGrid.shape[1]];
      const start = Math.min(Math.round(this.depth / ratio), onGrid.shape[this.normal] - 1) * strides[this.normal];
      extra.arrows = [];
      for (let y = 0; y < onGrid.shape[b]; ++y)
        for (let x = 0; x < onGrid.shape[a]; ++x) {
          const i = start + x * strides[a] + y * strides[b];
          if (!Number.isNaN(speeds[0][i])) extra.arrows.push([x * ratio, y * ratio, speeds[0][i], speeds[1][i]]);
        }
      extra.most = (box) => (0.9 * ratio * box.width) / box.across;
    }
    return extra;
  }

  /// What the cuts show: the field, and the exact density beside the density.
  async curvesOf(field, plane) {
    const curves = [{ name: field.title, colour: "first", dash: [], plane }];
    const [rho, exact] = this.fields;
    if ((field === rho || field === exact) && this.reel.stream(this.frame, "error")) {
      const other = field === rho ? exact : rho;
      curves.push({ name: other.title, colour: "second", dash: [6, 4], plane: this.planeOf(await other.values(this.frame)) });
    }
    return curves;
  }

  drawCuts(plane, view, [mx, my], curves, range) {
    const count = (from, to) => Array.from({ length: to - from + 1 }, (_, i) => from + i);
    const across = count(view.x0, view.x1);
    const up = count(view.y0, view.y1);
    const along = (indices, at) => curves.map((curve) => ({ ...curve, values: indices.map((i) => at(curve.plane, i)) }));
    const where = this.held ? "the point that is held" : "the largest value";
    const [x, y] = plane.names;
    const tellCut = (canvas, axis, other, value) =>
      canvas.setAttribute("aria-label", `${curves.map((curve) => curve.name).join(" and ")} along ${axis} through ${where}, ${other} = ${numberText(value)}`);
    drawCurves($("cut-across"), across.map(plane.x), `${x}, at ${y} = ${numberText(plane.y(my))}`, along(across, (p, i) => p.at(i, my)), range, plane.x(mx));
    tellCut($("cut-across"), x, y, plane.y(my));
    drawCurves($("cut-up"), up.map(plane.y), `${y}, at ${x} = ${numberText(plane.x(mx))}`, along(up, (p, i) => p.at(mx, i)), range, plane.y(my));
    tellCut($("cut-up"), y, x, plane.x(mx));
  }

  // --- what is told --------------------------------------------------------------------------------------------

  timeText() {
    const { t, date } = this.reel.frames[this.frame];
    return `t = ${numberText(t)}${date ? ` (${date})` : ""}`;
  }

  /// The values at a point of the plane.
  async tell(point = this.shown.mark, isPointer = false) {
    const { plane, mark } = this.shown;
    const [x, y] = point;
    const place = [0, 0, 0];
    [place[plane.across], place[plane.up], place[this.normal]] = [x, y, this.depth];
    const { reel, frame } = this;
    const index = (place[2] * reel.shape[1] + place[1]) * reel.shape[0] + place[0];
    const names = AXES.slice(0, reel.dimension).map((axis, k) => `${axis} = ${numberText(reel.coordinate(k, place[k]), 6)}`);
    const chosen = this.fields[this.field];
    const told = [chosen, ...this.fields.filter((field, k) => field !== chosen && (k === 0 || field.isError || field.title.startsWith("exact")))];
    const parts = [];
    for (const field of told) {
      const values = await field.values(frame);
      if (values) parts.push(`${field.title} ${numberText(values[index], 6)}`);
    }
    if (frame !== this.frame) return;
    const what = isPointer || this.held ? "" : "Largest here: ";
    $("readout").textContent = `${what}${names.join(", ")}: ${parts.join(", ")}`;
    this.told = { place, mark };
  }

  tellAbout() {
    const { reel } = this;
    const rounding = this.fields.slice(0, reel.has("error") ? 3 : 1).filter((field) => !field.title.startsWith("exact"));
    const errors = rounding.map((field) => `${numberText(Math.max(...reel.frames.map((_, k) => field.rounding(k))), 2)} (${field.title})`);
    const points = reel.shape.slice(0, reel.dimension).join(" \u00d7 ");
    const thinned = reel.every_point > 1 ? `every ${reel.every_point}th point of each axis of the run\u2019s grid` : "all of the run\u2019s grid";
    const outputs = reel.every_output > 1 ? `every ${reel.every_output}th output of the run and the last` : "all outputs of the run";
    $("about").textContent =
      `${reel.frames.length} frames: ${outputs}. ${points} points: ${thinned}. Values are rounded, by at most ` +
      `${errors.join(" and ")}: 1/131068 of the range of their frame. The frames take ${numberText(reel.size / 1e6, 2)} MB, ` +
      `${numberText((reel.size * 4) / 3e6, 2)} MB of this page.`;
  }

  // --- what the reader does ------------------------------------------------------------------------------------

  show(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.reel.frames.length - 1);
    $("time").value = this.frame;
    $("time-text").textContent = this.timeText();
    $("time").setAttribute("aria-valuetext", this.timeText());
    const title = `${this.fields[this.field].title} at ${this.timeText()}`;
    $("map").setAttribute("aria-label", title);
    $("volume-names").setAttribute("aria-label", `${title}, in space; arrow keys turn it, plus and minus come nearer`);
    return this.draw();
  }

  play(isPlaying) {
    clearTimeout(this.timer);
    this.timer = 0;
    $("play").setAttribute("aria-pressed", isPlaying);
    $("play").textContent = isPlaying ? "Pause" : "Play";
    $("readout").setAttribute("aria-live", isPlaying ? "off" : "polite");
    if (!isPlaying) return;
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const wait = calm ? 1500 : Math.min(700, Math.max(50, 4000 / this.reel.frames.length));
    const next = async () => {
      await this.show((this.frame + 1) % this.reel.frames.length);
      if (this.timer) this.timer = setTimeout(next, wait);
    };
    this.timer = setTimeout(next, this.frame + 1 === this.reel.frames.length ? 0 : wait);
  }

  /// The view in space, where the browser can draw it.
  openVolume() {
    this.volume = Volume.on($("volume"), $("volume-names"), this.reel);
    const look = () => {
      const isSurface = $("solid-style").value === "surface";
      const level = Number($("level").value) / 100;
      $("level").parentElement.hidden = !isSurface;
      this.volume?.look(isSurface, level);
      const { shown } = this.fields[this.field];
      if (!shown) return;
      const value = numberText(shown.signed ? level * shown.high : shown.low + level * (shown.high - shown.low), 2);
      $("level-text").textContent = shown.signed ? `\u00b1${value}` : value;
    };
    this.lookAgain = look;
    for (const [id, event] of [["solid-style", "change"], ["level", "input"]]) $(id).addEventListener(event, look);
    if (this.volume) return look();
    $("space-choices").textContent = "This browser has no WebGL 2: planes are shown, and the still picture below.";
    $("space").hidden = true;
  }

  choosePlane(normal) {
    this.normal = normal;
    this.held = null;
    $("depth").max = this.reel.shape[normal] - 1;
    this.chooseDepth(Math.floor(this.reel.shape[normal] / 2));
  }

  chooseDepth(depth) {
    this.depth = depth;
    $("depth").value = depth;
    $("depth-text").textContent = `${AXES[this.normal]} = ${numberText(this.reel.coordinate(this.normal, depth))}`;
  }

  pointAt(event) {
    const { plane, box } = this.shown;
    const [x, y] = box.indexAt(event.offsetX, event.offsetY);
    const isInside = x >= box.view.x0 && x <= box.view.x1 && y >= box.view.y0 && y <= box.view.y1;
    return isInside && x < plane.nx && y < plane.ny ? [x, y] : null;
  }

  hold(point) {
    const { plane } = this.shown;
    this.held = null;
    if (point) {
      this.held = [0, 0, 0];
      [this.held[plane.across], this.held[plane.up], this.held[this.normal]] = [point[0], point[1], this.depth];
    }
    return this.draw();
  }

  /// Keys on the picture move the point that is held.
  moveHeld(dx, dy) {
    const { plane, box, mark } = this.shown;
    const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
    const [x, y] = [mark[0] + dx, mark[1] + dy];
    return this.hold([clamp(x, box.view.x0, box.view.x1), clamp(y, box.view.y0, box.view.y1)], plane);
  }

  onKey(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const onMap = event.target === $("map");
    const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const isField = /^(SELECT|BUTTON|INPUT)$/.test(event.target.tagName);
    if (event.key === " " && (!isField || event.target.type === "range")) this.play(!this.timer);
    else if (event.key === "Escape" && this.held) this.hold(null);
    else if (onMap && moves[event.key]) this.moveHeld(...moves[event.key].map((one) => one * (event.shiftKey ? 10 : 1)));
    else return;
    event.preventDefault();
  }

  listen() {
    $("time").addEventListener("input", () => this.show(Number($("time").value)));
    $("play").addEventListener("click", () => this.play(!this.timer));
    $("field").addEventListener("change", () => ((this.field = Number($("field").value)), this.show(this.frame)));
    $("plane").addEventListener("change", () => (this.choosePlane(Number($("plane").value)), this.draw()));
    $("depth").addEventListener("input", () => (this.chooseDepth(Number($("depth").value)), this.draw()));
    for (const id of ["colours", "zoom", "particles", "arrows"]) $(id).addEventListener("change", () => this.draw());
    $("player").addEventListener("keydown", (event) => this.onKey(event));
    $("map").addEventListener("pointermove", (event) => {
      const point = this.shown && this.pointAt(event);
      if (point) this.tell(point, true);
    });
    $("map").addEventListener("pointerleave", () => this.shown && this.tell());
    $("map").addEventListener("click", (event) => this.hold(this.pointAt(event)));
    addEventListener("resize", () => this.draw());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  start() {
    const option = (value, text) => Object.assign(document.createElement("option"), { value, textContent: text });
    $("field").append(...this.fields.map((field, k) => option(k, field.title)));
    $("colours").append(option("", "as the field needs"), ...Object.keys(this.facts.maps).map((name) => option(name, name)));
    const isSolid = this.reel.dimension === 3;
    for (const element of document.querySelectorAll("#player .solid")) element.hidden = !isSolid;
    if (isSolid) $("plane").append(option(2, "x, y"), option(1, "x, z"), option(0, "y, z"));
    this.choosePlane(2);
    $("with-particles").hidden = !this.reel.has("particles.x");
    $("with-arrows").hidden = !(this.reel.has("arrows.u") || this.reel.has("particles.u"));
    $("time").max = this.reel.frames.length - 1;
    $("player").hidden = false;
    this.listen();
    this.tellAbout();
    return this.show(0);
  }
}

{
  const reel = new Reel(bytesOfBase64($("frames").textContent));
  const player = new Player(reel, JSON.parse($("player-facts").textContent));
  const tell = (part) => document.documentElement.setAttribute(`data-${part}`, "ready");
  await player.start();
  tell("player");
  if (reel.dimension === 3)
    setTimeout(async () => {
      player.openVolume();
      await player.draw();
      tell("space");
    });
}
