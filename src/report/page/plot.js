// Drawing on a canvas: a map with its axes and colour bar, and a cut through it.

const INK = { axes: "--quiet", text: "--ink", first: "--first", second: "--second" };

function ink(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(INK[name]).trim();
}

/// A canvas as sharp as the screen; width and height in CSS pixels.
function sized(canvas, height) {
  const scale = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  canvas.style.height = `${height}px`;
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  const draw = canvas.getContext("2d");
  draw.setTransform(scale, 0, 0, scale, 0, 0);
  draw.clearRect(0, 0, width, height);
  draw.font = "13px system-ui, sans-serif";
  return { draw, width, height };
}

/// Round numbers in a range, some `count` of them.
function ticksOf(low, high, count) {
  const rough = (high - low) / count;
  if (!(rough > 0) || !Number.isFinite(rough)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= rough * 0.999);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(k === 0 ? 0 : k * step);
  return ticks;
}

/// "0.25", "1.5e-7"; a minus sign instead of a hyphen.
function numberText(value, digits = 4) {
  if (Number.isNaN(value)) return "not known";
  const text = Number(value.toPrecision(digits));
  const size = Math.abs(text);
  const shown = size !== 0 && (size < 1e-3 || size >= 1e6) ? text.toExponential() : String(text);
  return shown.replace("-", "\u2212").replace("e-", "e\u2212").replace("e+", "e");
}

/// Colours of a map as numbers for pixels, from red, green and blue as hexadecimal digits.
function coloursOf(hex) {
  const colours = [];
  for (let i = 0; i < hex.length; i += 6) colours.push([0, 2, 4].map((k) => parseInt(hex.slice(i + k, i + k + 2), 16)));
  const table = new Uint8ClampedArray(4 * 256);
  for (let i = 0; i < 256; ++i) {
    const place = (i / 255) * (colours.length - 1);
    const left = Math.min(Math.floor(place), colours.length - 2);
    for (let k = 0; k < 3; ++k)
      table[4 * i + k] = colours[left][k] + (place - left) * (colours[left + 1][k] - colours[left][k]);
    table[4 * i + 3] = 255;
  }
  return table;
}

/// The plane as a picture, a pixel a point, y upwards. Clear where there is no value.
function pictureOf(plane, range, colours) {
  const picture = new ImageData(plane.nx, plane.ny);
  for (let y = 0; y < plane.ny; ++y)
    for (let x = 0; x < plane.nx; ++x) {
      const value = plane.at(x, y);
      if (Number.isNaN(value)) continue;
      const place = Math.round((255 * (value - range.low)) / (range.high - range.low));
      const colour = 4 * Math.min(255, Math.max(0, place));
      const pixel = 4 * ((plane.ny - 1 - y) * plane.nx + x);
      for (let k = 0; k < 4; ++k) picture.data[pixel + k] = colours[colour + k];
    }
  const canvas = document.createElement("canvas");
  canvas.width = plane.nx;
  canvas.height = plane.ny;
  canvas.getContext("2d").putImageData(picture, 0, 0);
  return canvas;
}

/// Where the map lies on its canvas, and which part of the plane it shows: indices of points from `view`.
function frameOf(canvas, plane, view) {
  const left = 56;
  const right = 70;
  const top = 10;
  const bottom = 40;
  const across = view.x1 - view.x0 + 1;
  const up = view.y1 - view.y0 + 1;
  const width = Math.max(40, canvas.clientWidth - left - right);
  let height = (width * up) / across;
  const most = Math.max(240, window.innerHeight * 0.62);
  const scale = Math.min(1, most / height);
  height = Math.max(24, height * scale);
  const box = { left, top, width: width * scale, height, across, up, total: height + top + bottom, view };
  box.x = (index) => left + ((index - view.x0 + 0.5) / across) * box.width;
  box.y = (index) => top + box.height - ((index - view.y0 + 0.5) / up) * box.height;
  box.indexAt = (px, py) => [
    Math.floor(view.x0 + ((px - left) / box.width) * across),
    Math.floor(view.y0 + ((top + box.height - py) / box.height) * up),
  ];
  return box;
}

