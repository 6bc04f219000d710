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

}  // namespace bandlimit::job
