// The charts over distance or time: heights, wind, speeds, power, battery.
const EDGE = { left: 48, right: 14 };
const LONGEST = MISSIONS.map((m, k) => k).reduce((a, b) => (last(MISSIONS[b].track.d) > last(MISSIONS[a].track.d) ? b : a));
const QUANTITIES = {
  wind: { unit: 'm/s', lines: [['along', 'along (+ from behind)'], ['across', 'across (+ to the right)']], zero: true, height: 116 },
  speed: { unit: 'm/s', lines: [['over', 'ground speed'], ['air', 'airspeed']], height: 116 },
  power: { unit: 'W', lines: [['power', 'power']], height: 96 },
  battery: { unit: '%', lines: [['left', 'battery left']], height: 96, floor: true },
};
const charts = [...document.querySelectorAll('.chart')].map((element) => ({
  kind: element.dataset.chart, plot: element.querySelector('.plot'), legend: element.querySelector('.legend'),
}));
let across = null; // from the axis to pixels

function scaleX(width) {
  const high = Math.max(1, ...MISSIONS.map((_, k) => last(axisOf(k))));
  const inner = width - EDGE.left - EDGE.right;
  return { high, width, to: (v) => (v == null ? null : EDGE.left + (v / high) * inner), from: (x) => ((x - EDGE.left) / inner) * high };
}
function scaleY(low, high, top, bottom) {
  return (v) => (v == null ? null : bottom - ((v - low) / (high - low || 1)) * (bottom - top));
}

function alongTicks(width) {
  const count = Math.max(2, Math.floor(width / 72));
  if (state.axis === 't') return timeTicks(0, across.high, count).map((t) => [t, clock(t)]);
  const found = ticks(0, across.high / 1000, count);
  const digits = found.length > 1 && found[1] - found[0] < 1 ? (found[1] - found[0] < 0.1 ? 2 : 1) : 0;
  return found.map((km) => [km * 1000, number(km, digits)]);
}
// The other quantity on the upper axis: times over a distance axis and the other way round.
function otherTicks(width) {
  const { track } = MISSIONS[0], count = Math.max(2, Math.floor(width / 80));
  const [mine, other] = state.axis === 'd' ? [track.d, track.t] : [track.t, track.d];
  const high = last(other);
  const marks = state.axis === 'd' ? timeTicks(0, high, count) : ticks(0, high / 1000, count).map((km) => km * 1000);
  const digits = marks.length > 1 && marks[1] - marks[0] < 1000 ? 1 : 0;
  return marks.map((v) => [mine[nearest(other, v)], state.axis === 'd' ? clock(v) : number(v / 1000, digits)]);
}

function frame(width, height, top, bottom, y, low, high, unit, axes) {
  let text = '';
  for (const [v, label] of alongTicks(width)) {
    const x = px(across.to(v));
    text += `<path class="grid" d="M${x} ${top}V${bottom}"/>`;
    if (axes) text += `<text x="${x}" y="${bottom + 14}" text-anchor="middle">${label}</text>`;
  }
  for (const v of ticks(low, high, (bottom - top) / 26)) {
    text += `<path class="grid" d="M${EDGE.left} ${px(y(v))}H${width - EDGE.right}"/>` +
      `<text x="${EDGE.left - 6}" y="${px(y(v) + 4)}" text-anchor="end">${number(v, high - low < 3 ? 1 : 0)}</text>`;
  }
  return text;
}

const line = (k, xs, ys, classes) => `<path class="s r${k} ${classes}" d="${path(xs, ys)}"/>`;
const swatch = (classes, label) =>
  `<span><svg width="26" height="8" aria-hidden="true"><path class="${classes}" d="M1 4h24"/></svg>${label}</span>`;
const box = (classes, label) =>
  `<span><svg width="14" height="10" aria-hidden="true"><rect class="${classes}" width="14" height="10"/></svg>${label}</span>`;

