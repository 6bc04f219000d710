// Images that pass through the program in bands: the same pixels for any bands, tiles and threads, in little memory,
// and nothing left behind when a stage fails or somebody interrupts.
#include <sys/mman.h>

#include <array>

#include "apps/run_program_test.h"
#include "bandlimit/resample/resize.h"

namespace bandlimit {
namespace {

using nlohmann::json;

json report(const Shell& shell, const std::string& line, const Circumstances& c = {}) {
    const Outcome run = shell(line + " --json", c);
    EXPECT_TRUE(succeeds(run)) << line;
    return json::parse(run.out, nullptr, false);
}

/// The most memory that a process had resident so far, in bytes; 0 where the system does not say.
std::size_t peak_memory(pid_t process) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    std::size_t kibibytes = 0;
    for (std::string key; status >> key;)
        if (key == "VmHWM:" && status >> kibibytes) break;
    return kibibytes * 1024;
}

/// Keeps the peak of whatever runs.
Circumstances watching(std::size_t& peak) {
    return {.meanwhile = [&peak](pid_t process) {
        peak = std::max(peak, peak_memory(process));
        return false;
    }};
}

TEST(Stream, BandsTilesAndThreadsDoNotChangeAPixel) {
    // Eight bands of the output, whose rows neither those of the tiles nor those of the blocks of codecs divide.
    const Shell shell(BANDLIMIT_PROGRAM);
    constexpr int width = 61, height = 1234, out_width = 47, out_height = 777;
    AnyImage image = noise(Depth::u8, width, height, 4);
    ImageTarget target = target_of(Depth::u8, width, height, 4);
    write_image(shell / "rows.tif", target, pixels(image));
    target.tile = 48;
    write_image(shell / "tiles.tif", target, pixels(image));
    save(shell / "in.png", image);

    AnyImage expected = make_image(Depth::u8, out_width, out_height, 4);
    const Encoding encoding{Transfer::srgb, 3, false};
    const Grid src{{width, 0, width}, {height, 0, height}}, dst{{out_width, 0, width}, {out_height, 0, height}};
    Resizer(src, dst, 4).run({pixels(image), 0, encoding}, {view_of(expected), 0, encoding, {}});
    for (const std::string in : {"rows.tif", "tiles.tif", "in.png"})
        for (const std::string out : {"out.tif --tiles 16", "out.png"})
            for (const std::string threads : {"1", "2", "16"}) {
                SCOPED_TRACE(in + " to " + out + " by " + threads);
                ASSERT_TRUE(succeeds(shell("resize " + in + " --size 47x777 --threads " + threads + " " + out)));
                AnyImage resized = read_image(shell / out.substr(0, 7));
                EXPECT_TRUE(equal(pixels(expected), pixels(resized)));
            }
}

TEST(Stream, ImagesLargerThanTheMemoryTheyGet) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const int width = 4096, height = is_sanitized ? 1024 : 12288;  // 400 MB of four 16-bit channels
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    constexpr std::size_t limit = 300'000'000;
    std::size_t peak = 0;
    const json made = report(shell,
                             "pattern stripes big.tif --size " + size +
                                 " --period 37.3 --angle 10 --channels 4 --depth u16 --tiles 256 --threads 2",
                             watching(peak));
    EXPECT_EQ(made["channels"], 4);
    const json halved = report(shell, "resize big.tif half.tif --scale 0.5 --tiles 128 --threads 2", watching(peak));
    EXPECT_EQ(halved["output"]["width"], width / 2);
    EXPECT_EQ(halved["output"]["height"], height / 2);
    const json compared = report(shell, "compare half.tif half.tif --threads 2", watching(peak));
    EXPECT_EQ(compared["psnr"], "inf");
    EXPECT_EQ(compared["ssim"], 1);
    if (is_sanitized) return;  // which need memory of their own
    EXPECT_GT(peak, 0u);
    EXPECT_LT(peak, limit);
}

/// Zeros that take memory only where they are written.
class SparseBytes {
public:
    explicit SparseBytes(std::size_t size)
        : size_(size),
          data_(::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)) {}
    ~SparseBytes() { ::munmap(data_, size_); }
    SparseBytes(const SparseBytes&) = delete;
    SparseBytes& operator=(const SparseBytes&) = delete;
    std::uint8_t* data() const { return data_ == MAP_FAILED ? nullptr : static_cast<std::uint8_t*>(data_); }

