// Emitted functions, how they are called, and what they must return.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bandlimit/shader/dialect.h"
#include "bandlimit/shader/picture_test.h"

namespace bandlimit::test {

/// How far positions are off, in texels.
struct Precision {
    double fraction = 0;    ///< by the bits that a sampler keeps of a fraction
    double coordinate = 0;  ///< by rounding of coordinates to float
};

struct Expected {
    Colour value{};
    double bound = 0;  ///< how far a right answer may be from it
};

/// What an exact sampler with this edge would read at (x, y), in texels of the source.
struct Place {
    const Picture& source;
    const Picture& other;
    Edge edge;
    double x, y;
    Precision precision;
};

/// A call of an emitted function.
struct Case {
    std::string name;
    std::string call;  ///< neutral; @ is ", source_sampler" where samplers are apart
    std::function<Expected(const Place&)> expected;
    bool at_all_edges = false;  ///< one that stands for others, which read in the same way
};

/// The functions that all cases call, one text after the other as somebody would paste them.
std::string functions_of_all_cases(Dialect dialect);

/// Plain bilinear reads, which show what the sampler does, come first.
const std::vector<Case>& all_cases();

}  // namespace bandlimit::test
