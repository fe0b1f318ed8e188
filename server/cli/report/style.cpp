// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/style.h"

namespace vitrine::server {

const std::string_view kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #f6f4ef; --wall: #ebe7df; --ink: #2b2926; --quiet: #6f6a62; --line: #00000020;
  --ours: #1f4e5f; --bound: #7fa3b0; --peer: #b0562b;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #161514; --wall: #201f1d; --ink: #ece8e1; --quiet: #a8a196; --line: #ffffff24;
    --ours: #9cc7d4; --bound: #5b7f8a; --peer: #e09a6f;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: clamp(24px, 5vw, 64px) clamp(16px, 4vw, 40px); }
h1, h2 { font-family: "Iowan Old Style", "Palatino Linotype", Palatino, Georgia, serif; font-weight: 400; line-height: 1.2; }
h1 { font-size: clamp(1.7rem, 4vw, 2.6rem); margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.4rem; margin: 0 0 14px; }
section { margin-top: 52px; }
p { margin: 0; max-width: 68ch; }
.kind, .note, figcaption, footer { color: var(--quiet); font-size: .87rem; }
.kind { margin-bottom: 6px; }
.note { margin-top: 14px; }
data, td, .key dd, code { font-variant-numeric: tabular-nums; }
.key { display: grid; grid-template-columns: repeat(auto-fit, minmax(200px, 1fr)); gap: 18px 32px; margin: 30px 0 0; }
.key div { border-top: 1px solid var(--line); padding-top: 10px; }
.key dt { color: var(--quiet); font-size: .87rem; }
.key dd { margin: 0; }
.key strong { font-weight: 400; font-size: 1.55rem; line-height: 1.3; display: block; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 14px; }
figure { margin: 0; }
.pictures img { display: block; width: 100%; height: auto; background: var(--wall); border-radius: 4px; margin-bottom: 8px; }
figcaption b { color: var(--ink); font-weight: 500; display: block; }
svg { display: block; width: 100%; min-width: 560px; height: auto; font-size: 12.5px; }
svg text { fill: var(--quiet); }
.grid line { stroke: var(--line); }
.ours, .bound, .peer { fill: none; stroke-width: 2; stroke-linejoin: round; }
.ours { stroke: var(--ours); } .ours circle { fill: var(--ours); stroke: none; }
.bound { stroke: var(--bound); } .bound circle { fill: var(--paper); stroke-width: 1.5; }
.peer { stroke: var(--peer); } .peer path { stroke-dasharray: 6 5; } .peer circle { fill: var(--peer); stroke: none; }
svg g text { stroke: none; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; white-space: nowrap; }
th { font-weight: 400; color: var(--quiet); font-size: .87rem; vertical-align: bottom; }
th, td { text-align: right; padding: 5px 0 5px 22px; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
thead tr:first-child th { border: 0; padding-bottom: 0; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 380px), 1fr)); gap: 52px 48px; }
.facts dl { display: grid; grid-template-columns: max-content 1fr; margin: 0; }
.facts dt, .facts dd { border-bottom: 1px solid var(--line); padding: 5px 0; margin: 0; }
.facts dt { color: var(--quiet); padding-right: 24px; }
.facts dd { text-align: right; overflow-wrap: anywhere; }
.facts ul { margin: 0; padding-left: 1.1em; text-align: left; }
footer { margin-top: 56px; border-top: 1px solid var(--line); padding-top: 12px; }
@page { margin: 16mm; }
@media print {
  :root {
    color-scheme: light;
    --paper: #fff; --wall: #f4f2ed; --ink: #111; --quiet: #555; --line: #0003;
    --ours: #1f4e5f; --bound: #7fa3b0; --peer: #b0562b;
  }
  body { font-size: 10pt; }
  main { padding: 0; max-width: none; }
  section { margin-top: 9mm; }
  .key { grid-template-columns: repeat(4, 1fr); gap: 5mm; }
  .pictures { grid-template-columns: repeat(5, 1fr); }
  .facts { grid-template-columns: repeat(2, 1fr); gap: 8mm; }
  .scroll { overflow: visible; }
  th, td { padding-left: 12px; }
  img, svg, .pictures img { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  figure, tr, .key div, .facts div { break-inside: avoid; }
  h2 { break-after: avoid; }
}
)css";

}  // namespace vitrine::server
