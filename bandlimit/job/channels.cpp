#include "bandlimit/job/channels.h"

namespace bandlimit::job {

std::vector<std::string> channel_names(int channels) {
    switch (channels) {
        case 1: return {"Y"};
        case 2: return {"Y", "A"};
        case 3: return {"R", "G", "B"};
        default: return {"R", "G", "B", "A"};
    }
}

Image<float> channels_copied(View<const float> all, int first, int count) {
    Image<float> copy(all.width, all.height, count, Layout::interleaved);
    for (int y = 0; y < all.height; ++y)
        for (int x = 0; x < all.width; ++x)
            for (int c = 0; c < count; ++c) copy.view()(x, y, c) = all(x, y, first + c);
    return copy;
}

}  // namespace bandlimit::job
