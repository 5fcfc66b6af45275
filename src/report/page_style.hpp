// How the page looks.
#pragma once

namespace gaussdrift::report {

constexpr const char* page_style = R"(
body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:60rem;margin:2rem auto;padding:0 1rem;overflow-wrap:break-word}
h1{margin-bottom:0;line-height:1.2}
h2{margin-top:2.2rem;border-bottom:1px solid #ddd}
.verdict{font-size:1.15rem;background:#f3f6f9;padding:.8rem 1rem;border-left:4px solid #0072b2}
.warning{background:#fdf3e7;padding:.6rem 1rem;border-left:4px solid #d55e00}
.bad{color:#b02a1a}
.quiet{color:#666}
img,svg{max-width:100%;height:auto}
svg text{font-size:13px}
table{border-collapse:collapse;margin:.6rem 0}
td,th{padding:.2rem .8rem .2rem 0;text-align:left;vertical-align:top}
td.n,.numbers th:not(.l){text-align:right;font-variant-numeric:tabular-nums}
td.n{white-space:nowrap}
tr.most td{font-weight:bold}
.bars{width:100%}
.bars .w{width:60%;padding-right:0}
.bars div{background:#86b6d8;height:1rem}
.facts td:last-child{overflow-wrap:anywhere}
pre{background:#f6f6f6;padding:.8rem;overflow:auto;font-size:.85rem}
.scroll{overflow-x:auto}
@media(max-width:40rem){body{margin:1rem auto}.bars .w{width:35%}svg text{font-size:22px}pre{font-size:.75rem}}
@media print{body{max-width:none;margin:0;font-size:10pt}h2{break-after:avoid}img,svg,tr{break-inside:avoid}
pre{white-space:pre-wrap;overflow-wrap:anywhere}.bars div,.verdict,.warning{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";

}  // namespace gaussdrift::report
