// A place in the plane.
// Stability: stable.
#pragma once

namespace bandlimit {

/// Where something lies, or how far and in which direction from somewhere. y points down.
struct Point {
    double x = 0, y = 0;
};

}  // namespace bandlimit
