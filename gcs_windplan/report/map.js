// The map: relief, areas, wind, routes, stops, findings; it can be shifted and enlarged.
const MAP = DATA.map;
const WINDS = ['#9c3f00', '#d55e00', '#eda55f', '#8a8f94', '#7ab6dd', '#0072b2', '#003f78']; // head wind to tail wind
const view = { east: (MAP.west + MAP.east) / 2, north: (MAP.south + MAP.north) / 2, zoom: 1, width: 100, height: 100 };
const plate = byId('map');
const strongest = Math.max(0, ...MAP.wind.map(([, , u, v]) => Math.hypot(u, v)));
const alongMost = Math.max(0.5, ...span(...MISSIONS.map((m) => m.track.along)).map(Math.abs));

const scaleOf = () => Math.min(view.width / (MAP.east - MAP.west), view.height / (MAP.north - MAP.south)) * view.zoom;
const toX = (east) => view.width / 2 + (east - view.east) * scaleOf();
const toY = (north) => view.height / 2 - (north - view.north) * scaleOf();

function arrow(x, y, u, v, length, classes) {
  const speed = Math.hypot(u, v);
  if (!speed) return '';
  const [dx, dy] = [(u / speed) * length, (-v / speed) * length], head = Math.min(5, Math.max(2.5, length * 0.35));
  const [tx, ty] = [x + dx / 2, y + dy / 2];
  const [ux, uy] = [dx / length, dy / length];
  const barb = (side) => `M${px(tx)} ${px(ty)}l${px(-head * ux + side * head * 0.6 * uy)} ${px(-head * uy - side * head * 0.6 * ux)}`;
  const d = `M${px(x - dx / 2)} ${px(y - dy / 2)}L${px(tx)} ${px(ty)}${barb(1)}${barb(-1)}`;
  return `<path class="${classes} halo" d="${d}"/><path class="${classes}" d="${d}"/>`;
}

// Arrows may stand as close as their own length at the strongest wind.
const arrowLength = () => (view.width < 500 ? 21 : 26);
function drawWind() {
  const taken = [];
  let text = '';
  for (const [e, n, u, v] of MAP.wind) {
    const x = toX(e), y = toY(n);
    if (x < 0 || y < 0 || x > view.width || y > view.height || taken.some(([a, b]) => Math.hypot(a - x, b - y) < arrowLength() * 1.3)) continue;
    taken.push([x, y]);
    text += arrow(x, y, u, v, Math.max(5, (arrowLength() * Math.hypot(u, v)) / strongest), 'wind');
  }
  return text;
}

const windClass = (along) => (along === null ? 3 : Math.round(((Math.max(-1, Math.min(1, along / alongMost)) + 1) / 2) * (WINDS.length - 1)));
function drawRoute(k) {
  const { track } = MISSIONS[k], xs = track.e.map((e) => e === null ? null : toX(e)), ys = track.n.map((n) => n === null ? null : toY(n));
  const casing = `<path class="casing${TWO ? ' wide' : ''}" d="${path(xs, ys)}"/>`;
  if (TWO) return [casing, ['edge ', ''].map((edge) => `<path class="${edge}way r${k}" d="${path(xs, ys)}"/>`).join('')];
  let text = '';
  for (let i = 0; i < xs.length - 1;) {
    const colour = windClass(track.along[i]);
    let j = i + 1;
    while (j < xs.length - 1 && windClass(track.along[j]) === colour) j++;
    text += `<path class="way" stroke="${WINDS[colour]}" d="${path(xs.slice(i, j + 1), ys.slice(i, j + 1))}"/>`;
    i = j;
  }
  return [casing, text];
}
// All casings first: where two routes coincide, B lies as a narrow dashed line on the wide one of A.
function drawRoutes() {
  const drawn = MISSIONS.map((_, k) => drawRoute(k));
  return drawn.map(([casing]) => casing).join('') + drawn.map(([, way]) => way).join('');
}

// Of many stops each fifth or tenth is numbered.
const numbered = (count) => (count <= 40 ? 1 : [5, 10, 20, 50, 100].find((step) => count / step <= 40) || 200);

