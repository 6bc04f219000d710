// What the tests of this room share: a folder of their own, and pictures of any depth.
#pragma once
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

#include "bandlimit/core/image.h"
#include "bandlimit/io/image_file.h"
#include "bandlimit/math/random.h"

namespace bandlimit {

/// An empty folder that goes with the object.
class Folder {
public:
    Folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "bandlimit-test-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = pattern;
    }
    ~Folder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    /// How many files are in it.
    std::ptrdiff_t count() const {
        return std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator());
    }

private:
    std::filesystem::path path_;
};

inline void write_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}
inline std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline AnyConstView pixels(AnyImage& image) { return const_view(view_of(image)); }

/// Any code, or any multiple of 1/64 below 4: exact as half.
inline void set(std::uint8_t& to, Random& random) { to = static_cast<std::uint8_t>(random.integer(0, 255)); }
inline void set(std::uint16_t& to, Random& random) { to = static_cast<std::uint16_t>(random.integer(0, 65535)); }
inline void set(float& to, Random& random) { to = static_cast<float>(random.integer(0, 255)) / 64; }
inline void set(Half& to, Random& random) { to = to_half(static_cast<float>(random.integer(0, 255)) / 64); }

inline AnyImage noise(Depth depth, int width, int height, int channels, Layout layout = Layout::interleaved) {
    AnyImage image = make_image(depth, width, height, channels, layout);
    Random random(static_cast<std::uint64_t>(width * 1000 + height * 10 + channels));
    std::visit(
        [&](const auto& v) {
            for (int y = 0; y < v.height; ++y)
                for (int x = 0; x < v.width; ++x)
                    for (int c = 0; c < v.channels; ++c) set(v(x, y, c), random);
        },
        view_of(image));
    return image;
}

/// Whether both hold the same samples; says where not.
[[nodiscard]] inline ::testing::AssertionResult equal(const AnyConstView& a, const AnyConstView& b) {
    if (a.index() != b.index()) return ::testing::AssertionFailure() << "different depths";
    return std::visit(
        [&](const auto& left) -> ::testing::AssertionResult {
            const auto& right = std::get<std::decay_t<decltype(left)>>(b);
            if (!same_shape(left, right)) return ::testing::AssertionFailure() << "different shapes";
            for (int y = 0; y < left.height; ++y)
                for (int x = 0; x < left.width; ++x)
                    for (int c = 0; c < left.channels; ++c)
                        if (!(left(x, y, c) == right(x, y, c)))
                            return ::testing::AssertionFailure() << "at x " << x << ", y " << y << ", channel " << c;
            return ::testing::AssertionSuccess();
        },
        a);
}

inline std::vector<std::string> names_of(int channels) {
    std::vector<std::string> names =
        channels < 3 ? std::vector<std::string>{"Y", "A"} : std::vector<std::string>{"R", "G", "B", "A"};
    for (int c = 4; c < channels; ++c) names.push_back("extra" + std::to_string(c));
    names.resize(static_cast<std::size_t>(channels));
    return names;
}

/// What a picture of so many channels is when the last of an even number is alpha.
inline ImageTarget target_of(Depth depth, int width, int height, int channels) {
    ImageTarget target;
    target.width = width, target.height = height, target.depth = depth;
    target.channel_names = names_of(channels);
    target.alpha = channels == 2 ? 1 : channels >= 4 ? 3 : -1;
    return target;
}

inline void write_image(const std::string& path, const ImageTarget& target, const AnyConstView& view) {
    ImageWriter writer(path, target, 1);
    writer.write_rows(view);
    writer.finish();
}

inline AnyImage read_image(ImageReader& reader, Layout layout = Layout::interleaved) {
    const ImageInfo& info = reader.info();
    AnyImage image = make_image(info.depth, info.width, info.height, info.channels(), layout);
    reader.read_rows(0, view_of(image));
    return image;
}
inline AnyImage read_image(const std::string& path) {
    ImageReader reader(path, 1);
    return read_image(reader);
}

/// Whether `work` throws std::runtime_error that begins with `path` and ": ", is one line, and says what to do.
template <class Work>
[[nodiscard]] ::testing::AssertionResult fails_for(const std::string& path, Work work, const std::string& word = "") {
    try {
        work();
    } catch (const std::runtime_error& e) {
        const std::string what = e.what();
        if (!what.starts_with(path + ": "))
            return ::testing::AssertionFailure() << "does not begin with the path: " << what;
        if (what.find('\n') != what.npos) return ::testing::AssertionFailure() << "more than one line: " << what;
        if (what.find("; ") == what.npos) return ::testing::AssertionFailure() << "no advice: " << what;
        if (what.find(word) == what.npos) return ::testing::AssertionFailure() << "no \"" << word << "\": " << what;
        return ::testing::AssertionSuccess();
    } catch (const std::exception& e) {
        return ::testing::AssertionFailure() << "another kind of error: " << e.what();
    }
    return ::testing::AssertionFailure() << "no error";
}

}  // namespace bandlimit