private:
    std::size_t size_;
    void* data_;
};

TEST(Stream, MoreThanTwoBillionSamples) {
    // 2.8e9 samples; what is seen of the last of them is seen of the same corner alone.
    constexpr int width = 70000, height = 40000, corner_width = 220, corner_height = 160;
    const SparseBytes bytes(std::size_t{width} * height);
    ASSERT_NE(bytes.data(), nullptr);
    const View<std::uint8_t> image{bytes.data(), width, height, 1, 1, width, 0};
    const View<std::uint8_t> corner =
        cropped(image, width - corner_width, height - corner_height, corner_width, corner_height);
    Random random(1);
    for (int y = 0; y < corner_height; ++y)
        for (int x = 0; x < corner_width; ++x) set(corner(x, y), random);
    EXPECT_EQ(&image(width - 1, height - 1) - bytes.data(), std::ptrdiff_t{width} * height - 1);
    EXPECT_EQ(&flipped_y(flipped_x(image))(0, 0), &image(width - 1, height - 1));
    EXPECT_EQ(&transposed(image)(height - 1, width - 1), &image(width - 1, height - 1));

    // The half of the corner that is far enough from its inner edges, at half its size.
    constexpr int w = corner_width / 4, h = corner_height / 4;
    const auto halved = [&](View<const std::uint8_t> v) {
        Image<std::uint8_t> out(w, h);
        const Grid src{{v.width, 0, double(v.width)}, {v.height, 0, double(v.height)}};
        const Grid dst{{w, double(v.width - 2 * w), double(v.width)}, {h, double(v.height - 2 * h), double(v.height)}};
        const Resizer resizer(src, dst, 1);
        const IndexRange rows = resizer.rows_needed(0, h);
        EXPECT_EQ(rows.end, v.height);
        resizer.run({cropped(v, 0, rows.begin, v.width, rows.end - rows.begin), rows.begin, {}},
                    {out.view(), 0, {}, {}}, {1});
        return out;
    };
    const Image<std::uint8_t> far = halved(image), near = halved(corner);
    EXPECT_TRUE(equal(far.view(), near.view()));
}

TEST(Stream, CompareMeasuresTheSameForAnyBlocks) {
    // A file is compared by blocks of 16 rows; tiles and an odd height cut them otherwise. The library sees all at
    // once.
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage a = noise(Depth::u8, 70, 101, 3), b = noise(Depth::u8, 70, 101, 3);
    const View<std::uint8_t> v = std::get<View<std::uint8_t>>(view_of(b));
    for (const auto& [x, y] : {std::pair{3, 40}, {69, 100}}) v(x, y, 1) = static_cast<std::uint8_t>(v(x, y, 1) ^ 0x40);
    ImageTarget target = target_of(Depth::u8, 70, 101, 3);
    target.tile = 16;
    write_image(shell / "a.tif", target, pixels(a));
    save(shell / "a.png", a);
    save(shell / "b.png", b);
    const json whole = report(shell, "compare a.png b.png --threads 1");
    EXPECT_GT(whole["mse"].get<double>(), 0);
    for (const std::string threads : {"1", "2", "5"})
        EXPECT_EQ(report(shell, "compare a.tif b.png --threads " + threads), whole) << threads;
}

TEST(Stream, SecondsOfTheStagesAndOfAll) {
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("pattern stripes in.tif --size 700x900 --angle 10 --tiles 64")));
    for (const std::string threads : {"1", "3"}) {
        const Outcome run = shell("resize in.tif out.png --scale 0.7 --json --threads " + threads);
        ASSERT_TRUE(succeeds(run));
        const json seconds = run.json()["seconds"];
        const double total = seconds["total"];
        double sum = 0;
        for (const char* stage : {"read", "filter", "write"}) {
            EXPECT_LE(seconds[stage].get<double>(), total) << stage;
            sum += seconds[stage].get<double>();
        }
        EXPECT_LT(total, run.seconds);
        if (threads == "1") {
            EXPECT_LE(sum, total) << "nothing overlaps";
        }
    }
}

