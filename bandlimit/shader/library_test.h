// Emitted C++ and Metal, compiled by a C++ compiler and loaded.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/shader/compilers_test.h"
#include "bandlimit/shader/picture_test.h"

namespace bandlimit::test {

/// Calls of emitted functions in a shared library.
class Library {
public:
    /// Compiles `functions`, and `calls`, expressions of `source` and `other`, or texture(0), texture(1), ..., and of
    /// `uv` and `texel`, that return a float4.
    /// Metal is compiled as C++17 with a header of ours in place of Metal's: its syntax is checked, its semantics are
    /// not.
    ///
    /// throws   std::runtime_error with what the compiler says, warnings too
    Library(Dialect dialect, const std::string& functions, const std::vector<std::string>& calls);

    /// The value of a call at (u, v), of which `texel` is 1 / the size of the first texture.
    Colour operator()(int call, const std::vector<const Picture*>& textures, Edge edge, int bits, float u,
                      float v) const;

    /// The value of a call at (u, v), where textures are read by a sampler with `bits` of fraction.
    Colour operator()(int call, const Picture& source, const Picture& other, Edge edge, int bits, float u,
                      float v) const;

private:
    Folder folder_;
    void (*evaluate_)(int, const void* const*, float, float, float, float, float*);
};

}  // namespace bandlimit::test
