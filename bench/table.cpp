#include "bench/table.h"

#include <cstdio>
#include <ostream>

namespace bandlimit::bench {
namespace {

/// Three digits, or all before the point.
std::string digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value);
    return text;
}

const Cell* find(const Row& row, const std::string& case_name, int threads) {
    for (const Cell& cell : row.cells)
        if (cell.case_name == case_name && cell.threads == threads) return &cell;
    return nullptr;
}

struct Texts {
    std::string milliseconds, ratio;
};

Texts texts_of(const Cell& cell, const Clock& clock) {
    const Timing timing = clock.summary(cell.samples, cell.threads);
    std::string marks;
    if (timing.busy) marks += "~";
    if (cell.samples.size() < 9) marks += "†";
    return {digits(1e3 * timing.seconds) + marks, digits(timing.ratio)};
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : " / ") + part;
    return text;
}

void write_row(std::ostream& out, const Row& row, const Table& table, const std::vector<int>& threads,
               const Clock& clock) {
    out << "| " << row.name << " |";
    for (const Case& c : table.cases) {
        std::vector<std::string> times, ratios;
        bool other = false;
        for (const int t : threads)
            if (const Cell* cell = find(row, c.name, t)) {
                const Texts texts = texts_of(*cell, clock);
                times.push_back(texts.milliseconds), ratios.push_back(texts.ratio);
                other = cell->other;
            }
        const char* mark = other ? "*" : "";
        if (!times.empty()) out << " " << mark << joined(times) << " (" << joined(ratios) << ")" << mark;
        out << " |";
    }
    out << "\n";
}

/// The floor of a case: the median of all that were measured beside its timings.
double floor_milliseconds(const Table& table, const std::string& case_name, int threads, const Clock& clock) {
    std::vector<double> floors;
    for (const Row& row : table.rows)
        if (const Cell* cell = find(row, case_name, threads))
            floors.push_back(1e3 * clock.summary(cell->samples, threads).floor);
    return median(floors);
}

void write_floors(std::ostream& out, const Table& table, const std::vector<int>& threads, const Clock& clock) {
    out << "| floor: read the source, write the target |";
    for (const Case& c : table.cases) {
        std::vector<std::string> times;
        for (const int t : threads) times.push_back(digits(floor_milliseconds(table, c.name, t, clock)));
        out << " " << joined(times) << " |";
    }
    out << "\n";
}

}  // namespace

void write(std::ostream& out, const Table& table, const std::vector<int>& threads, const Clock& clock) {
    out << "| program |";
    for (const Case& c : table.cases) out << " " << c.title << " |";
    out << "\n|---|";
    for (std::size_t i = 0; i < table.cases.size(); ++i) out << "---|";
    out << "\n";
    write_floors(out, table, threads, clock);
    write_row(out, table.copies, table, threads, clock);
    for (const Row& row : table.rows) write_row(out, row, table, threads, clock);
}

void write_notes(std::ostream& out, const Table& table, const std::vector<int>& threads, const Clock& clock) {
    std::vector<std::string> counts;
    for (const int t : threads) counts.push_back(std::to_string(t));
    out << "Median milliseconds with " << joined(counts)
        << " threads, in brackets the ratio to the floor of the same moment. Empty: the program has no such operation. "
           "*Italic*: another operation in its place, see below. ~: taken while the machine was busy. †: fewer than 9 "
           "samples, because one takes seconds.\n\n";
    for (const Row& row : table.rows)
        if (!row.note.empty()) out << "- " << row.name << ": " << row.note << ".\n";
    out << "\nBest probe, ns per multiply-add of a vector:";
    for (const int t : threads)
        out << " " << digits(clock.best_probe(t)) << " with " << t << " threads" << (t == threads.back() ? ".\n" : ",");
}

}  // namespace bandlimit::bench
