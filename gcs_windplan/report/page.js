// Findings lead to their place; everything is drawn, and drawn again where its room changes.
function choose(k, i, scroll) {
  const finding = MISSIONS[k].findings[i];
  state.chosen = [k, i];
  for (const item of document.querySelectorAll('.findings li')) item.classList.toggle('chosen', item.id === `finding-${k}-${i}`);
  if (finding.e !== null) showPlace(finding.e, finding.n);
  if (finding.at !== null) moveTo(k, finding.at);
  drawCharts();
  drawMap();
  if (scene) scene.draw();
  if (scroll) document.querySelector('.where .map').scrollIntoView();
}

document.addEventListener('click', (event) => {
  const link = event.target.closest('[data-finding]');
  if (!link) return;
  const fromList = link.tagName === 'A';
  if (fromList) event.preventDefault();
  choose(Number(link.dataset.mission), Number(link.dataset.finding), fromList);
  if (fromList) byId('position').focus({ preventScroll: true });
  else byId(`finding-${link.dataset.mission}-${link.dataset.finding}`).scrollIntoView({ block: 'nearest' });
});

openCharts();
openMap();
const redraw = () => { drawCharts(); drawMap(); };
redraw();
moveTo(LONGEST, 0);
new ResizeObserver(redraw).observe(byId('charts'));
new ResizeObserver(drawMap).observe(plate);

const seen = new IntersectionObserver((entries) => {
  if (!entries.some((entry) => entry.isIntersecting)) return;
  seen.disconnect();
  openScene();
}, { rootMargin: '300px' });
seen.observe(byId('scene'));
let folded = [];
const onPaper = (printing) => { state.printing = printing; redraw(); };
window.addEventListener('beforeprint', () => {
  onPaper(true);
  folded = [...document.querySelectorAll('details:not([open])')];
  for (const one of folded) one.open = true;
});
window.addEventListener('afterprint', () => {
  onPaper(false);
  for (const one of folded) one.open = false;
});
