// What all drawings share: the numbers, words for them, SVG text, and the one cursor.
const DATA = JSON.parse(document.getElementById('numbers').textContent);
const MISSIONS = DATA.missions;
const TWO = MISSIONS.length > 1;
const LETTERS = TWO ? ['A', 'B'] : [''];

const byId = (id) => document.getElementById(id);
const escape = (text) => String(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
const HUGE = 1e9; // from here on numbers are written with a power of ten
const scientific = (value) => {
  const [head, power] = Math.abs(value).toExponential(1).split('e');
  return `${value < 0 ? '−' : ''}${Number(head)}×10${[...power.slice(1)].map((digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[digit]).join('')}`;
};
const number = (value, digits = 0, sign = false) => {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (Math.abs(value) >= HUGE) return (sign && value > 0 ? '+' : '') + scientific(value);
  let text = value.toFixed(digits);
  if (Number(text) === 0) text = text.replace('-', '');
  return (sign && Number(text) > 0 ? '+' : '') + text.replace('-', '−');
};
const clock = (seconds) => {
  if (seconds === null || !Number.isFinite(seconds)) return '–';
  if (Math.abs(seconds) >= HUGE) return number(seconds / 60);
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
};
const px = (value) => value.toFixed(1);

// The smallest and the largest of all numbers in some lists; nulls do not count.
function span(...lists) {
  let low = Infinity, high = -Infinity;
  for (const list of lists) {
    for (const value of list) {
      if (value === null) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

// Round places for an axis, about `count` of them.
function ticks(low, high, count, steps = [1, 2, 5, 10]) {
  const rough = (high - low) / Math.max(count, 1);
  if (!(rough > 0)) return [low];
  const ten = 10 ** Math.floor(Math.log10(rough));
  const step = ten * steps.find((s) => s * ten >= rough * 0.999);
  return multiples(step, Math.ceil(low / step - 1e-9), high + step * 1e-9);
}
// Multiples of a step from the `first` one on; never many, though numbers be so large that a step is lost in them.
function multiples(step, first, high) {
  const found = [];
  for (let i = 0; i < 200 && (first + i) * step <= high; i++) found.push((first + i) * step);
  return found;
}
const TIME_STEPS = [5, 10, 15, 30, 60, 120, 180, 300, 600, 900, 1800, 3600, 7200, 14400];
function timeTicks(low, high, count) {
  const step = TIME_STEPS.find((s) => s * count >= high - low) || 14400 * 10 ** Math.ceil(Math.log10((high - low) / count / 14400));
  return multiples(step, Math.ceil(low / step), high);
}

// A path through places; null breaks it.
function path(xs, ys) {
  let text = '', pen = 'M';
  for (let i = 0; i < xs.length; i++) {
    if (xs[i] === null || ys[i] === null) { pen = 'M'; continue; }
    text += `${pen}${px(xs[i])} ${px(ys[i])}`;
    pen = 'L';
  }
  return text;
}

// A free place for a sign near where it belongs, within the sheet: there, or on a ring around it.
function beside(taken, x, y, width, top, bottom) {
  const free = (a, b) => a > 12 && a < width - 12 && b > top && b < bottom && !taken.some(([c, d]) => Math.abs(a - c) < 21 && Math.abs(b - d) < 19);
  let place = [x, y];
  for (let ring = 1; ring < 6 && !free(...place); ring++) {
    for (let i = 0; i < 8 * ring && !free(...place); i++) {
      const turn = (2 * Math.PI * i) / (8 * ring);
      place = [x + 21 * ring * Math.cos(turn), y - 21 * ring * Math.sin(turn)];
    }
  }
  if (!free(...place)) place = [x, y];
  taken.push(place);
  return place;
}

const SHAPES = { danger: 'M-4-9h8l5 5v8l-5 5h-8l-5-5v-8z', warning: 'M0-12 12 9h-24z' };
// The sign of a finding at a place, tied to where it belongs.
function findingMark(k, i, [x, y], [homeX, homeY], chosen) {
  const { severity } = MISSIONS[k].findings[i];
  return `<g class="finding ${severity}${chosen ? ' chosen' : ''}" data-mission="${k}" data-finding="${i}" ` +
    `transform="translate(${px(x)} ${px(y)})">` +
    (Math.hypot(homeX - x, homeY - y) > 1 ? `<line class="tie" x2="${px(homeX - x)}" y2="${px(homeY - y)}"/>` : '') + `<title>${escape(MISSIONS[k].findings[i].text)}</title>` +
    `<circle class="ring" r="15"/><path d="${SHAPES[severity]}"/>` +
    `<text y="${severity === 'danger' ? 4 : 6.5}">${LETTERS[k]}${i + 1}</text></g>`;
}

// The cursor: an index into each mission's samples, all at the same place of the axis chosen.
const state = { axis: 'd', at: MISSIONS.map(() => 0), chosen: null, printing: false };
const listeners = [];
const axisOf = (k) => MISSIONS[k].track[state.axis];
const last = (list) => { for (let i = list.length; i--;) if (list[i] !== null) return list[i]; return 0; };

function nearest(list, value) {
  let best = 0, gap = Infinity;
  for (let i = 0; i < list.length; i++) {
    if (list[i] === null) continue;
    const away = Math.abs(list[i] - value);
    if (away < gap) { gap = away; best = i; }
  }
  return best;
}

// Puts the cursor onto sample `index` of mission `k`; the other mission's goes to the same distance or time.
function moveTo(k, index) {
  const x = axisOf(k)[index];
  state.at = MISSIONS.map((_, other) => (other === k || x == null ? index : nearest(axisOf(other), x)));
  for (const listen of listeners) listen();
}
