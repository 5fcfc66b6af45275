// What can be shown: fields that the page has, and those that follow from them.

/// The slope of a field on the grid of the page, from differences of neighbours; one-sided at the edges and beside
/// points without a value.
function gradientOf(values, shape, step) {
  const [nx, ny, nz] = shape;
  const slopes = new Float64Array(values.length);
  const strides = [1, nx, nx * ny];
  let i = 0;
  for (let z = 0; z < nz; ++z)
    for (let y = 0; y < ny; ++y)
      for (let x = 0; x < nx; ++x, ++i) {
        let sum = 0;
        [x, y, z].forEach((index, axis) => {
          if (shape[axis] < 2) return;
          let before = index > 0 ? 1 : 0;
          let after = index + 1 < shape[axis] ? 1 : 0;
          if (Number.isNaN(values[i - before * strides[axis]])) before = 0;
          if (Number.isNaN(values[i + after * strides[axis]])) after = 0;
          if (before + after === 0) return;
          const change = values[i + after * strides[axis]] - values[i - before * strides[axis]];
          sum += (change / ((before + after) * step)) ** 2;
        });
        slopes[i] = Number.isNaN(values[i]) ? NaN : Math.sqrt(sum);
      }
  return slopes;
}

function extremesOf(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

function widened([a, b], [c, d]) {
  return [Math.min(a, c), Math.max(b, d)];
}

/// A field: its name in the list, its values in a frame, its range over all frames, and how wrong a value may be.
function fieldsOf(reel, label) {
  const plain = (name, title, isError) => ({
    title,
    isError,
    values: (frame) => reel.values(frame, name),
    range: async () => reel.rangeOf(name),
    rounding: (frame) => reel.roundingOf(frame, name),
  });
  const overFrames = async (field) => {
    let range = [Infinity, -Infinity];
    for (let frame = 0; frame < reel.frames.length; ++frame) {
      const values = await field.values(frame);
      if (values) range = widened(range, extremesOf(values));
    }
    return range;
  };
  const fields = [plain("rho", label, false)];
  if (reel.has("error")) {
    const exact = {
      title: `exact ${label}`,
      isError: false,
      async values(frame) {
        const rho = await reel.values(frame, "rho");
        const error = await reel.values(frame, "error");
        return error && rho.map((value, i) => value - error[i]);
      },
      range: () => overFrames(exact),
      rounding: (frame) => reel.roundingOf(frame, "rho") + reel.roundingOf(frame, "error"),
    };
    fields.push(exact, plain("error", "error", true));
  }
  const slope = {
    title: `slope of the ${label}`,
    isError: false,
    values: async (frame) => gradientOf(await reel.values(frame, "rho"), reel.shape, reel.step),
    range: () => overFrames(slope),
    rounding: (frame) => (reel.roundingOf(frame, "rho") * 2 * Math.sqrt(reel.dimension)) / reel.step,
  };
  fields.push(slope);
  for (const name of reel.fieldNames()) if (name !== "rho" && name !== "error") fields.push(plain(name, name, false));
  return fields;
}

/// What colours begin and end with. Errors, and what falls well below 0, have white in the middle, at 0.
function colourRange([low, high], isError) {
  if (!(low <= high)) return { low: 0, high: 1, signed: false };
  const signed = isError || low < -0.05 * Math.abs(high);
  if (signed) {
    const end = Math.max(-low, high) || 1;
    return { low: -end, high: end, signed };
  }
  if (low < 0.25 * high) low = 0;
  return { low, high: high > low ? high : low + 1, signed };
}
