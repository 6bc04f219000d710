// Resizers whose properties are known, right ones and wrong ones, for tests of what an audit finds.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "bandlimit/analysis/audit.h"
#include "bandlimit/analysis/recognise.h"
#include "bandlimit/resample/apply.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {

/// Stored values as a program with codes of 8 bits writes them.
inline float nearest_byte(float v) { return std::round(std::clamp(v, 0.0f, 1.0f) * 255) / 255; }
inline float truncated_byte(float v) { return std::floor(std::clamp(v, 0.0f, 1.0f) * 255 + 1e-4f) / 255; }

template <class F>
void for_samples(View<float> v, F f) {
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x)
            for (int c = 0; c < v.channels; ++c) v(x, y, c) = f(v(x, y, c));
}

inline Image<float> copy_of(View<const float> v) {
    Image<float> out(v.width, v.height, v.channels);
    for (int y = 0; y < v.height; ++y)
        for (int x = 0; x < v.width; ++x)
            for (int c = 0; c < v.channels; ++c) out.view()(x, y, c) = v(x, y, c);
    return out;
}

/// bandlimit's own resize.
struct OwnResize {
    ResizeOptions options = {};
    Transfer transfer = Transfer::linear;
    Placement placement = {};
    bool bytes = false;

    Image<float> operator()(View<const float> stored, int width, int height) const {
        const Image<float> in = copy_of(stored);
        Image<float> out(width, height, stored.channels);
        const Grid src{{stored.width, 0, double(stored.width)}, {stored.height, 0, double(stored.height)}};
        const Grid dst{target_axis(placement, stored.width, width), target_axis(placement, stored.height, height)};
        const Encoding encoding{transfer, stored.channels == 4 ? 3 : -1};
        Resizer(src, dst, stored.channels, options).run({in.view(), 0, encoding}, {out.view(), 0, encoding, {}});
        if (bytes) for_samples(out.view(), nearest_byte);
        return out;
    }
};

/// Two passes along the axes, by banks that may be wrong: the x axis reads `along_x`, the y axis `along_y`.
struct BankResize {
    using MakeBank = std::function<Bank(int inputs, int outputs)>;
    MakeBank along_x, along_y;
    std::function<float(float)> store = nearest_byte;

    Image<float> operator()(View<const float> stored, int width, int height) const {
        const Image<float> in = copy_of(stored);
        Image<float> rows(width, stored.height, stored.channels), out(width, height, stored.channels);
        apply(along_x(stored.width, width), in.view(), rows.view());
        apply(along_y(stored.height, height), transposed(rows.view()), transposed(out.view()));
        for_samples(out.view(), store);
        return out;
    }
};

inline BankResize by_bank(const BankResize::MakeBank& make, const std::function<float(float)>& store = nearest_byte) {
    return {make, make, store};
}

/// A bank whose kernel is read from a table of so many phases per source sample.
inline Bank table_bank(const Kernel& kernel, int phases, bool nearest, int inputs, int outputs) {
    Bank bank;
    bank.inputs = inputs;
    const Axis source{inputs, 0, double(inputs)}, target{outputs, 0, double(inputs)};
    const double stretch = std::max(1.0, target.pitch());
    for (int i = 0; i < outputs; ++i) {
        const double place = source.index(target.position(i)) * phases;
        const double rounded = (nearest ? std::round(place) : std::floor(place)) / phases;
        const int first = static_cast<int>(std::ceil(rounded - kernel.radius * stretch));
        const int last = static_cast<int>(std::floor(rounded + kernel.radius * stretch));
        double sum = 0;
        for (int j = first; j <= last; ++j) sum += kernel.value((j - rounded) / stretch);
        bank.rows.push_back({bank.weights.size(), last - first + 1, 0, 1});
        for (int j = first; j <= last; ++j)
            bank.weights.push_back(static_cast<float>(kernel.value((j - rounded) / stretch) / sum));
        bank.outputs.push_back({first, i});
    }
    return bank;
}

}  // namespace bandlimit