function drawHeights(chart, width) {
  const axes = true, top = TWO ? 26 : 42, height = 250, bottom = height - 34;
  const [low, high] = heightRange();
  const y = scaleY(low, high, top, bottom);
  let under = '', over = '';
  MISSIONS.forEach((mission, k) => {
    const { track } = mission, xs = axisOf(k).map(across.to), ground = track.g.map(y);
    const last_ = xs.length - 1;
    under += area(xs, ground, bottom, `ground r${k}`) + `<path class="ground-line r${k}" d="${path(xs, ground)}"/>`;
    if (mission.clearance && !TWO) {
      const lifted = track.g.map((g) => (g === null ? null : y(g + mission.clearance)));
      under += between(xs, ground, lifted);
    }
    if (mission.maxHeight && (k === 0 || mission.maxHeight !== MISSIONS[0].maxHeight || TWO)) {
      under += `<path class="limit" d="${path(xs, track.g.map((g) => (g === null ? null : y(g + mission.maxHeight))))}"/>`;
    }
    over += line(k, xs, track.z.map(y), '');
    over += stopMarks(k, y, xs[last_]);
  });
  const signs = [];
  MISSIONS.forEach((mission, k) => mission.findings.forEach((finding, i) => {
    const { at } = finding;
    if (at === null) return;
    const x = across.to(axisOf(k)[at]), z = mission.track.z[at];
    if (x === null || z === null) return;
    const chosen = state.chosen && state.chosen[0] === k && state.chosen[1] === i;
    over += findingMark(k, i, beside(signs, x, y(z) - 18, width, top, bottom - 8), [x, y(z)], chosen);
  }));
  const [below, above] = state.axis === 'd' ? ['distance along the route [km]', 'time since take-off [min:s]'] : ['time since take-off [min:s]', 'distance along the route [km]'];
  let upper = '';
  if (!TWO) {
    let free = -Infinity;
    for (const [v, label] of otherTicks(width)) {
      const x = across.to(v);
      if (x === null || x < free) continue;
      free = x + 44;
      upper += `<path class="zero" d="M${px(x)} ${top - 5}v5"/><text x="${px(Math.min(x, width - 16))}" y="${top - 9}" text-anchor="middle">${label}</text>`;
    }
    upper += `<text x="${width - EDGE.right}" y="11" text-anchor="end">${above}</text>`;
  }
  chart.plot.innerHTML = svg(width, height, `<defs><clipPath id="clip"><rect x="${EDGE.left}" y="${top}" width="${width - EDGE.left - EDGE.right}" height="${bottom - top}"/></clipPath></defs>` +
    frame(width, height, top, bottom, y, low, high, 'm', axes) + `<g clip-path="url(#clip)">${under}</g>${over}${upper}` +
    `<text x="${EDGE.left}" y="11">m AMSL</text><text x="${width - EDGE.right}" y="${height - 5}" text-anchor="end">${below}</text>` + cursorParts(top, bottom));
  chart.y = [y];
  chart.of = ['z'];
  chart.legend.innerHTML = '<b>Altitude</b>' + routes() + box('ground', 'ground') +
    (!TWO && MISSIONS[0].clearance ? box('band', `clearance, ${number(MISSIONS[0].clearance)} m`) : '') +
    (MISSIONS.some((m) => m.maxHeight) ? swatch('limit', `height limit, ${[...new Set(MISSIONS.filter((m) => m.maxHeight).map((m) => number(m.maxHeight)))].join(' and ')} m`) : '');
}

const routes = () => (TWO ? MISSIONS.map((m, k) => swatch(`s r${k}`, `${LETTERS[k]} ${escape(m.name)}`)).join('') : swatch('s r0', 'route'));

function heightRange() {
  let [low, high] = span(...MISSIONS.flatMap((m) => [m.track.z, m.track.g]));
  const limit = Math.max(0, ...MISSIONS.map((m) => m.maxHeight || 0));
  const tallest = span(...MISSIONS.map((m) => m.track.g))[1] + limit;
  if (tallest - high < 0.6 * (high - low)) high = Math.max(high, tallest);
  const air = 0.08 * (high - low || 10);
  return [low - air, high + 1.4 * air];
}