function drawStops(k, taken) {
  const { stops } = MISSIONS[k];
  let text = '';
  const every = numbered(stops.length / view.zoom);
  let before = null;
  stops.forEach(([n, label, e, n_], i) => {
    const x = toX(e), y = toY(n_);
    if (x < -20 || y < -20 || x > view.width + 20 || y > view.height + 20) return;
    const title = `<title>${LETTERS[k]} ${escape(label)} ${n}</title>`;
    if (i === 0) text += `<path class="home" d="M${px(x)} ${px(y - 7)}l7 6v7h-14v-7z">${title}</path>`;
    else {
      if (before && i < stops.length - 1 && Math.hypot(x - before[0], y - before[1]) < 9) return;
      before = [x, y];
      text += `<circle class="stop" cx="${px(x)}" cy="${px(y)}" r="3.2">${title}</circle>`;
    }
    if (i && i !== stops.length - 1 && (TWO || n % every)) return;
    if (taken.some(([a, b]) => Math.abs(a - x) < 20 && Math.abs(b - y) < 15)) return;
    taken.push([x, y]);
    text += `<text class="number" x="${px(x + 7)}" y="${px(y - 6)}">${i === 0 ? `${LETTERS[k]} home`.trim() : LETTERS[k] + n}</text>`;
  });
  return text;
}

function drawAreas() {
  const taken = [], order = (area_) => (area_.kind.startsWith('keep') ? 0 : 1);
  const drawn = [...MAP.areas].sort((a, b) => order(a) - order(b)).map((area_) => {
    const xs = area_.corners.map(([e]) => toX(e)), ys = area_.corners.map(([, n]) => toY(n));
    const [left, right] = span(xs), [high, low] = span(ys);
    const out = area_.kind.endsWith('out');
    const heights = [area_.floor === null ? '' : `from ${number(area_.floor)} m`, area_.ceiling === null ? '' : `up to ${number(area_.ceiling)} m`].filter(Boolean).join(' ');
    const [x, y] = [(left + right) / 2, (high + low) / 2];
    const free = out && right - left > 40 && !taken.some(([a, b]) => Math.abs(a - x) < 90 && Math.abs(b - y) < 24);
    if (free) taken.push([x, y]);
    const name = free ? `<text class="name" x="${px(x)}" y="${px(y)}">${escape(area_.name)}` +
      (heights ? `<tspan x="${px(x)}" dy="13">${heights} AMSL</tspan>` : '') + '</text>' : '';
    return [`<path class="area ${area_.kind}" d="${path(xs, ys)}Z"><title>${escape(area_.name)}: ${area_.kind} ${heights}</title></path>`, name];
  });
  return [drawn.map(([outline]) => outline).join(''), drawn.map(([, name]) => name).join('')];
}

function drawFurniture() {
  const { width, height } = view, metres = 110 / scaleOf();
  const ten = 10 ** Math.floor(Math.log10(metres)), nice = ten * [5, 2, 1].find((s) => s * ten <= metres);
  const bar = nice * scaleOf(), y = height - 16;
  const label = nice >= 1000 ? `${+(nice / 1000).toFixed(1)} km` : `${+nice.toFixed(1)} m`;
  let text = `<rect class="panel" x="8" y="${y - 20}" width="${px(bar + 20)}" height="30" rx="4"/>` +
    `<path class="furniture-line" d="M18 ${y - 3}v6h${px(bar)}v-6"/><text class="furniture-text" x="18" y="${y - 7}">${label}</text>`;
  const busy = MISSIONS.some(({ stops }) => stops.some(([, , e, n]) => toX(e) > width - 90 && toY(n) < 80));
  const arrowX = busy ? 24 : width - 24;
  text += `<g transform="translate(${arrowX} 30)"><circle class="panel" r="17"/><path class="furniture" d="M0-13 6 8 0 4-6 8z"/></g>` +
    `<text class="name north" x="${arrowX}" y="60">N</text>`;
  return text;
}

