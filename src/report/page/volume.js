// The density in space: light through a cloud, or its surface at one value, seen from a place that the reader turns.
// WebGL 2; the planes beside it need none.

const VERTEX = `#version 300 es
out vec2 place;
void main() {
  place = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
  gl_Position = vec4(place, 0, 1);
}`;

// A ray for each pixel, through a box around 0 whose longest side is 2. The texture has positions in the colours.
const FRAGMENT = `#version 300 es
precision highp float;
precision highp sampler3D;
in vec2 place;
out vec4 colour;
uniform sampler3D values;
uniform sampler2D colours;
uniform vec3 box, eye, right, up, forward, edges;
uniform float aspect, level, thickness;
uniform bool isSigned, isSurface;

float size(vec3 at) {
  float s = texture(values, at / (2. * box) + .5).r;
  return isSigned ? abs(2. * s - 1.) : s;
}
vec3 colourAt(vec3 at) { return texture(colours, vec2(texture(values, at / (2. * box) + .5).r, .5)).rgb; }
bool isEdge(vec3 at) {
  vec3 near = step(box - .012, abs(at));
  return near.x + near.y + near.z > 1.5;
}

void main() {
  vec3 ray = normalize(forward + .42 * (place.x * aspect * right + place.y * up));
  vec3 a = (-box - eye) / ray, b = (box - eye) / ray;
  vec3 first = min(a, b), last = max(a, b);
  float begin = max(max(first.x, first.y), first.z), end = min(min(last.x, last.y), last.z);
  colour = vec4(0);
  if (begin >= end) return;
  float pace = 2. / 180.;
  vec3 light = normalize(right * -.5 + up * .7 - forward);
  bool wasInside = false;
  for (float t = begin + pace * .5; t < end && colour.a < .99; t += pace) {
    vec3 at = eye + t * ray;
    float s = size(at);
    if (!isSurface) {
      float alpha = 1. - exp(-thickness * s * s * pace);
      colour += (1. - colour.a) * vec4(colourAt(at) * alpha, alpha);
    } else if (s > level) {
      float low = t - pace, high = t;
      for (int i = 0; i < 6; ++i) {
        float middle = .5 * (low + high);
        if (size(eye + middle * ray) > level) high = middle; else low = middle;
      }
      at = eye + max(high, begin) * ray;
      vec2 h = vec2(.02, 0);
      vec3 slope = vec3(size(at + h.xyy) - size(at - h.xyy), size(at + h.yxy) - size(at - h.yxy), size(at + h.yyx) - size(at - h.yyx));
      float shade = .35 + .65 * abs(dot(normalize(slope + 1e-6 * ray), light));
      colour += (1. - colour.a) * vec4(colourAt(at) * shade, 1);
    }
  }
  if (isEdge(eye + end * ray)) colour += (1. - colour.a) * vec4(edges, 1) * .7;
  if (isEdge(eye + begin * ray)) colour = mix(colour, vec4(edges, 1), .5);
}`;

class Volume {
  /// Null where there is no WebGL 2.
  static on(canvas, names, reel) {
    const gl = canvas.getContext("webgl2", { premultipliedAlpha: true, preserveDrawingBuffer: true });
    return gl && new Volume(gl, canvas, names, reel);
  }

  constructor(gl, canvas, names, reel) {
    Object.assign(this, { gl, canvas, names, shape: reel.shape });
    const sides = reel.shape.map((points) => Math.max(points - 1, 1e-3));
    this.box = sides.map((side) => side / Math.max(...sides));
    this.turned = [-0.6, 0.45]; // radians, around and above
    this.distance = 4.5;
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.at = (name) => gl.getUniformLocation(program, name);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.texture(0, gl.TEXTURE_3D, "values");
    this.texture(1, gl.TEXTURE_2D, "colours");
    this.listen();
  }