function stopMarks(k, y, end) {
  const { stops } = MISSIONS[k];
  let text = '', free = -Infinity, close = -Infinity;
  const every = numbered(stops.length);
  for (const [n, label, , , z, d, t] of stops) {
    const x = across.to(state.axis === 'd' ? d : t);
    if (x === null || z === null) continue;
    if (x < close && n < stops.length) continue;
    close = x + 8;
    text += `<circle class="stop r${k}" cx="${px(x)}" cy="${px(y(z))}" r="3"><title>${escape(label)} ${n}</title></circle>`;
    if (!TWO && x > free && (n % every === 0 || stops.length <= 40)) {
      text += `<text x="${px(x)}" y="${px(y(z) + 15)}" text-anchor="middle">${n}</text>`;
      free = x + 24;
    }
  }
  return text;
}

function area(xs, ys, bottom, classes) {
  let text = '', start = -1;
  for (let i = 0; i <= xs.length; i++) {
    const there = i < xs.length && xs[i] !== null && ys[i] !== null;
    if (there && start < 0) start = i;
    if (!there && start >= 0) {
      text += `${path(xs.slice(start, i), ys.slice(start, i))}V${bottom}H${px(xs[start])}Z`;
      start = -1;
    }
  }
  return `<path class="${classes}" d="${text}"/>`;
}
function between(xs, lower, upper) {
  const known = xs.map((_, i) => i).filter((i) => xs[i] !== null && lower[i] !== null);
  if (!known.length) return '';
  const there = path(known.map((i) => xs[i]), known.map((i) => upper[i]));
  const back = path(known.map((i) => xs[i]).reverse(), known.map((i) => lower[i]).reverse());
  return `<path class="band" d="${there}L${back.slice(1)}Z"/>`;
}

function drawQuantity(chart, width) {
  const { unit, lines, zero, height, floor } = QUANTITIES[chart.kind];
  const isLast = chart === charts[charts.length - 1];
  const top = 8, bottom = height - (isLast ? 34 : 6);
  let [low, high] = span(...MISSIONS.flatMap((m) => lines.map(([key]) => m.track[key] || [])));
  if (zero) { low = Math.min(low, 0); high = Math.max(high, 0); }
  const reserve = Math.max(0, ...MISSIONS.map((m) => m.reserve || 0));
  if (floor) { low = Math.min(0, low); high = Math.max(100, high); }
  const air = floor ? 0 : 0.1 * (high - low || 1);
  [low, high] = [low - air, high + air];
  const y = scaleY(low, high, top, bottom);
  let text = frame(width, height, top, bottom, y, low, high, unit, isLast);
  if (zero) text += `<path class="zero" d="M${EDGE.left} ${px(y(0))}H${width - EDGE.right}"/>`;
  if (floor && reserve) text += `<path class="limit" d="M${EDGE.left} ${px(y(reserve))}H${width - EDGE.right}"/>`;
  const labels = [];
  chart.y = []; chart.of = [];
  lines.forEach(([key, label], j) => {
    const classes = (j ? 'second' : '') + (TWO ? ' two' : '');
    MISSIONS.forEach((m, k) => {
      if (!m.track[key]) return;
      text += line(k, axisOf(k).map(across.to), m.track[key].map(y), classes);
      if (lines.length > 1 || !TWO) labels.push(swatch(`s r${k} ${classes}`, `${LETTERS[k]} ${label}`));
    });
    chart.y.push(y); chart.of.push(key);
  });
  if (TWO && lines.length === 1) labels.push(...MISSIONS.map((m, k) => swatch(`s r${k}`, LETTERS[k])));
  if (floor && reserve) labels.push(swatch('limit', `reserve, ${number(reserve)} %`));
  const below = state.axis === 'd' ? 'distance along the route [km]' : 'time since take-off [min:s]';
  if (isLast) text += `<text x="${width - EDGE.right}" y="${height - 5}" text-anchor="end">${below}</text>`;
  chart.plot.innerHTML = svg(width, height, text + cursorParts(top, bottom));
  const names = { wind: 'Wind', speed: 'Speed', power: 'Power', battery: 'Battery' };
  chart.legend.innerHTML = `<b>${names[chart.kind]}</b><span>[${unit}]</span>` + labels.join('');
}

