// What accumulation over time remembers, as bytes: to stop, and to go on later with the same results.
//
//     store(history, [&](const void* data, std::size_t size) { file.write(data, size); });
//     TemporalHistory again(history.width(), history.height());
//     restore(again, [&](void* data, std::size_t size) { file.read(data, size); });
//
// Bytes are those of this machine and this version: they are kept for a while, not handed on.
// Stability: evolving.
#pragma once
#include <cstddef>
#include <functional>

#include "bandlimit/antialias/temporal.h"
#include "bandlimit/antialias/temporal_measures.h"

namespace bandlimit {

using WriteBytes = std::function<void(const void* data, std::size_t size)>;
/// Fills all of `data`, or throws.
using ReadBytes = std::function<void(void* data, std::size_t size)>;

void store(const TemporalHistory& history, const WriteBytes& write);
void store(const TemporalMeter& meter, const WriteBytes& write);

/// Into a value of the same size.
/// range    any bytes: those that no store() wrote leave a value that is safe to use or to drop, but not as it was
/// memory   what the value takes
/// throws   Error for bytes that no store() of a value of this size wrote, and what `read` throws
void restore(TemporalHistory& history, const ReadBytes& read);
void restore(TemporalMeter& meter, const ReadBytes& read);

}  // namespace bandlimit