TEST(Stream, TilesThatAFormatHasNotAreExitCode2) {
    const Shell shell(BANDLIMIT_PROGRAM);
    ASSERT_TRUE(succeeds(shell("pattern box in.tif --size 20x20 --tiles 16 --channels 2")));
    EXPECT_EQ(report(shell, "info in.tif")["channels"], 2);
    for (const std::string line :
         {"resize in.tif no.png --scale 1 --tiles 16", "resize in.tif no.tif --scale 1 --tiles 17",
          "resize in.tif no.tif --scale 1 --tiles 0", "resize in.tif no.exr --scale 1 --tiles -16",
          "resize in.tif no.exr --scale 1 --tiles 8192", "pattern box no.pfm --size 8x8 --tiles 16",
          "pattern box no.png --size 8x8 --channels 5", "pattern box no.webp --size 8x8 --channels 1",
          "pattern box no.jpg --size 8x8 --channels 4"}) {
        EXPECT_TRUE(fails(2, shell(line))) << line;
    }
    EXPECT_EQ(shell.files(), std::set<std::string>{"in.tif"});
}

TEST(Stream, AFailureOfAnyStageLeavesWhatWasThere) {
    const Shell shell(BANDLIMIT_PROGRAM);
    AnyImage image = noise(Depth::u8, 300, 1500, 4);
    ImageTarget target = target_of(Depth::u8, 300, 1500, 4);
    target.tile = 64;
    write_image(shell / "in.tif", target, pixels(image));
    save(shell / "in.png", image);
    write_bytes(shell / "cut.png", bytes_of(shell / "in.png").substr(0, 1 << 20));
    // The directory of a TIFF lies behind its pixels, so that a hole in the middle shows as late as a cut elsewhere.
    std::string holed = bytes_of(shell / "in.tif");
    std::fill_n(holed.begin() + static_cast<std::ptrdiff_t>(holed.size() / 2), 100'000, '\0');
    write_bytes(shell / "cut.tif", holed);
    write_bytes(shell / "out.tif", "as it was");
    const std::set<std::string> before = shell.files();
    const Circumstances full{.limits = {{RLIMIT_FSIZE, 300'000}}};
    for (const std::string threads : {"1", "2", "4"}) {
        const std::string options = " out.tif --scale 0.9 --tiles 32 --threads " + threads;
        EXPECT_TRUE(fails(1, shell("resize cut.png" + options), "cut.png"));
        EXPECT_TRUE(fails(1, shell("resize cut.tif" + options), "cut.tif"));
        EXPECT_TRUE(fails(1, shell("resize in.png" + options, full), "out.tif"));
        EXPECT_TRUE(fails(1, shell("pattern noise out.tif --size 900x900 --tiles 32 --threads " + threads, full)));
    }
    EXPECT_EQ(shell.files(), before);
    EXPECT_EQ(bytes_of(shell / "out.tif"), "as it was");
}

TEST(Stream, AnInterruptionLeavesNothing) {
    for (const std::string out : {"out.tif", "out.png"})
        for (const std::string threads : {"1", "2"}) {
            const Shell shell(BANDLIMIT_PROGRAM);
            AnyImage image = noise(Depth::u8, 500, 500, 4);
            save(shell / "in.png", image);
            write_bytes(shell / out, "as it was");
            // Minutes of work. The unfinished file has grown: bands are under way in all stages.
            bool was_seen = false;
            const auto interrupt = [&](pid_t process) {
                for (const std::string& name : shell.files())
                    was_seen = was_seen || (name.starts_with(".bandlimit-") &&
                                            std::filesystem::file_size(shell / name) > 1'000'000);
                return was_seen && ::kill(process, SIGINT) == 0;
            };
            const Outcome run = shell("resize in.png " + out + " --size 20000x20000 --threads " + threads +
                                          (out == "out.tif" ? " --tiles 256" : ""),
                                      {.meanwhile = interrupt});
            EXPECT_TRUE(was_seen) << run;
            EXPECT_EQ(run.signal, SIGINT) << run;
            EXPECT_LT(run.seconds, 60);
            EXPECT_EQ(shell.files(), (std::set<std::string>{"in.png", out}));
            EXPECT_EQ(bytes_of(shell / out), "as it was");
        }
}

}  // namespace
}  // namespace bandlimit
