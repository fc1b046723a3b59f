"""What the report's page has beside the shared style and script: colours of the plots, keys of variants, marked cells."""

STYLE = """
:root { --floor: #e6e8eb; --good: #e3f2e6; --poor: #f8eadb; --head: #0b0c0e;
        --v0: #0072b2; --v1: #c8500a; --v2: #00805a; --v3: #a8458f; --v4: #8a6500; --v5: #2089c4; --v6: #5c5f66; --v7: #7d1f40; }
@media (prefers-color-scheme: dark) {
  :root { --floor: #2b2e33; --good: #1d3a27; --poor: #43301a; --head: #ffffff;
          --v0: #5cb3f0; --v1: #ff9350; --v2: #35cf9c; --v3: #f09bd6; --v4: #e6c04a; --v5: #a5dcff; --v6: #b9bcc4; --v7: #ff8fa6; } }
h4 { font-size: .9rem; margin: .9rem 0 .2rem; font-weight: 600; color: var(--soft); }
.headline { color: var(--head); font-size: 1.18rem; line-height: 1.4; margin: .7rem 0; max-width: 52rem; font-weight: 600; }
.more { margin: .3rem 0 1rem; padding-left: 1.1rem; } .more li { margin: .15rem 0; }
.warnings { border: 1px solid var(--warn); border-radius: 8px; padding: .6rem .9rem; margin: 1rem 0; color: var(--warn); background: var(--card); }
.warned { color: var(--warn); font-weight: 600; }
.warnings ul { margin: .2rem 0 0; padding-left: 1.1rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2rem 1rem; margin: 1rem 0; font-size: .9rem; }
dt { color: var(--soft); } dd { margin: 0; min-width: 0; }
.plots { display: grid; gap: .9rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 27rem), 1fr)); align-items: start; margin: .6rem 0; }
.plots figure { padding: .6rem .5rem 0; } .plots figcaption { color: var(--soft); }
.plots figcaption b { color: var(--text); }
svg.plot { display: block; width: 100%; height: auto; font-family: system-ui, sans-serif; stroke-linejoin: round; }
svg.plot [class~=off] { display: none; }
.keys { display: flex; flex-wrap: wrap; gap: .4rem .5rem; margin: .6rem 0; }
.keys button { font: inherit; font-size: .88rem; color: var(--text); background: var(--card); border: 1px solid var(--line); border-radius: 999px;
               padding: .25rem .75rem .25rem .55rem; cursor: pointer; display: inline-flex; gap: .45rem; align-items: center; min-height: 2rem; text-align: left; }
.keys button[aria-pressed=false] { opacity: .5; text-decoration: line-through; }
.swatch { flex: none; overflow: visible; } .variant { display: inline-flex; gap: .45rem; align-items: center; font-weight: 400; color: var(--text); }
th[scope=row] { vertical-align: top; font-weight: 400; color: var(--text); background: var(--card); z-index: 1; }
tr:last-child th[scope=row] { border-bottom: 0; } td small { display: block; white-space: pre; color: var(--soft); font-size: .8em; }
td.best { font-weight: 600; } td.best small { font-weight: 400; }
td.gain { background: var(--good); } td.loss { background: var(--poor); } td.self { background: var(--tint); }
td.extrapolated { font-style: italic; } td.outside { color: var(--warn); font-weight: 600; } td.outside small { font-weight: 400; }
td.none small { white-space: normal; min-width: 8rem; } td.none { color: var(--soft); }
.strip img + img { border-top: 1px solid var(--line); }
.strip .gap { aspect-ratio: 1; display: grid; place-items: center; background: var(--tint); color: var(--soft); font-size: .85rem; }
section:only-of-type > h2 { border: 0; margin: 0; padding: 0; }
section > .facts summary, details.block > summary { font-size: .95rem; } details.block { font-size: inherit; }
@media (max-width: 40rem) { svg.plot text { font-size: 11.5px !important; }
  dl { grid-template-columns: 1fr; gap: 0; } dd { margin: 0 0 .45rem; } .headline { font-size: 1.05rem; }
  .variant { flex-wrap: wrap; gap: .1rem .4rem; } th[scope=row] { max-width: 7.5rem; } body { padding: 1rem .75rem 3rem; } }
@media print { .keys, nav, .compare { display: none; } .block, figure { break-inside: avoid; } }
"""

SCRIPT = """
for (const keys of document.querySelectorAll('.keys')) {
  keys.addEventListener('click', event => {
    const button = event.target.closest('button');
    if (!button) return;
    const on = button.getAttribute('aria-pressed') === 'false';
    button.setAttribute('aria-pressed', on);
    for (const part of keys.closest('section').querySelectorAll('svg .variant-' + button.dataset.variant))
      part.classList.toggle('off', !on);
  });
}
"""
