// The gallery page's style sheet.
#pragma once

namespace nacre {

inline constexpr const char* kPageStyle = R"css(
:root { color-scheme: light dark; --ink: #1b1d22; --soft: #5b616e; --paper: #fbfaf8; --card: #ffffff; --line: #dcd9d3;
  --link: #1f5fae; --code: #f1efeb; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e6e1; --soft: #a3a8b3; --paper: #16181c; --card: #1e2126; --line: #363a42; --link: #8ab8f5;
    --code: #282c33; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-padding-top: 1rem; }
body { margin: 0; background: var(--paper); color: var(--ink); line-height: 1.5;
  font: 1rem/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 74rem; margin: 0 auto; padding: 1.2rem 1rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.15; margin: .4rem 0 .6rem; }
h2 { font-size: 1.35rem; line-height: 1.25; margin: 2.6rem 0 .6rem; border-bottom: 1px solid var(--line);
  padding-bottom: .3rem; }
h4 { font-size: .95rem; margin: 1rem 0 0; }
h3 { font-size: 1.1rem; line-height: 1.3; margin: 0 0 .4rem; }
p { margin: .4rem 0 .8rem; max-width: 46rem; }
a { color: var(--link); }
.soft, figcaption, .note { color: var(--soft); font-size: .87rem; }
article { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 1rem; margin: 1rem 0; }
.shots { display: grid; gap: .8rem; grid-template-columns: repeat(auto-fit, minmax(min(15rem, 100%), 1fr));
  margin: .8rem 0; }
figure { margin: 0; min-width: 0; }
.pair { display: grid; align-content: start; min-width: 0; grid-row: span var(--figures);
  grid-template-rows: subgrid; }
.pair:only-child { grid-row: auto; grid-template-rows: none; gap: .8rem;
  grid-template-columns: repeat(auto-fit, minmax(min(15rem, 100%), 1fr)); }
figure img { display: block; width: 100%; height: auto; border-radius: 6px; background: #777; }
figcaption { margin-top: .3rem; }
.scale { height: .7rem; border-radius: 3px; border: 1px solid var(--line); margin-top: .35rem; }
.unit { font-size: .78rem; color: var(--soft); }
.ticks { display: flex; justify-content: space-between; font-size: .78rem; color: var(--soft);
  font-variant-numeric: tabular-nums; }
table { border-collapse: collapse; font-size: .87rem; font-variant-numeric: tabular-nums; width: 100%; }
th, td { text-align: right; padding: .28rem .55rem; border-bottom: 1px solid var(--line); vertical-align: top; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
th { color: var(--soft); font-weight: 600; }
dl { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(8.6rem, 46%), 1fr)); gap: .5rem .9rem;
  margin: .8rem 0; font-variant-numeric: tabular-nums; }
dt { color: var(--soft); font-size: .78rem; }
dd { margin: 0; font-size: .95rem; overflow-wrap: anywhere; }
pre { background: var(--code); border-radius: 6px; padding: .6rem .7rem; margin: .5rem 0 0; font-size: .82rem;
  white-space: pre-wrap; overflow-wrap: anywhere; }
code { background: var(--code); border-radius: 4px; padding: 0 .2em; overflow-wrap: anywhere; }
@media (max-width: 40rem) {
  body { font-size: .97rem; }
  article { padding: .8rem; }
  table.cards thead { display: none; }
  table.cards tr { display: grid; grid-template-columns: 1fr 1fr; gap: 0 .8rem; padding: .5rem 0;
    border-bottom: 1px solid var(--line); }
  table.cards td { display: flex; justify-content: space-between; gap: .5rem; border: 0; padding: .05rem 0; }
  table.cards td:first-child { grid-column: 1 / -1; font-weight: 600; }
  table.cards td:not(:first-child)::before { content: attr(data-name); color: var(--soft); } }
@media print { article { break-inside: avoid; } }
)css";

}  // namespace nacre