function drawAxes(draw, box, plane) {
  draw.strokeStyle = ink("axes");
  draw.fillStyle = ink("text");
  draw.strokeRect(box.left, box.top, box.width, box.height);
  const bottom = box.top + box.height;
  draw.textAlign = "center";
  draw.textBaseline = "top";
  const { view } = box;
  for (const x of ticksOf(plane.x(view.x0), plane.x(view.x1), Math.max(3, box.width / 90))) {
    const px = box.x((x - plane.x(0)) / plane.step);
    draw.strokeRect(px, bottom, 0, 4);
    draw.fillText(numberText(x), px, bottom + 6);
  }
  draw.fillText(plane.names[0], box.left + box.width / 2, bottom + 22);
  draw.textAlign = "right";
  draw.textBaseline = "middle";
  for (const y of ticksOf(plane.y(view.y0), plane.y(view.y1), Math.max(3, box.height / 70))) {
    const py = box.y((y - plane.y(0)) / plane.step);
    draw.strokeRect(box.left - 4, py, 4, 0);
    draw.fillText(numberText(y), box.left - 7, py);
  }
  draw.textAlign = "left";
  draw.fillText(plane.names[1], 2, box.top + 8 + box.height / 2 - (box.height > 70 ? 26 : 0));
}

function drawBar(draw, box, range, colours) {
  const left = box.left + box.width + 12;
  const rows = Math.ceil(box.height);
  for (let row = 0; row < rows; ++row) {
    const i = 4 * Math.round(255 * (1 - row / rows));
    draw.fillStyle = `rgb(${colours.slice(i, i + 3).join(",")})`;
    draw.fillRect(left, Math.floor(box.top) + row, 14, 1);
  }
  draw.strokeStyle = ink("axes");
  draw.strokeRect(left, box.top, 14, box.height);
  draw.fillStyle = ink("text");
  draw.textAlign = "left";
  draw.textBaseline = "middle";
  for (const value of ticksOf(range.low, range.high, Math.max(3, box.height / 60))) {
    const y = box.top + box.height * (1 - (value - range.low) / (range.high - range.low));
    draw.fillText(numberText(value, 3), left + 19, Math.min(Math.max(y, box.top + 6), box.top + box.height - 6));
  }
}

function drawMap(canvas, plane, view, range, colours) {
  const box = frameOf(canvas, plane, view);
  const { draw } = sized(canvas, box.total);
  draw.imageSmoothingEnabled = box.width > box.across;
  draw.imageSmoothingQuality = "high";
  const picture = pictureOf(plane, range, colours);
  const upside = plane.ny - 1 - view.y1;
  draw.drawImage(picture, view.x0, upside, box.across, box.up, box.left, box.top, box.width, box.height);
  drawAxes(draw, box, plane);
  drawBar(draw, box, range, colours);
  return { draw, box };
}

function clipped(draw, box, paint) {
  draw.save();
  draw.beginPath();
  draw.rect(box.left, box.top, box.width, box.height);
  draw.clip();
  paint();
  draw.restore();
}

/// Points where particles are; `places` are [x, y] in indices.
function drawPoints(draw, box, places) {
  clipped(draw, box, () => {
    for (const [colour, radius] of [["rgba(0,0,0,.55)", 1.7], ["rgba(255,255,255,.9)", 1]]) {
      draw.fillStyle = colour;
      for (const [x, y] of places) draw.fillRect(box.x(x) - radius, box.y(y) - radius, 2 * radius, 2 * radius);
    }
  });
}

/// One of the arrows in each square of so many pixels; all without a number.
function apart(arrows, box, pixels) {
  if (!pixels) return arrows;
  const taken = new Set();
  return arrows.filter(([x, y]) => {
    const square = `${Math.floor(box.x(x) / pixels)} ${Math.floor(box.y(y) / pixels)}`;
    return !taken.has(square) && taken.add(square);
  });
}

