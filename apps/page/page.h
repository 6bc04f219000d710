// A page of figures, tables and the commands that make them.
#pragma once
#include <string>
#include <vector>

namespace bandlimit::app {

/// A document that the page reproduces.
struct Citation {
    std::string author, title, place, year;
};

/// Builds one self-contained HTML page; pictures lie beside it.
class Page {
public:
    explicit Page(std::string title, std::string introduction);

    /// Starts a part: everything until the next one belongs to it. Without an author it names no source.
    void section(const std::string& title, const std::string& text, const Citation& source);
    /// A picture with one sentence and the command that makes it (none if empty). `width` in CSS pixels.
    void figure(const std::string& file, const std::string& sentence, const std::string& command, int width);
    /// Pictures side by side, each with a line below it.
    struct Tile {
        std::string file, caption;
    };
    void gallery(const std::vector<Tile>& tiles, const std::string& sentence, const std::string& command, int width);
    /// The first row is the head.
    void table(const std::vector<std::vector<std::string>>& rows, const std::string& sentence,
               const std::string& command);
    /// A number worth repeating at the top of the page and at the end of the program's output.
    void headline(const std::string& what, const std::string& value);

    struct Headline {
        std::string what, value;
    };
    const std::vector<Headline>& headlines() const { return headlines_; }

    /// The whole document.
    std::string html() const;

private:
    void caption(const std::string& sentence, const std::string& command);

    std::string title_, introduction_, body_, contents_;
    std::vector<Headline> headlines_;
    int sections_ = 0;
};

/// A file of text, which appears whole or not at all. Throws std::runtime_error.
void write_text(const std::string& path, const std::string& text);

}  // namespace bandlimit::app
