// What was measured, as one Markdown table.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/cases.h"
#include "bench/timing.h"

namespace bandlimit::bench {

struct Cell {
    std::string case_name;
    int threads = 1;
    bool other = false;  ///< another operation in the place of the case's
    std::vector<Sample> samples;
};

struct Row {
    std::string name, note;
    std::vector<Cell> cells;
};

struct Table {
    std::vector<Case> cases;
    Row copies;
    std::vector<Row> rows;
};

/// Rows are programs, columns are cases; a cell holds milliseconds and, in brackets, ratios to the floor, each for the
/// given numbers of threads.
void write(std::ostream& out, const Table& table, const std::vector<int>& threads, const Clock& clock);

/// What the marks mean, what the programs compute, and the state of the machine.
void write_notes(std::ostream& out, const Table& table, const std::vector<int>& threads, const Clock& clock);

}  // namespace bandlimit::bench
