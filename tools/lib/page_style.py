"""Style and script of the pages of tools/study and tools/report."""

STYLE = """
:root { color-scheme: light dark; --back: #fbfbfa; --card: #ffffff; --text: #1c1d1f; --soft: #5d6167; --line: #dcdee1;
        --warn: #8a5a00; --tint: #f1f2f3; --link: #1a5fb4; --s0: #2166ac; --s1: #c4500b; --s2: #1b7a43; --s3: #8a3fa8; }
@media (prefers-color-scheme: dark) {
  :root { --back: #131416; --card: #1c1e21; --text: #e8e9eb; --soft: #a0a5ac; --line: #34373c; --warn: #e5b454;
          --tint: #25282c; --link: #8ab8f0; --s0: #6fb1f2; --s1: #f2934e; --s2: #63cf93; --s3: #cf95ea; } }
* { box-sizing: border-box; }
html { scroll-behavior: smooth; } @media (prefers-reduced-motion: reduce) { html { scroll-behavior: auto; } }
body { margin: 0 auto; max-width: 76rem; padding: 1.5rem 1rem 4rem; background: var(--back); color: var(--text);
       font: 15px/1.5 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; margin: 0 0 .5rem; } h2 { font-size: 1.3rem; margin: 3rem 0 .5rem; padding-top: .5rem; border-top: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 0 0 .6rem; font-weight: 600; }
p { margin: .4rem 0; color: var(--soft); max-width: 60rem; } .words { color: var(--text); margin: 1rem 0; }
a { color: var(--link); } :focus-visible { outline: 2px solid var(--link); outline-offset: 2px; }
nav { display: flex; flex-wrap: wrap; gap: .3rem 1rem; margin: 1rem 0; }
.block { margin: 1.25rem 0 1.75rem; }
.scroll { overflow-x: auto; border: 1px solid var(--line); border-radius: 8px; background: var(--card); margin: .6rem 0; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: .88rem; }
th, td { padding: .4rem .55rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; vertical-align: top; overflow-wrap: break-word; }
th { color: var(--soft); font-weight: 600; background: var(--tint); white-space: normal; vertical-align: bottom; min-width: 3.6rem; }
tr:last-child td { border-bottom: 0; }
th:first-child, td:first-child { text-align: left; position: sticky; left: 0; background: var(--card); white-space: normal; min-width: 7rem; }
th:first-child { background: var(--tint); }
.summary td { white-space: normal; } .summary td:last-child, .summary th:last-child { text-align: left; }
.summary td:first-child { position: static; }
.pictures { display: grid; gap: 1rem; align-items: start; grid-template-columns: minmax(0, 1fr); }
.sheet { display: grid; gap: .75rem; grid-template-columns: repeat(auto-fill, minmax(min(100%, 9.5rem), 1fr)); }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; overflow: hidden; }
img { display: block; width: 100%; image-rendering: pixelated; background: #000; }
figcaption { padding: .4rem .6rem .5rem; font-size: .85rem; line-height: 1.35; }
figcaption span { display: block; color: var(--soft); font-variant-numeric: tabular-nums; }
figcaption .mark { display: inline; white-space: nowrap; } .mark, .standin { color: var(--warn); }
.standin { font-size: .87rem; margin: .35rem 0 0; }
.choices { display: flex; gap: .5rem; justify-content: space-between; font-size: .85rem; color: var(--soft); }
.choices label { min-width: 0; flex: 1; } .choices label + label { text-align: right; }
select { font: inherit; max-width: 100%; color: var(--text); background: var(--card); border: 1px solid var(--line); border-radius: 5px; padding: .15rem; }
.stage { position: relative; margin: .5rem 0; border: 1px solid var(--line); border-radius: 8px; overflow: hidden; cursor: ew-resize; touch-action: pan-y; }
.over { position: absolute; inset: 0; height: 100%; clip-path: inset(0 calc(100% - var(--at, 50%)) 0 0); }
.stage i { position: absolute; top: 0; bottom: 0; left: var(--at, 50%); width: 2px; margin-left: -1px; background: #fff; box-shadow: 0 0 0 1px #0008; }
.slide { display: flex; gap: .6rem; align-items: center; font-size: .85rem; color: var(--soft); } .slide input { flex: 1; min-width: 0; }
.chart { display: block; width: 100%; max-width: 46rem; background: var(--card); border: 1px solid var(--line); border-radius: 8px; margin: .6rem 0; }
.chart text { fill: var(--soft); font-size: 14px; } .chart .axis { fill: var(--text); }
.grid { stroke: var(--line); fill: none; }
.series .line { fill: none; stroke-width: 2; } .series .bar { stroke-width: 1.5; fill: none; }
.s0 { fill: var(--s0); stroke: var(--s0); } .s1 { fill: var(--s1); stroke: var(--s1); }
.s2 { fill: var(--s2); stroke: var(--s2); } .s3 { fill: var(--s3); stroke: var(--s3); }
.legend { display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; font-size: .88rem; } .legend span { display: inline-flex; gap: .4rem; align-items: center; }
details { margin: .5rem 0 0; font-size: .87rem; } summary { cursor: pointer; color: var(--soft); }
pre { margin: .4rem 0 0; padding: .6rem .7rem; overflow-x: auto; background: var(--tint); border-radius: 6px; font-size: .8rem; line-height: 1.6; }
@media (min-width: 52rem) { .pictures:has(.compare:not([hidden])) { grid-template-columns: minmax(20rem, 26rem) 1fr; } }
@media (max-width: 40rem) {
  .sheet { grid-template-columns: 1fr 1fr; }
  th, td { padding: .35rem .5rem; font-size: .82rem; }
  td:first-child, th:first-child { min-width: 6.5rem; max-width: 8rem; white-space: normal; } .summary td:first-child { max-width: none; } }
"""

SCRIPT = """
for (const box of document.querySelectorAll('.compare')) {
  const images = box.parentElement.querySelectorAll('.sheet img');
  const stage = box.querySelector('.stage'), range = box.querySelector('input');
  const move = () => stage.style.setProperty('--at', range.value + '%');
  const show = () => {
    for (const [side, kind] of [['left', 'over'], ['right', 'under']]) {
      const image = stage.querySelector('.' + kind), chosen = images[box.querySelector('.' + side).value];
      image.src = chosen.src;
      image.alt = side + ': ' + chosen.alt;
    }
  };
  const drag = event => {
    if (!(event.buttons & 1)) return;
    const frame = stage.getBoundingClientRect();
    range.value = 100 * (event.clientX - frame.left) / frame.width;
    move();
  };
  for (const select of box.querySelectorAll('select')) select.addEventListener('change', show);
  range.addEventListener('input', move);
  stage.addEventListener('pointerdown', drag);
  stage.addEventListener('pointermove', drag);
  stage.addEventListener('dragstart', event => event.preventDefault());
  box.hidden = false;
  move();
  show();
}
"""