  texture(unit, target, name) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(target, gl.createTexture());
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(target, filter, gl.LINEAR);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(target, axis, gl.CLAMP_TO_EDGE);
    gl.uniform1i(this.at(name), unit);
  }

  /// 255 levels are enough for light.
  show(values, range, colours) {
    const { gl } = this;
    const nothing = range.signed ? 128 : 0;
    const levels = Uint8Array.from(values, (value) => {
      const place = (255 * (value - range.low)) / (range.high - range.low);
      return Number.isNaN(place) ? nothing : Math.min(255, Math.max(0, Math.round(place)));
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, ...this.shape, 0, gl.RED, gl.UNSIGNED_BYTE, levels);
    gl.activeTexture(gl.TEXTURE1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(colours));
    gl.uniform1i(this.at("isSigned"), range.signed);
  }

  /// As a cloud, or as the surface at a part of the range.
  look(isSurface, level) {
    this.gl.uniform1i(this.at("isSurface"), isSurface);
    this.gl.uniform1f(this.at("level"), level);
    this.draw();
  }

  /// Where the reader stands: eye, right, up and forward.
  camera() {
    const [around, above] = this.turned;
    const forward = [-Math.cos(above) * Math.sin(around), Math.cos(above) * Math.cos(around), -Math.sin(above)];
    const right = [Math.cos(around), Math.sin(around), 0];
    const up = [-Math.sin(above) * Math.sin(around), Math.sin(above) * Math.cos(around), Math.cos(above)];
    return { forward, right, up, eye: forward.map((part) => -this.distance * part) };
  }

  draw() {
    const { gl, canvas } = this;
    const side = Math.max(64, Math.min(480, Math.round(canvas.clientWidth * (window.devicePixelRatio || 1))));
    const height = Math.round(side * 0.8);
    if (canvas.width !== side || canvas.height !== height) Object.assign(canvas, { width: side, height });
    const camera = this.camera();
    for (const [name, value] of Object.entries(camera)) gl.uniform3fv(this.at(name), value);
    gl.uniform3fv(this.at("box"), this.box);
    gl.uniform1f(this.at("aspect"), side / height);
    gl.uniform1f(this.at("thickness"), 14);
    const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    gl.uniform3fv(this.at("edges"), isDark ? [0.6, 0.6, 0.6] : [0.45, 0.45, 0.45]);
    gl.viewport(0, 0, side, height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.nameAxes(camera);
  }

  /// Letters at the ends of the axes that leave the corner of the smallest coordinates.
  nameAxes({ eye, right, up, forward }) {
    const { draw, width, height } = sized(this.names, Math.round(this.canvas.clientWidth * 0.8));
    const dot = (a, b) => a.reduce((sum, part, k) => sum + part * b[k], 0);
    draw.fillStyle = ink("text");
    draw.textAlign = "center";
    draw.textBaseline = "middle";
    AXES.forEach((name, axis) => {
      const end = this.box.map((side, k) => (k === axis ? side + 0.14 : -side));
      const away = end.map((part, k) => part - eye[k]);
      const depth = 0.42 * dot(away, forward);
      const x = (0.5 + (0.5 * dot(away, right)) / depth / (width / height)) * width;
      draw.fillText(name, x, (0.5 - (0.5 * dot(away, up)) / depth) * height);
    });
  }

  turn(around, above) {
    this.turned[0] += around;
    this.turned[1] = Math.min(1.5, Math.max(-1.5, this.turned[1] + above));
    this.draw();
  }

  listen() {
    const { names } = this;
    names.addEventListener("pointerdown", (event) => names.setPointerCapture(event.pointerId));
    names.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) this.turn(-event.movementX / 120, event.movementY / 120);
    });
    names.addEventListener("keydown", (event) => {
      const turns = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
      const nearer = { "+": 0.9, "-": 1 / 0.9 }[event.key];
      if (turns[event.key]) this.turn(...turns[event.key]);
      else if (nearer) (this.distance = Math.min(12, Math.max(2.2, this.distance * nearer))), this.draw();
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
  }
}