// The map's plate has the ground's shape, the scene takes what is left beside it, and the profile has room on the same
// screen. On paper the same, in shares of the width.
const ABOVE_PROFILE = 475; // [px] of what stands above and below the plates down to the foot of the profile
const WIDE = { query: '(min-width: 1100px)', legend: 172, spared: 40 }; // [px] the legend beside the map, and what that spares
const SHAPE = (MAP.east - MAP.west) / (MAP.north - MAP.south);
const within = (value, low, high) => Math.max(low, Math.min(high, value));
function shared(width, most) {
  const map = within(most * SHAPE, 0.2 * width, 0.62 * width), height = within(map / SHAPE, 0.6 * most, most);
  return { map, scene: width - map, height };
}
const columns = ({ map, scene }) => `minmax(0, ${map.toFixed(1)}fr) minmax(0, ${scene.toFixed(1)}fr)`;
const PAPER = shared(820, 295); // [px]
function fitPlates() {
  const where = byId('where'), room = where.clientWidth;
  let [low, high] = [within(room / SHAPE, 200, 0.8 * window.innerHeight), within(0.8 * room, 240, 420)];
  if (!window.matchMedia('(max-width: 820px)').matches) {
    const { legend, spared } = window.matchMedia(WIDE.query).matches ? WIDE : { legend: 0, spared: 0 };
    const screen = shared(room - 16 - legend, within(window.innerHeight - ABOVE_PROFILE + spared, 280, 560));
    where.style.setProperty('--columns', columns({ ...screen, map: screen.map + legend }));
    low = high = screen.height;
  }
  plate.style.height = `${Math.round(low)}px`;
  byId('scene').style.height = `${Math.round(high)}px`;
}
function shapePaper() {
  const { style } = byId('where');
  style.setProperty('--paper-columns', columns(PAPER));
  style.setProperty('--paper-map', PAPER.map / PAPER.height);
  style.setProperty('--paper-scene', PAPER.scene / PAPER.height);
  style.setProperty('--shape', within(SHAPE, 0.5, 2.5));
}

function drawMap() {
  fitPlates();
  view.width = state.printing ? PAPER.map : plate.clientWidth || 600;
  view.height = state.printing ? PAPER.height : plate.clientHeight || 400;
  const x = toX(MAP.west), y = toY(MAP.north), taken = [];
  let text = '<defs><pattern id="hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><path class="hatched" d="M0 0V7"/></pattern></defs>' +
    `<image href="${MAP.picture}" x="${px(x)}" y="${px(y)}" width="${px(toX(MAP.east) - x)}" height="${px(toY(MAP.south) - y)}" preserveAspectRatio="none"/>`;
  const [areas, names] = drawAreas();
  text += areas + drawWind() + drawRoutes();
  MISSIONS.forEach((_, k) => { text += drawStops(k, taken); });
  for (const [e, n] of MAP.rally) text += `<path class="rally" d="M${px(toX(e))} ${px(toY(n) - 8)}l7 8-7 8-7-8z"><title>rally point</title></path>`;
  text += names + '<g id="here"></g>';
  const signs = [];
  text += drawFurniture();
  MISSIONS.forEach((m, k) => m.findings.forEach((f, i) => {
    const chosen = state.chosen && state.chosen[0] === k && state.chosen[1] === i;
    if (f.e === null) return;
    const home = [toX(f.e), toY(f.n)], seen = home[0] > 0 && home[0] < view.width && home[1] > 0 && home[1] < view.height;
    if (seen) text += findingMark(k, i, beside(signs, ...home, view.width, 12, view.height - 12), home, chosen);
  }));
  plate.innerHTML = `<svg viewBox="0 0 ${view.width} ${view.height}" role="img" aria-labelledby="map-title" aria-describedby="map-legend">${text}</svg>`;
  moveMapCursor();
}

// The cursor on the map: the vehicle and the wind that blows on it.
function moveMapCursor() {
  const here = byId('here');
  if (!here) return;
  here.innerHTML = MISSIONS.map((m, k) => {
    const i = state.at[k], { track } = m;
    if (track.e[i] == null || track.n[i] == null) return '';
    const x = toX(track.e[i]), y = toY(track.n[i]);
    const u = track.we[i], v = track.wn[i];
    const wind = u === null || v === null || !strongest ? '' : arrow(x, y, u, v, Math.max(12, (arrowLength() * 1.8 * Math.hypot(u, v)) / strongest), 'here');
    return `${wind}<circle class="dot" cx="${px(x)}" cy="${px(y)}" r="5.5"/>`;
  }).join('');
}

