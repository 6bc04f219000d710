#include "apps/page/page.h"

#include <fmt/core.h>

#include "bandlimit/io/atomic_file.h"

namespace bandlimit::app {
namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --text: #1f2328; --soft: #59636e; --line: #d1d9e0; --page: #ffffff; --box: #f6f8fa; --link: #0969da; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e6edf3; --soft: #9198a1; --line: #3d444d; --page: #0d1117; --box: #151b23; --link: #4493f8; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1080px; padding: 2.5rem 1.5rem 6rem; background: var(--page); color: var(--text);
       font: 16px/1.55 system-ui, -apple-system, "Segoe UI", sans-serif; }
h1 { font-size: 2.1rem; margin: 0 0 .3rem; letter-spacing: -.02em; }
h2 { margin: 3.5rem 0 .5rem; font-size: 1.45rem; letter-spacing: -.01em; border-top: 1px solid var(--line); padding-top: 2rem; }
p { max-width: 46rem; }
a { color: var(--link); text-decoration: none; }
ol.contents { columns: 2; column-gap: 3rem; max-width: 60rem; padding-left: 1.3rem; }
.source { color: var(--soft); font-size: .87rem; }
figure { margin: 1.6rem 0; }
figure img { display: block; max-width: 100%; height: auto; border-radius: 6px; background: #fff; border: 1px solid var(--line); }
figcaption { margin-top: .6rem; max-width: 46rem; font-size: .93rem; }
.tiles { display: flex; flex-wrap: wrap; gap: .8rem; }
.tiles div { font-size: .83rem; color: var(--soft); }
.tiles img { image-rendering: pixelated; border-radius: 4px; }
pre { background: var(--box); border: 1px solid var(--line); border-radius: 6px; padding: .55rem .8rem; margin: .5rem 0 0;
      font: 12.5px/1.5 ui-monospace, SFMono-Regular, Menlo, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .92rem; }
td, th { padding: .32rem .9rem; border-bottom: 1px solid var(--line); text-align: right; }
td:first-child, th:first-child { text-align: left; padding-left: .2rem; }
th { font-weight: 600; border-bottom-width: 2px; }
.numbers { display: grid; grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); gap: .8rem; margin: 1.6rem 0; }
.numbers div { background: var(--box); border: 1px solid var(--line); border-radius: 8px; padding: .7rem .9rem; font-size: .86rem; color: var(--soft); }
.numbers b { display: block; color: var(--text); font-size: 1.25rem; font-weight: 600; }
)";

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<') out += "&lt;";
        else if (c == '>') out += "&gt;";
        else if (c == '&') out += "&amp;";
        else out += c;
    }
    return out;
}

}  // namespace

Page::Page(std::string title, std::string introduction)
    : title_(std::move(title)), introduction_(std::move(introduction)) {}

void Page::section(const std::string& title, const std::string& text, const Citation& source) {
    ++sections_;
    contents_ += fmt::format("<li><a href=\"#s{}\">{}</a></li>\n", sections_, escaped(title));
    body_ +=
        fmt::format("<h2 id=\"s{}\">{}. {}</h2>\n<p>{}</p>\n", sections_, sections_, escaped(title), escaped(text));
    if (source.author.empty()) return;
    body_ += fmt::format("<p class=\"source\">After {}, <i>{}</i>, {}{}.</p>\n", escaped(source.author),
                         escaped(source.title), escaped(source.place), source.year.empty() ? "" : ", " + source.year);
}

void Page::caption(const std::string& sentence, const std::string& command) {
    body_ += fmt::format("<figcaption>{}{}</figcaption></figure>\n", escaped(sentence),
                         command.empty() ? "" : "<pre>" + escaped(command) + "</pre>");
}

void Page::figure(const std::string& file, const std::string& sentence, const std::string& command, int width) {
    body_ += fmt::format("<figure><img src=\"{}\" width=\"{}\" alt=\"{}\" loading=\"lazy\">", file, width,
                         escaped(sentence));
    caption(sentence, command);
}

void Page::gallery(const std::vector<Tile>& tiles, const std::string& sentence, const std::string& command, int width) {
    body_ += "<figure><div class=\"tiles\">";
    // A caption is no wider than its picture, so that it does not change how many stand side by side.
    for (const Tile& tile : tiles)
        body_ += fmt::format("<div style=\"max-width: {1}px\"><img src=\"{0}\" width=\"{1}\" alt=\"{2}\">{2}</div>",
                             tile.file, width, escaped(tile.caption));
    body_ += "</div>";
    caption(sentence, command);
}

void Page::table(const std::vector<std::vector<std::string>>& rows, const std::string& sentence,
                 const std::string& command) {
    body_ += "<figure><table>";
    const char* cell = "th";
    for (const auto& row : rows) {
        body_ += "<tr>";
        for (const std::string& text : row) body_ += fmt::format("<{0}>{1}</{0}>", cell, escaped(text));
        body_ += "</tr>\n";
        cell = "td";
    }
    body_ += "</table>";
    caption(sentence, command);
}

void Page::headline(const std::string& what, const std::string& value) { headlines_.push_back({what, value}); }

std::string Page::html() const {
    std::string numbers;
    for (const Headline& h : headlines_)
        numbers += fmt::format("<div><b>{}</b>{}</div>\n", escaped(h.value), escaped(h.what));
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width, "
        "initial-scale=1\"><title>{}</title>\n<style>{}</style></head>\n"
        "<body><h1>{}</h1>\n<p>{}</p>\n<div class=\"numbers\">{}</div>\n<ol "
        "class=\"contents\">{}</ol>\n{}</body></html>\n",
        escaped(title_), style, escaped(title_), escaped(introduction_), numbers, contents_, body_);
}

void write_text(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace bandlimit::app