/// Arrows [x, y, u, v]; the longest is `most` pixels.
function drawArrows(draw, box, arrows, most) {
  const largest = Math.max(...arrows.map(([, , u, v]) => Math.hypot(u, v)), 0);
  if (!(largest > 0)) return;
  clipped(draw, box, () => {
    for (const [colour, width] of [["rgba(0,0,0,.6)", 3], ["#fff", 1.2]]) {
      draw.strokeStyle = colour;
      draw.lineWidth = width;
      draw.beginPath();
      for (const [x, y, u, v] of arrows) {
        const dx = (u / largest) * most;
        const dy = (-v / largest) * most;
        const px = box.x(x) + dx / 2;
        const py = box.y(y) + dy / 2;
        draw.moveTo(px - dx, py - dy);
        draw.lineTo(px, py);
        draw.lineTo(px - 0.3 * dx + 0.2 * dy, py - 0.3 * dy - 0.2 * dx);
        draw.moveTo(px, py);
        draw.lineTo(px - 0.3 * dx - 0.2 * dy, py - 0.3 * dy + 0.2 * dx);
      }
      draw.stroke();
    }
  });
}

function drawCross(draw, box, [x, y]) {
  clipped(draw, box, () => {
    for (const [colour, width] of [["rgba(0,0,0,.7)", 3], ["#fff", 1]]) {
      draw.strokeStyle = colour;
      draw.lineWidth = width;
      draw.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        draw.moveTo(box.x(x) + 4 * dx, box.y(y) + 4 * dy);
        draw.lineTo(box.x(x) + 12 * dx, box.y(y) + 12 * dy);
      }
      draw.stroke();
    }
  });
}

/// Curves over one coordinate: { name, colour, values } at the coordinates `places`; `mark` is where the cut crosses.
function drawCurves(canvas, places, axis, curves, fullRange, mark) {
  const extremes = curves.map((curve) => extremesOf(curve.values));
  const range = {
    low: Math.min(fullRange.low, ...extremes.map(([low]) => low)),
    high: Math.max(fullRange.high, ...extremes.map(([, high]) => high)),
  };
  const { draw, width, height } = sized(canvas, 170);
  const box = { left: 52, top: 16, width: Math.max(20, width - 66), height: height - 56 };
  const [first, last] = [places[0], places[places.length - 1]];
  const px = (x) => box.left + (box.width * (x - first)) / (last - first || 1);
  const py = (value) => box.top + box.height * (1 - (value - range.low) / (range.high - range.low));
  draw.strokeStyle = ink("axes");
  draw.strokeRect(box.left, box.top, box.width, box.height);
  draw.fillStyle = ink("text");
  draw.textAlign = "center";
  draw.textBaseline = "top";
  for (const x of ticksOf(first, last, Math.max(2, box.width / 80))) draw.fillText(numberText(x), px(x), box.top + box.height + 5);
  draw.fillText(axis, box.left + box.width / 2, box.top + box.height + 21);
  draw.textAlign = "right";
  draw.textBaseline = "middle";
  for (const value of ticksOf(range.low, range.high, 3)) draw.fillText(numberText(value, 3), box.left - 6, py(value));
  draw.setLineDash([3, 3]);
  draw.strokeRect(px(mark), box.top, 0, box.height);
  draw.setLineDash([]);
  draw.textAlign = "left";
  draw.textBaseline = "bottom";
  let named = box.left;
  for (const { name, colour, dash, values } of curves) {
    draw.strokeStyle = ink(colour);
    draw.fillStyle = ink(colour);
    draw.lineWidth = 1.8;
    draw.setLineDash(dash);
    draw.beginPath();
    let isDown = false;
    values.forEach((value, i) => {
      if (Number.isNaN(value)) isDown = false;
      else draw[isDown ? "lineTo" : "moveTo"](px(places[i]), py(value)), (isDown = true);
    });
    draw.stroke();
    draw.fillText(name, named, box.top - 1);
    named += draw.measureText(name).width + 18;
  }
  draw.lineWidth = 1;
  draw.setLineDash([]);
}
