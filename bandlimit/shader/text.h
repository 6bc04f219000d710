// The comment above a shader, and numbers and polynomials in its code.
// Stability: inner.
#pragma once
#include <string>
#include <string_view>

#include "bandlimit/shader/shader.h"

namespace bandlimit {

/// What the comment says besides what the caller of the shader passed.
struct Header {
    /// What the parameters are.
    enum class Reads { samples, loads, compute, colours, own };  ///< own: the source says so itself

    std::string what, cost;  ///< NAME in `what` becomes the shader's name
    Reads reads = Reads::samples;
};

/// The comment, then `source` translated from the neutral form: ready to paste.
/// throws   Error for a name that is not an identifier
std::string shader_text(const ShaderInfo& info, const Header& header, const std::string& source, Dialect dialect);

/// `text` with every `word` in it replaced by `value`.
std::string with(std::string text, std::string_view word, std::string_view value);

/// In neutral form: a polynomial of x, in Horner's form.
std::string polynomial(const KernelPiece& piece);

/// In neutral form: NAME_weight(distance), the piece under the distance; 0 beyond them.
std::string weight_function(const KernelPieces& pieces);

/// `value` as all dialects read it, with enough digits for a float: "0.125", "1.0", "-2.5e-05".
std::string number(double value, int digits = 9);

}  // namespace bandlimit
