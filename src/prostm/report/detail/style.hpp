#pragma once
/// Style sheet of a report's page, for light and dark mode, phones and print.

#include <string_view>

namespace prostm::report::detail {

inline constexpr std::string_view kStyle = R"css(
:root{--paper:#fbfbfa;--ink:#1d2126;--faint:#59626c;--line:#d9dcdf;--mark:#eef2f6;--link:#1257a8;
--differs:#a33a12;--agrees:#1c6b3a}
@media (prefers-color-scheme:dark){:root{--paper:#16191d;--ink:#e4e7ea;--faint:#a3acb5;--line:#373d44;
--mark:#20262c;--link:#86b8ee;--differs:#f0a07c;--agrees:#83cf9c}}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0 auto;max-width:72rem;padding:1.5rem 1rem 4rem;background:var(--paper);color:var(--ink);
font:16px/1.5 system-ui,"DejaVu Sans",sans-serif}
h1{font-size:1.7rem;line-height:1.2;margin:0 0 1rem}
h2{font-size:1.25rem;margin:1.6rem 0 .4rem;padding-top:.6rem;border-top:1px solid var(--line)}
h3{font-size:1.05rem;margin:1.6rem 0 .4rem}
p{max-width:54rem;margin:.5rem 0}
a{color:var(--link)}
nav ul{display:flex;flex-wrap:wrap;gap:.3rem 1.1rem;list-style:none;margin:0;padding:0}
.finding,.verdict{border-left:4px solid var(--line);padding-left:.7rem;margin:.4rem 0}
.finding.differs,.verdict.differs{border-color:var(--differs)}
.finding.agrees,.verdict.agrees{border-color:var(--agrees)}
.verdict.differs b{color:var(--differs)}
.verdict.agrees b{color:var(--agrees)}
.verdict b::first-letter{text-transform:uppercase}
.verdict b{display:inline-block}
.verdict b::after{content:"."}
summary{cursor:pointer;color:var(--link);padding:.2rem 0}
.scroll{overflow-x:auto;margin:0 0 1rem;max-width:100%}
table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}
.caption{color:var(--faint);font-size:.9rem;margin:1.2rem 0 .2rem}
th,td{padding:.25rem .7rem;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}
th{vertical-align:bottom;font-weight:600}
th small{font-weight:400;color:var(--faint)}
th.n,td.n{text-align:right}
td.n{white-space:nowrap}
td:first-child:not(.n){min-width:8rem}
tr.marked td{background:var(--mark);font-style:italic}
figure{margin:1.2rem 0}
.card{background:#fff;border:1px solid var(--line);border-radius:6px;padding:.5rem;overflow-x:auto}
.card svg{display:block;max-width:100%;height:auto;margin:0 auto}
figcaption{color:var(--faint);font-size:.9rem;margin-top:.4rem;max-width:54rem}
@media (max-width:40rem){td:not(.n){min-width:8.5rem}.card svg{max-width:none;width:46rem!important}body{font-size:15px}}
@media print{:root{--paper:#fff;--ink:#000;--faint:#444;--line:#bbb;--mark:#f0f0f0;--link:#000}
body{max-width:none;padding:0;font-size:10pt}nav,summary{display:none}.scroll,.card{overflow:visible}
details::details-content{content-visibility:visible;display:block}
table{font-size:8pt}th,td{padding:.15rem .35rem}figure,tr{break-inside:avoid}h2,h3{break-after:avoid}
.card svg{max-height:24cm}}
)css";

}  // namespace prostm::report::detail
