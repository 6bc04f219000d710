// Picture jobs as a library user calls them.
#include <cmath>

#include "bandlimit/io/files_test.h"
#include "bandlimit/job/bokeh.h"
#include "bandlimit/job/compare.h"
#include "bandlimit/job/convolve.h"
#include "bandlimit/job/option_error.h"
#include "bandlimit/job/pattern.h"
#include "bandlimit/job/pictures.h"
#include "bandlimit/job/resize.h"
#include "bandlimit/job/weights.h"

namespace bandlimit::job {
namespace {

/// A chirp in a file of the folder; no frequency is above what half the size holds.
std::string draw(const Folder& folder, const std::string& name, int width, int height) {
    PatternJob job;
    job.signal = named_signal("chirp");
    set(job.signal, "to", {0.1});
    job.size = {width, height};
    job.out = folder / name;
    pattern(job);
    return job.out;
}

/// A context that asks to stop at the first report.
struct Impatient {
    std::stop_source source;
    int reports = 0;

    Context context() {
        Context context;
        context.parallel.stop = source.get_token();
        context.progress = [this](const Progress&) {
            ++reports;
            source.request_stop();
        };
        return context;
    }
};

TEST(ResizeJob, ResizesAndReports) {
    const Folder folder;
    ResizeJob job;
    job.files = {draw(folder, "in.png", 64, 32), folder / "out.png"};
    job.scale = 0.5;
    double last = 0;
    Context context;
    context.progress = [&](const Progress& p) {
        EXPECT_EQ(p.doing, "resizing");
        EXPECT_EQ(p.total, 16);
        last = p.done;
    };
    const ResizeReport report = resize(job, context);
    EXPECT_EQ(report.output.width, 32);
    EXPECT_EQ(report.output.height, 16);
    EXPECT_EQ(report.kernel_x, "shrink3");
    EXPECT_EQ(last, 16);
    const Image<float> expected = resample(read_picture(job.files.in).view(), 32, 16);
    EXPECT_LT(max_abs(read_picture(job.files.out).view(), expected.view()), 0.01);
}

TEST(ResizeJob, OneSideFollowsFromTheOther) {
    const Folder folder;
    ResizeJob job;
    job.files = {draw(folder, "in.png", 64, 32), folder / "out.png"};
    job.region = Region{0, 0, 32, 32};
    job.width = 20;
    EXPECT_EQ(resize(job).output.height, 20);
}

TEST(ResizeJob, RefusesSizesThatAreNone) {
    const Folder folder;
    ResizeJob job;
    job.files = {draw(folder, "in.png", 64, 32), folder / "out.png"};
    EXPECT_THROW(resize(job), OptionError);
    job.scale = 0.5, job.width = 3;
    EXPECT_THROW(resize(job), OptionError);
    job.width = 0, job.scale = 1e9;
    EXPECT_THROW(resize(job), OptionError);
    job.scale = 1, job.region = Region{60, 0, 5, 5};
    EXPECT_THROW(resize(job), std::runtime_error);
    EXPECT_EQ(folder.count(), 1);
}

TEST(PictureJobs, LeaveNothingWhenStopped) {
    const Folder folder;
    const std::string in = draw(folder, "in.png", 64, 2048);
    ResizeJob smaller;
    smaller.files = {in, folder / "out.png"};
    smaller.scale = 0.9;
    BokehJob blur;
    blur.files = smaller.files;
    blur.radius = 2;
    PatternJob drawn;
    drawn.signal = named_signal("checker");
    drawn.size = {1 << 15, 512};  // several bands
    drawn.out = folder / "out.png";
    CompareJob differ{.a = in, .b = in, .diff = folder / "out.png"};
    const std::vector<std::function<void(const Context&)>> jobs{
        [&](const Context& context) { resize(smaller, context); },
        [&](const Context& context) { bokeh(blur, context); }, [&](const Context& context) { pattern(drawn, context); },
        [&](const Context& context) { compare(differ, context); }};
    for (const auto& job : jobs) {
        for (const int threads : {1, 4}) {
            Impatient user;
            Context context = user.context();
            context.parallel.threads = threads;
            EXPECT_THROW(job(context), Stopped);
            EXPECT_GE(user.reports, 1);
            EXPECT_EQ(folder.count(), 1);
        }
    }
}

TEST(PictureJobs, NoteWhatIsNotFinite) {
    const Folder folder;
    AnyImage image = make_image(Depth::f32, 8, 8, 1);
    std::get<Image<float>>(image).view()(4, 4) = std::nanf("");
    write_image(folder / "in.exr", target_of(Depth::f32, 8, 8, 1), pixels(image));
    ResizeJob job;
    job.files = {folder / "in.exr", folder / "out.png"};
    job.scale = 1;
    std::vector<std::string> notes;
    Context context;
    context.note = [&](std::string_view text) { notes.emplace_back(text); };
    EXPECT_TRUE(resize(job, context).lost_non_finite);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("NaN"), std::string::npos) << notes[0];
}

TEST(ConvolveJob, RunsWeightsOfAnImage) {
    const Folder folder;
    AnyImage kernel = make_image(Depth::f32, 3, 1, 2);
    const View<float> k = std::get<Image<float>>(kernel).view();
    for (int x = 0; x < 3; ++x) k(x, 0, 0) = static_cast<float>(x + 1), k(x, 0, 1) = x == 1 ? 0.5f : 1.0f;
    ImageTarget target = target_of(Depth::f32, 3, 1, 2);
    write_image(folder / "kernel.tif", target, pixels(kernel));
    const WeightGrid weights = read_weights(folder / "kernel.tif");
    EXPECT_EQ(weights.weights, (std::vector<double>{1, 1, 3}));  // colour times alpha
    EXPECT_THROW(read_weights(folder / "kernel.tif", Space::data, 2), std::runtime_error);

    ConvolveJob job;
    job.files = {draw(folder, "in.png", 64, 32), folder / "out.png"};
    job.weights = centred(weights);
    const ConvolveReport report = convolve(job);
    EXPECT_EQ(report.size.width, 3);
    EXPECT_EQ(report.sum, 1);
    EXPECT_EQ(report.edge, Edge::renormalize);
    job.options.keeps_sum = true;
    EXPECT_EQ(convolve(job).sum, 5);
}

TEST(ConvolveJob, WeightsThatCancelAreReflectedOrRefused) {
    const Folder folder;
    ConvolveJob job;
    job.files = {draw(folder, "in.png", 64, 32), folder / "out.exr"};
    TapsFile slope;
    slope.taps = Taps{-1, {-1, 0, 1}};
    job.weights = weights_of(slope, "slope", TapsAxis::x);
    EXPECT_THROW(convolve(job), std::runtime_error);
    job.options.keeps_sum = true;
    EXPECT_EQ(convolve(job).edge, Edge::reflect);
}

TEST(Weights, OfTapsFilesThatDoNotFitAreRefused) {
    TapsFile file;
    EXPECT_THROW(weights_of(file, "none"), OptionError);
    file.components = {{1, 1, 1, 0}};
    EXPECT_THROW(weights_of(file, "any radius"), OptionError);
    EXPECT_GT(size_of(weights_of(file, "disk", TapsAxis::both, 3)).width, 3);
    EXPECT_THROW(weights_of(file, "disk", TapsAxis::x, 3), OptionError);
    file.terms = {{{1}, {1}}};
    EXPECT_THROW(weights_of(file, "terms", TapsAxis::both, 3), OptionError);
    file.factor = 2;
    EXPECT_THROW(weights_of(file, "half"), OptionError);
}

TEST(BokehJob, OptionsAreChecked) {
    BokehJob job;
    EXPECT_THROW(check(job), OptionError);
    job.radius = 3;
    check(job);
    job.shape = "circus";
    EXPECT_THROW(check(job), Error);
    job.shape = "star.png";
    check(job);
    job.components = 2;
    EXPECT_THROW(check(job), OptionError);
}

TEST(CompareJob, FindsAShift) {
    const Folder folder;
    PatternJob noise;
    noise.signal = named_signal("noise");
    set(noise.signal, "cutoff", {0.2});
    noise.size = {128, 128};
    noise.out = folder / "a.exr";
    pattern(noise);
    const std::string b = folder / "b.exr", diff = folder / "diff.exr";
    write_picture(b, cropped(read_picture(noise.out).view(), 3, 0, 120, 128), Depth::f32);
    write_picture(noise.out, cropped(read_picture(noise.out).view(), 0, 0, 120, 128), Depth::f32);
    const CompareReport report = compare({.a = noise.out, .b = b, .diff = diff});
    EXPECT_EQ(report.measure, Measure::linear);
    ASSERT_TRUE(report.shift.x && report.shift.y);
    EXPECT_NEAR(*report.shift.x, -3, 0.01);
    EXPECT_NEAR(*report.shift.y, 0, 0.01);
    EXPECT_GT(report.metrics.max_abs, 0);
    EXPECT_EQ(compare({.a = b, .b = b}).metrics.mse, 0);
    EXPECT_NEAR(mean_of(read_codes(diff).view()), mean_of(read_codes(diff, {.threads = 1}).view()), 0);
}

TEST(NamedSignals, HaveParametersOfTheirOwn) {
    NamedSignal one = named_signal("disc"), other = named_signal("disc");
    set(one, "center", {3, 4});
    set(one, "radius", {2});
    EXPECT_EQ(one.make({16, 16}).value(3, 4), 1);
    EXPECT_EQ(one.make({16, 16}).value(8, 8), 0);
    EXPECT_EQ(other.make({16, 16}).value(8, 8), 1);
    EXPECT_THROW(set(one, "center", {3}), Error);
    EXPECT_THROW(set(one, "colour", {3}), Error);
    EXPECT_THROW(named_signal("unicorn"), Error);
    NamedSignal star = named_signal("siemens");
    EXPECT_THROW(set(star, "spokes", {2.5}), Error);
    for (const NamedSignal& signal : named_signals()) EXPECT_FALSE(signal.make({64, 64}).name.empty()) << signal.name;
}

TEST(Pictures, CodesComeBackAsWritten) {
    const Folder folder;
    Image<float> codes(3, 2, 1);
    for (int x = 0; x < 3; ++x) codes.view()(x, 1) = static_cast<float>(x) / 2;
    write_data(folder / "codes.png", codes.view());
    const Image<float> read = read_codes(folder / "codes.png");
    EXPECT_EQ(read.view()(2, 1), 1);
    EXPECT_NEAR(read.view()(1, 1), 0.5f, 0.002f);
    EXPECT_LT(read_picture(folder / "codes.png", Space::srgb).view()(1, 1), 0.3f);
}

}  // namespace
}  // namespace bandlimit::job