const svg = (width, height, text) => `<svg viewBox="0 0 ${width} ${height}" aria-hidden="true">${text}</svg>`;
const cursorParts = (top, bottom) => `<g class="at" data-top="${top}" data-bottom="${bottom}"></g>`;

const PRINTED = 960; // [px] wide on paper, whatever the window
function drawCharts() {
  const width = state.printing ? PRINTED : Math.max(260, Math.round(byId('charts').clientWidth));
  across = scaleX(width);
  for (const chart of charts) (chart.kind === 'heights' ? drawHeights : drawQuantity)(chart, width);
  moveChartCursor();
}

function moveChartCursor() {
  for (const chart of charts) {
    const place = chart.plot.querySelector('.at');
    if (!place) continue;
    let text = '';
    MISSIONS.forEach((m, k) => {
      const x = across.to(axisOf(k)[state.at[k]]);
      if (x === null) return;
      if (k === 0 || !text) text += `<path class="cursor" d="M${px(x)} ${place.dataset.top}V${place.dataset.bottom}"/>`;
      chart.of.forEach((key, j) => {
        const y = m.track[key] && chart.y[j](m.track[key][state.at[k]]);
        if (typeof y === 'number') text += `<circle class="dot" cx="${px(x)}" cy="${px(y)}" r="3.5"/>`;
      });
    });
    place.innerHTML = text;
  }
}

// The read-out in words: what the cursor is at.
function readings(k) {
  const { track } = MISSIONS[k], i = state.at[k];
  const value = (key) => track[key]?.[i] ?? null;
  const above = value('z') === null || value('g') === null ? null : value('z') - value('g');
  const rows = [
    ['distance', `${number(value('d') === null ? null : value('d') / 1000, 2)} km`],
    ['time', `${clock(value('t'))}`],
    ['altitude', `${number(value('z'), 0)} m`],
    ['above ground', `${number(above, 0)} m`],
    ['wind along', `${number(value('along'), 1, true)} m/s`],
    ['across', `${number(value('across'), 1, true)} m/s`],
    ['ground speed', `${number(value('over'), 1)} m/s`],
    ['airspeed', `${number(value('air'), 1)} m/s`],
  ];
  if (track.power) rows.push(['power', `${number(value('power'), 0)} W`]);
  if (track.left) rows.push(['battery', `${number(value('left'), 0)} %`]);
  rows.push(['leg', value('leg') === 0 ? 'take-off' : number(value('leg'))]);
  return rows;
}

function readOut() {
  byId('readout').innerHTML = MISSIONS.map((_, k) => '<div>' + (TWO ? `<span class="route route-${k}"><svg viewBox="0 0 26 8"><path d="M1 4h24"/></svg>${LETTERS[k]}</span>` : '') +
    readings(k).map(([what, text]) => `<div class="at"><span>${what}</span><b>${text}</b></div>`).join('') + '</div>').join('');
  const slider = byId('position');
  slider.value = state.at[LONGEST];
  slider.setAttribute('aria-valuetext', MISSIONS.map((_, k) => `${LETTERS[k]} ${readings(k).map((row) => row.join(' ')).join(', ')}`.trim()).join('; '));
}

function openCharts() {
  const slider = byId('position'), area_ = byId('charts');
  slider.max = MISSIONS[LONGEST].track.d.length - 1;
  slider.addEventListener('input', () => moveTo(LONGEST, Number(slider.value)));
  const point = (event) => {
    const x = event.clientX - area_.getBoundingClientRect().left;
    moveTo(LONGEST, nearest(axisOf(LONGEST), across.from(x)));
  };
  area_.addEventListener('pointermove', point);
  area_.addEventListener('pointerdown', (event) => {
    if (event.target.closest('.finding')) return;
    point(event);
    if (event.pointerType === 'mouse') { event.preventDefault(); slider.focus({ preventScroll: true }); }
  });
  for (const choice of document.querySelectorAll('input[name=axis]')) {
    choice.addEventListener('change', () => { state.axis = choice.value; drawCharts(); moveTo(LONGEST, state.at[LONGEST]); });
  }
  listeners.push(moveChartCursor, readOut);
}
