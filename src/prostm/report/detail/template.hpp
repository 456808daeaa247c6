#pragma once
/// Mustache templates of a report's page. A value in two braces is escaped, one in three is not.

#include <string_view>

namespace prostm::report::detail {

/// The page. A part shows the blocks of `open`; those of `folded` are in an element that opens.
inline constexpr std::string_view kPage = R"html(<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{{title}}</title>
<style>{{{style}}}</style></head>
<body>
<header><h1>{{title}}</h1></header>
<nav aria-label="Parts"><ul>
{{#parts}}
<li><a href="#{{id}}">{{heading}}</a></li>
{{/parts}}
</ul></nav>
<main>
{{#parts}}
<section id="{{id}}">
<h2 data-from="{{id}}.json#/title">{{heading}}</h2>
{{#open}}
{{>block}}
{{/open}}
{{#has_folded}}
<details><summary>Method, figures and tables</summary>
{{#folded}}
{{>block}}
{{/folded}}
</details>
{{/has_folded}}
</section>
{{/parts}}
</main>
</body></html>
)html";

/// A block: one of its sections is true.
inline constexpr std::string_view kBlock = R"html({{#text}}
<p data-from="{{from}}">{{>inline}}</p>
{{/text}}
{{#subheading}}
<h3 data-from="{{from}}">{{>inline}}</h3>
{{/subheading}}
{{#verdict}}
<p class="verdict {{kind}}"><b data-from="{{from}}/agreement">{{agreement}}</b>
<span data-from="{{from}}/text">{{words}}</span></p>
{{/verdict}}
{{#finding}}
<p class="finding {{kind}}"><span data-from="{{from}}/text">{{words}}</span>
<a href="#{{section}}" data-from="{{from}}/link">{{link}}</a></p>
{{/finding}}
{{#table}}
<p class="caption" data-from="{{from}}/caption">{{>inline}}</p>
<div class="scroll" tabindex="0"><table>
<thead><tr>{{#columns}}<th scope="col"{{#n}} class="n"{{/n}}><span data-from="{{from}}/name">{{name}}</span>
{{#unit}}<br><small data-from="{{from}}/unit">{{unit}}</small>{{/unit}}</th>{{/columns}}</tr></thead>
<tbody>
{{#rows}}
<tr{{#marked}} class="marked"{{/marked}}>{{#cells}}<td data-from="{{from}}"{{#digits}} data-digits="{{digits}}"{{/digits}}{{#n}} class="n"{{/n}}>{{value}}</td>{{/cells}}</tr>
{{/rows}}
</tbody></table></div>
{{/table}}
{{#figure}}
<figure><div class="card" role="img" aria-label="{{alt}}" tabindex="0">{{{svg}}}</div>
<figcaption data-from="{{from}}/caption">{{>inline}}</figcaption></figure>
{{/figure}}
)html";

/// A text with values in it.
inline constexpr std::string_view kInline =
    R"html({{#spans}}{{plain}}{{#element}}<span data-from="{{from}}"{{#digits}} data-digits="{{digits}}"{{/digits}})html"
    R"html({{#n}} class="n"{{/n}}>{{value}}</span>{{/element}}{{/spans}})html";

}  // namespace prostm::report::detail