function legendOfMap() {
  const key = (drawing, text) => `<span class="key">${drawing}${text}</span>`;
  const little = (inside, width = 26) => `<svg width="${width}" height="16" viewBox="0 0 ${width} 16" aria-hidden="true">${inside}</svg>`;
  let text = '';
  if (TWO) text += MISSIONS.map((m, k) => key(little(`<path class="way r${k}" d="M1 8h24"/>`), `${LETTERS[k]} ${escape(m.name)}`)).join('');
  else text += key(little(WINDS.map((c, i) => `<rect x="${i * 9}" y="5" width="9" height="6" fill="${c}"/>`).join(''), 63), `wind along: ${number(-alongMost, 1)} to ${number(alongMost, 1, true)} m/s`);
  if (strongest) {
    const nice = Number(strongest.toPrecision(1)), length = (arrowLength() * nice) / strongest;
    text += key(little(arrow(20, 8, 1, 0, length, 'wind'), 40), `${number(nice, nice < 1 ? 1 : 0)} m/s wind, blowing that way, ${number(MAP.windHeight)} m above ground${MAP.windSeconds ? `, ${clock(MAP.windSeconds)} min after take-off` : ''}`);
  }
  text += key('', `contours every ${MAP.contours} m, true north`);
  const kinds = new Set(MAP.areas.map((a) => a.kind));
  const names = { obstacle: 'obstacle', 'keep-out': 'keep out', 'keep-in': 'keep in', 'fence-out': 'fence, keep out', 'fence-in': 'fence, keep in' };
  for (const kind of kinds) text += key(little(`<rect class="area ${kind}" x="2" y="2" width="22" height="12"/>`), names[kind] || kind);
  if (MAP.rally.length) text += key(little('<path class="rally" d="M8 1l6 7-6 7-6-7z"/>', 16), 'rally point');
  byId('map-legend').innerHTML = text;
}

function enlarge(factor, x = view.width / 2, y = view.height / 2) {
  const zoom = Math.max(1, Math.min(40, view.zoom * factor)), s = scaleOf();
  const e = view.east + (x - view.width / 2) / s, n = view.north - (y - view.height / 2) / s;
  view.east = e - ((e - view.east) * view.zoom) / zoom;
  view.north = n - ((n - view.north) * view.zoom) / zoom;
  view.zoom = zoom;
  if (zoom === 1) wholeMap();
  drawMap();
}
function wholeMap() {
  Object.assign(view, { east: (MAP.west + MAP.east) / 2, north: (MAP.south + MAP.north) / 2, zoom: 1 });
}
// Brings a place into view where the map is enlarged.
function showPlace(e, n) {
  const x = toX(e), y = toY(n);
  if (x < 30 || y < 30 || x > view.width - 30 || y > view.height - 30) { view.east = e; view.north = n; }
}

function openMap() {
  legendOfMap();
  shapePaper();
  let held = null;
  for (const button of document.querySelectorAll('[data-map]')) {
    button.addEventListener('click', () => {
      if (button.dataset.map === 'whole') { wholeMap(); drawMap(); } else enlarge(button.dataset.map === 'in' ? 1.6 : 1 / 1.6);
    });
  }
  const keys = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  plate.addEventListener('keydown', (event) => {
    if (keys[event.key] && view.zoom > 1) {
      view.east += (keys[event.key][0] * 60) / scaleOf();
      view.north += (keys[event.key][1] * 60) / scaleOf();
      drawMap();
    } else if (event.key === '+' || event.key === '=') enlarge(1.6);
    else if (event.key === '-') enlarge(1 / 1.6);
    else return;
    event.preventDefault();
  });
  plate.addEventListener('wheel', (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    const edge = plate.getBoundingClientRect();
    enlarge(Math.exp(-event.deltaY / 300), event.clientX - edge.left, event.clientY - edge.top);
  }, { passive: false });
  plate.addEventListener('pointerdown', (event) => {
    if (event.target.closest('.finding')) return;
    held = { x: event.clientX, y: event.clientY };
    plate.setPointerCapture(event.pointerId);
  });
  plate.addEventListener('pointerup', () => { held = null; });
  plate.addEventListener('pointercancel', () => { held = null; });
  plate.addEventListener('pointermove', (event) => {
    if (held && view.zoom > 1) {
      const s = scaleOf();
      view.east -= (event.clientX - held.x) / s;
      view.north += (event.clientY - held.y) / s;
      held = { x: event.clientX, y: event.clientY };
      drawMap();
      return;
    }
    const edge = plate.getBoundingClientRect(), x = event.clientX - edge.left, y = event.clientY - edge.top;
    let best = [Infinity, 0, 0];
    MISSIONS.forEach(({ track }, k) => track.e.forEach((e, i) => {
      if (e === null || track.n[i] === null) return;
      const away = Math.hypot(toX(e) - x, toY(track.n[i]) - y);
      if (away < best[0]) best = [away, k, i];
    }));
    if (best[0] < 24) moveTo(best[1], best[2]);
  });
  listeners.push(moveMapCursor);
}
