// The comment above a shader, and numbers in its code.
// Stability: inner.
#pragma once
#include <string>

#include "bandlimit/shader/shader.h"

namespace bandlimit {

/// What the comment says besides what the caller of the shader passed.
struct Header {
    /// What the parameters are.
    enum class Reads { samples, loads, compute, colours };

    std::string what, cost;  ///< NAME in `what` becomes the shader's name
    Reads reads = Reads::samples;
};

/// The comment, then `source` translated from the neutral form: ready to paste.
/// throws   Error for a name that is not an identifier
std::string shader_text(const ShaderInfo& info, const Header& header, const std::string& source, Dialect dialect);

/// `value` as all dialects read it, with enough digits for a float: "0.125", "1.0", "-2.5e-05".
std::string number(double value, int digits = 9);

}  // namespace bandlimit
