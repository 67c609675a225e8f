// The scene: ground with the map draped over it, routes with a curtain down to the ground, wind, areas, findings.
const MESH = DATA.mesh;
let scene = null; // what is drawn, once it is

async function unpack(packed) {
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))).text();
}
async function loadThree() {
  const script = document.createElement('script');
  script.textContent = await unpack(byId('library').textContent.trim());
  document.head.append(script);
  return window.THREE;
}
function hasWebGL() {
  try {
    const canvas = document.createElement('canvas');
    return Boolean(canvas.getContext('webgl2') || canvas.getContext('webgl'));
  } catch { return false; }
}

function readMesh() {
  const bytes = Uint8Array.from(atob(MESH.heights), (c) => c.charCodeAt(0)), words = new DataView(bytes.buffer);
  return Float32Array.from({ length: MESH.rows * MESH.columns }, (_, i) => {
    const steps = words.getInt16(2 * i, true);
    return steps === -32768 ? NaN : MESH.lowest + steps * MESH.step;
  });
}

class Scene {
  constructor(THREE, place, image) {
    this.THREE = THREE;
    this.place = place;
    this.heights = readMesh();
    this.size = Math.max(MAP.east - MAP.west, MAP.north - MAP.south);
    this.middle = { east: (MAP.east + MAP.west) / 2, north: (MAP.north + MAP.south) / 2 };
    const tops = span([...this.heights].map((h) => (Number.isFinite(h) ? h : null)));
    this.base = tops[0];
    this.target = new THREE.Vector3(0, this.up((tops[0] + tops[1]) / 2), 0);
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(38, 1, this.size / 500, this.size * 20);
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.whole();
    this.addGround(image);
    MAP.areas.forEach((area_) => this.addArea(area_));
    this.addWinds();
    MISSIONS.forEach((_, k) => this.addRoute(k));
    this.marks = MISSIONS.map((_, k) => this.dot(0.008, TWO ? (k ? 0xa3336f : 0x0072b2) : 0xf0e442));
    this.addFindings();
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'application');
    canvas.setAttribute('aria-label', 'Scene of the terrain with the route and the wind; arrow keys turn it, plus and minus zoom');
    this.still = new Image();
    this.still.className = 'still';
    this.still.alt = 'The terrain with the route, seen aslant';
    place.replaceChildren(canvas, this.still);
    place.classList.add('drawn');
    this.listen(canvas);
    this.resize();
  }

  x(east) { return east - this.middle.east; }
  z(north) { return this.middle.north - north; }
  // Absurd heights end far above or below the ground, where they do not spoil what is near.
  up(height) { return within((height - this.base) * MESH.exaggeration, -5 * this.size, 5 * this.size); }
  spot(east, north, height) { return new this.THREE.Vector3(this.x(east), this.up(height), this.z(north)); }

  groundAt(east, north) {
    const { rows, columns } = MESH, clamp = (v, most) => Math.max(0, Math.min(most - 1.0001, v));
    const u = clamp(((east - MAP.west) / (MAP.east - MAP.west)) * (columns - 1), columns);
    const v = clamp(((north - MAP.south) / (MAP.north - MAP.south)) * (rows - 1), rows);
    const i = Math.floor(u), j = Math.floor(v), at = (a, b) => this.heights[b * columns + a];
    const low = at(i, j) * (1 - u + i) + at(i + 1, j) * (u - i), high = at(i, j + 1) * (1 - u + i) + at(i + 1, j + 1) * (u - i);
    const height = low * (1 - v + j) + high * (v - j);
    return Number.isFinite(height) ? height : this.base;
  }

  shape(places, indices, options) {
    const { THREE } = this, geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(Float32Array.from(places), 3));
    if (options.uv) geometry.setAttribute('uv', new THREE.BufferAttribute(Float32Array.from(options.uv), 2));
    if (options.colours) geometry.setAttribute('color', new THREE.BufferAttribute(Float32Array.from(options.colours), 3));
    geometry.setIndex(indices);
    const { uv, colours, ...rest } = options;
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, ...rest }));
    this.world.add(mesh);
    return mesh;
  }

  addGround(image) {
    const { THREE, heights } = this, { rows, columns } = MESH, places = [], uv = [], indices = [];
    for (let j = 0; j < rows; j++) {
      for (let i = 0; i < columns; i++) {
        const e = MAP.west + ((MAP.east - MAP.west) * i) / (columns - 1), n = MAP.south + ((MAP.north - MAP.south) * j) / (rows - 1);
        const h = heights[j * columns + i];
        places.push(this.x(e), this.up(Number.isFinite(h) ? h : this.base), this.z(n));
        uv.push(i / (columns - 1), j / (rows - 1));
      }
    }
    const known = (i) => Number.isFinite(heights[i]);
    for (let j = 0; j < rows - 1; j++) {
      for (let i = 0; i < columns - 1; i++) {
        const a = j * columns + i, b = a + 1, c = a + columns, d = c + 1;
        if (known(a) && known(b) && known(d)) indices.push(a, b, d);
        if (known(a) && known(d) && known(c)) indices.push(a, d, c);
      }
    }
    const texture = new THREE.Texture(image);
    texture.needsUpdate = true;
    texture.anisotropy = 8;
    this.shape(places, indices, { uv, map: texture });
    this.addSides(places);
  }

  // The cut edges of the ground, down to a common base.
  addSides(ground) {
    const { rows, columns } = MESH, ring = [];
    for (let i = 0; i < columns; i++) ring.push(i);
    for (let j = 1; j < rows; j++) ring.push(j * columns + columns - 1);
    for (let i = columns - 2; i >= 0; i--) ring.push((rows - 1) * columns + i);
    for (let j = rows - 2; j >= 0; j--) ring.push(j * columns);
    if (ring.some((at) => !Number.isFinite(this.heights[at]))) return;
    const foot = -0.02 * this.size, places = [], colours = [], indices = [];
    ring.forEach((at, i) => {
      const east = ring[i] % columns === 0 || ring[i] % columns === columns - 1, tone = east ? 0.62 : 0.54;
      places.push(ground[3 * at], ground[3 * at + 1], ground[3 * at + 2], ground[3 * at], foot, ground[3 * at + 2]);
      for (let k = 0; k < 2; k++) colours.push(tone, tone * 0.93, tone * 0.8);
      const next = ring[i + 1];
      if (next !== undefined) indices.push(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2);
    });
    this.shape(places, indices, { colours, vertexColors: true });
  }

  // Rods between pairs of places, all in one draw; `tip` makes them cones.
  rods(pairs, radius, colours, tip = false, look = {}) {
    const { THREE } = this;
    if (!pairs.length) return;
    const geometry = new THREE.CylinderGeometry(tip ? 0 : 1, 1, 1, tip ? 10 : 8, 1, false);
    const mesh = new THREE.InstancedMesh(geometry, new THREE.MeshBasicMaterial(look), pairs.length);
    const rod = new THREE.Object3D(), up = new THREE.Vector3(0, 1, 0);
    pairs.forEach(([from, to], i) => {
      const way = to.clone().sub(from), length = way.length() || 1e-6;
      rod.position.copy(from).addScaledVector(way, 0.5);
      rod.quaternion.setFromUnitVectors(up, way.divideScalar(length));
      rod.scale.set(radius, length, radius);
      rod.updateMatrix();
      mesh.setMatrixAt(i, rod.matrix);
      mesh.setColorAt(i, new THREE.Color(colours[i]));
    });
    this.world.add(mesh);
    return mesh;
  }

  // Every other piece of a way, with its colours.
  dashes(pairs, colours) {
    const pieces = [], tints = [], long = this.size / 70;
    let gone = 0;
    pairs.forEach(([from, to], i) => {
      const length = from.distanceTo(to);
      for (let at = 0; at < length;) {
        const next = Math.min(length, at + long - (gone % long) + long * 1e-6);
        if (Math.floor(gone / long) % 2 === 0) {
          pieces.push([from.clone().lerp(to, at / length), from.clone().lerp(to, next / length)]);
          tints.push(colours[i]);
        }
        gone += next - at;
        at = next;
      }
    });
    return [pieces, tints];
  }

  addRoute(k) {
    const { THREE } = this, { track, stops } = MISSIONS[k], pairs = [], colours = [], curtain = [], indices = [];
    const plain = k ? '#a3336f' : '#0072b2', there = (i) => track.e[i] !== null && track.n[i] !== null && track.z[i] !== null;
    const thin = Math.max(1, Math.floor(track.e.length / 1500));
    let before = null;
    for (let i = 0; i < track.e.length; i += thin) {
      if (!there(i)) { before = null; continue; }
      const spot = this.spot(track.e[i], track.n[i], track.z[i]);
      const foot = this.up(Math.min(this.groundAt(track.e[i], track.n[i]), track.z[i]));
      curtain.push(spot.x, spot.y, spot.z, spot.x, foot, spot.z);
      if (before) {
        if (before.distanceTo(spot) > 0.01) { pairs.push([before, spot]); colours.push(TWO ? plain : WINDS[windClass(track.along[i])]); }
        const n = curtain.length / 3;
        indices.push(n - 4, n - 3, n - 2, n - 3, n - 1, n - 2);
      }
      before = spot;
    }
    const [pieces, tints] = this.dashes(pairs, colours);
    if (k) this.rods(pieces, 0.0034 * this.size, tints); // A shows in the gaps where both coincide
    else this.rods(pairs, 0.0028 * this.size, colours);
    // Through the ground the way is seen faint and dashed: it may be below it, or the drawn ground coarser than the real.
    const hidden = this.rods(pieces, 0.0022 * this.size, tints, false, { depthTest: false, depthWrite: false, transparent: true, opacity: 0.7 });
    if (hidden) hidden.renderOrder = 3;
    this.shape(curtain, indices, { color: TWO ? plain : '#1c2430', transparent: true, opacity: 0.22, depthWrite: false });
    const ball = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 12, 8), new THREE.MeshBasicMaterial({ color: 0xffffff }), stops.length);
    const one = new THREE.Object3D();
    const radius = (stops.length > 150 ? 0.0034 : 0.0052) * this.size;
    stops.forEach(([, , e, n, z], i) => {
      one.position.copy(this.spot(e, n, z === null ? this.groundAt(e, n) : z));
      one.scale.setScalar(radius);
      one.updateMatrix();
      ball.setMatrixAt(i, one.matrix);
    });
    this.world.add(ball);
  }

  addWinds() {
    if (!strongest) return;
    const shafts = [], tips = [], gap = this.size / 22;
    for (const [e, n, u, v] of MAP.wind) {
      const speed = Math.hypot(u, v), length = (gap * speed) / strongest;
      if (!speed) continue;
      const way = new this.THREE.Vector3(u / speed, 0, -v / speed), middle = this.spot(e, n, this.groundAt(e, n) + MAP.windHeight);
      const tail = middle.clone().addScaledVector(way, -length / 2), neck = middle.clone().addScaledVector(way, length / 2 - gap * 0.22);
      shafts.push([tail, neck]);
      tips.push([neck, middle.clone().addScaledVector(way, length / 2)]);
    }
    const colours = shafts.map(() => '#27486f');
    this.rods(shafts, 0.0011 * this.size, colours);
    this.rods(tips, 0.0036 * this.size, colours, true);
  }

  addArea({ kind, corners, floor, ceiling }) {
    const out = kind.endsWith('out'), solid = kind === 'obstacle', places = [], indices = [], tops = [];
    const above = 150, seen = [], rim = 0.01 * this.size; // no wall beyond the ground's edge
    for (let i = 0; i < corners.length; i++) {
      const [a, b] = [corners[i], corners[(i + 1) % corners.length]];
      const steps = Math.max(1, Math.ceil((Math.hypot(b[0] - a[0], b[1] - a[1]) / this.size) * 60));
      for (let s = 0; s < steps; s++) {
        const e = a[0] + ((b[0] - a[0]) * s) / steps, n = a[1] + ((b[1] - a[1]) * s) / steps, ground = this.groundAt(e, n);
        const low = this.spot(e, n, floor === null ? ground : Math.max(floor, ground)), high = this.spot(e, n, ceiling === null ? Math.max(ground, floor || -Infinity) + above : ceiling);
        places.push(low.x, low.y, low.z, high.x, high.y, high.z);
        tops.push(high);
        seen.push(e >= MAP.west - rim && e <= MAP.east + rim && n >= MAP.south - rim && n <= MAP.north + rim);
      }
    }
    const n = tops.length, rails = [];
    for (let i = 0; i < n; i++) {
      const j = (i + 1) % n;
      if (!seen[i] || !seen[j]) continue;
      indices.push(2 * i, 2 * i + 1, 2 * j, 2 * i + 1, 2 * j + 1, 2 * j);
      rails.push([tops[i], tops[j]]);
    }
    this.shape(places, indices, { color: solid ? '#5b3a5e' : out ? '#d55e00' : '#009e73', transparent: true, opacity: solid ? 0.9 : out ? 0.3 : 0.12, depthWrite: solid });
    this.rods(rails, 0.0011 * this.size, rails.map(() => (solid ? '#2d1d2f' : out ? '#9c2b00' : '#00543b')));
  }

  dot(share, colour) {
    const { THREE } = this, mesh = new THREE.Mesh(new THREE.SphereGeometry(share * this.size, 20, 14), new THREE.MeshBasicMaterial({ color: colour, depthTest: false, transparent: true }));
    mesh.renderOrder = 5;
    this.world.add(mesh);
    return mesh;
  }

  // A finding's sign with its number, the same size from everywhere.
  sign(k, i) {
    const { THREE } = this, canvas = document.createElement('canvas'), pen = canvas.getContext('2d');
    canvas.width = canvas.height = 96;
    const danger = MISSIONS[k].findings[i].severity === 'danger';
    pen.scale(3.6, 3.6);
    pen.translate(13.3, 13.8);
    pen.fillStyle = danger ? '#b8490a' : '#ffc94d';
    pen.strokeStyle = danger ? '#fff' : '#4a3200';
    pen.lineWidth = 1.4;
    const outline = new Path2D(SHAPES[danger ? 'danger' : 'warning']);
    pen.fill(outline);
    pen.stroke(outline);
    pen.fillStyle = danger ? '#fff' : '#2b1d00';
    pen.font = '700 10px sans-serif';
    pen.textAlign = 'center';
    pen.fillText(`${LETTERS[k]}${i + 1}`, 0, danger ? 3.6 : 6);
    const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false, sizeAttenuation: false }));
    sprite.renderOrder = 4;
    return sprite;
  }
  addFindings() {
    this.signs = [];
    MISSIONS.forEach((m, k) => m.findings.slice(0, 60).forEach((f, i) => {
      if (f.e === null) return;
      const { track } = m, { at } = f;
      const height = at === null || track.z[at] === null ? this.groundAt(f.e, f.n) : track.z[at];
      const spot = this.spot(f.e, f.n, height), head = spot.clone();
      const same = this.signs.filter(([, , other]) => Math.hypot(other.position.x - head.x, other.position.z - head.z) < 0.02 * this.size).length;
      head.y += (0.045 + 0.06 * same) * this.size;
      this.rods([[spot, head]], 0.001 * this.size, ['#1c2430']);
      const sprite = this.sign(k, i);
      sprite.position.copy(head);
      this.signs.push([k, i, sprite]);
      this.world.add(sprite);
    }));
  }

  whole() {
    Object.assign(this, { azimuth: Math.PI * 0.93, slant: 0.62, away: this.fitting() });
    this.target.x = this.target.z = 0;
  }
  // From where the ground just fills the view.
  fitting(aspect = (this.place.clientWidth || 3) / (this.place.clientHeight || 2)) {
    const width = MAP.east - MAP.west, depth = MAP.north - MAP.south, half = Math.tan((this.camera.fov * Math.PI) / 360);
    return Math.max((0.52 * Math.hypot(width, 0.45 * depth)) / (half * aspect) + 0.25 * depth, (0.42 * Math.hypot(depth, 0.5 * width)) / half + 0.2 * depth);
  }
  turn(azimuth, slant) {
    this.azimuth += azimuth;
    this.slant = Math.max(0.06, Math.min(1.55, this.slant + slant));
    this.draw();
  }
  zoom(factor) {
    this.away = Math.max(0.03 * this.size, Math.min(5 * this.size, this.away * factor));
    this.draw();
  }
  shift(dx, dy) {
    const share = this.away / this.place.clientHeight, [sin, cos] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    this.target.x += (dx * cos - dy * sin) * share;
    this.target.z += (-dx * sin - dy * cos) * share;
    this.draw();
  }

  listen(canvas) {
    const fingers = new Map();
    canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); fingers.set(event.pointerId, event); });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener('pointermove', (event) => {
      const old = fingers.get(event.pointerId);
      if (!old) return;
      const dx = event.clientX - old.clientX, dy = event.clientY - old.clientY;
      const other = [...fingers.values()].find((f) => f.pointerId !== event.pointerId);
      fingers.set(event.pointerId, event);
      if (other) {
        const gap = (f) => Math.hypot(f.clientX - other.clientX, f.clientY - other.clientY) || 1;
        this.zoom(gap(old) / gap(event));
        this.shift(dx / 2, dy / 2);
      } else if (event.shiftKey || event.buttons === 2) this.shift(dx, dy);
      else this.turn(-dx / 180, event.pointerType === 'touch' ? 0 : dy / 180);
    });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.zoom(Math.exp(event.deltaY / 500));
    }, { passive: false });
    const keys = { ArrowLeft: [0.12, 0], ArrowRight: [-0.12, 0], ArrowUp: [0, 0.08], ArrowDown: [0, -0.08] };
    canvas.addEventListener('keydown', (event) => {
      if (keys[event.key]) this.turn(...keys[event.key]);
      else if (event.key === '+' || event.key === '=') this.zoom(0.85);
      else if (event.key === '-') this.zoom(1 / 0.85);
      else return;
      event.preventDefault();
    });
  }

  cursor() {
    this.marks.forEach((mark, k) => {
      const { track } = MISSIONS[k], i = state.at[k];
      mark.visible = track.e[i] != null && track.n[i] != null && track.z[i] != null;
      if (mark.visible) mark.position.copy(this.spot(track.e[i], track.n[i], track.z[i]));
    });
    this.draw();
  }

  resize() {
    const width = this.place.clientWidth, height = this.place.clientHeight;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.cursor();
  }

  // The same view in the shape that it has on paper.
  picture(shape) {
    const { camera, place, renderer, away } = this, height = 640;
    this.away *= this.fitting(shape) / this.fitting();
    renderer.setSize(Math.round(height * shape), height, false);
    camera.aspect = shape;
    camera.updateProjectionMatrix();
    this.paint();
    const drawn = renderer.domElement.toDataURL('image/png');
    this.away = away;
    renderer.setSize(place.clientWidth, place.clientHeight, false);
    this.resize();
    return drawn;
  }

  draw() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => { this.waiting = 0; this.paint(); });
  }
  paint() {
    const { camera, target } = this, flat = Math.cos(this.slant) * this.away;
    camera.position.set(target.x - flat * Math.sin(this.azimuth), target.y + Math.sin(this.slant) * this.away, target.z - flat * Math.cos(this.azimuth));
    camera.lookAt(target);
    for (const [k, i, sprite] of this.signs) {
      const chosen = state.chosen && state.chosen[0] === k && state.chosen[1] === i;
      const size = (chosen ? 34 : 24) / this.place.clientHeight * 2 * Math.tan((camera.fov * Math.PI) / 360);
      sprite.scale.set(size, size, 1);
    }
    this.renderer.render(this.world, camera);
  }
}

async function openScene() {
  const place = byId('scene'), say = (text) => { place.innerHTML = `<p class="fallback">${text}</p>`; };
  if (!byId('library')) return;
  if (!hasWebGL()) { say('This browser draws no 3D (WebGL is off). The map and the profile show the same route.'); return; }
  try {
    say('Drawing …');
    const image = new Image();
    image.src = MAP.picture;
    const [THREE] = await Promise.all([loadThree(), image.decode()]);
    scene = new Scene(THREE, place, image);
  } catch (error) {
    say('The scene could not be drawn. The map and the profile show the same route.');
    console.warn(error);
    return;
  }
  listeners.push(() => scene.cursor());
  new ResizeObserver(() => scene.resize()).observe(place);
  const deeds = { left: () => scene.turn(0.3, 0), right: () => scene.turn(-0.3, 0), in: () => scene.zoom(0.8), out: () => scene.zoom(1.25), whole: () => { scene.whole(); scene.draw(); } };
  for (const button of document.querySelectorAll('[data-scene]')) button.addEventListener('click', deeds[button.dataset.scene]);
  window.addEventListener('beforeprint', () => { scene.still.src = scene.picture(PAPER.scene / PAPER.height); });
}
