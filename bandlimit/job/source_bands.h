// Bands of rows of an image file, on their way through a pipeline.
// Stability: inner.
#pragma once
#include <vector>

#include "bandlimit/io/image_file.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit::job {

/// The rows of a file that one band after another needs; what neighbours share is read once. One band can be loaded
/// while the one before is in use. Where a band needs all rows, as under Edge::wrap, all bands share one copy of them.
class SourceBands {
public:
    /// No band has more than `capacity` rows.
    SourceBands(ImageReader& reader, int capacity);

    /// Bytes that they take.
    static std::uint64_t bytes(const ImageInfo& info, int capacity);

    /// Makes band i hold rows [range), after i - 1 and while that may be in use. Neither end falls from band to band.
    void load(int i, IndexRange range);
    SourceRows rows(int i, const Encoding& encoding);

private:
    struct Band {
        AnyImage image;
        IndexRange rows{0, 0};
    };
    Band& of(int i) { return bands_[static_cast<std::size_t>(i) % bands_.size()]; }
    void read(Band& band, IndexRange range, int kept);

    ImageReader& reader_;
    bool is_whole_;
    std::vector<Band> bands_;
};

}  // namespace bandlimit::job
