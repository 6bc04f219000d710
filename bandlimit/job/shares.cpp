#include "bandlimit/job/shares.h"

namespace bandlimit::job {

Shares shares_of(Parallel parallel) {
    // A codec that works in parallel keeps its stage's thread busy too; below three OpenImageIO does not try.
    const int threads = parallel.count(), quarter = threads / 4;
    const int codecs = quarter >= 3 ? quarter : 1;
    return {parallel.with_threads(codecs), parallel.with_threads(threads - codecs + 1)};
}

}  // namespace bandlimit::job
