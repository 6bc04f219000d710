// bandlimit tour: a page that reproduces what its sources show, with this library.
#include <fmt/core.h>

#include "apps/console/common.h"
#include "apps/tour/embedded.h"
#include "apps/tour/tour.h"
#include "bandlimit/io/atomic_file.h"

namespace bandlimit::app {
namespace {

struct Options {
    std::string directory;
    Parallel parallel;
};

/// The parent must exist; the directory itself is the output, and is made.
std::filesystem::path output_directory(const std::string& name) {
    std::filesystem::path path(name);
    if (path.filename().empty()) path = path.parent_path();
    std::error_code error;
    std::filesystem::create_directory(path, error);
    if (error || !std::filesystem::is_directory(path))
        throw std::runtime_error(fmt::format(
            "{}: cannot be made a directory ({}); give a path in an existing directory that you may write to", name,
            error ? error.message() : "it is a file"));
    return path;
}

void write_file(const std::string& path, std::string_view content) {
    AtomicFile file(path);
    file.write(content.data(), content.size());
    file.commit();
}

void run(const Options& options, Console& console) {
    Tour tour{output_directory(options.directory), options.parallel,
              Page("A tour of bandlimit",
                   "What goes wrong when pictures are resampled, why, and how it looks when done right. Every figure "
                   "and number on this page was computed by bandlimit; below each are commands that reproduce or check "
                   "it, to be run in this directory.")};
    for (const EmbeddedFile& photo : embedded_photographs())
        write_file(tour.path(photo.name), {reinterpret_cast<const char*>(photo.bytes), photo.size});
    tour.page.figure("overview.png",
                     "A zone plate halved by a box, which leaves false rings; by the wrong radial Lanczos, which "
                     "sharpens and lets aliases through; "
                     "and by Lanczos-3 along each axis.",
                     "bandlimit pattern zoneplate plate.exr --size 512x512 --low 0.05 --high 0.95\nbandlimit resize "
                     "plate.exr box.png --scale 0.5 --kernel box --edge reflect",
                     784);
    using Part = void (*)(Tour&);
    const Part parts[] = {tour_lanczos,       tour_grids,    tour_splines, tour_images,    tour_mips, tour_design,
                          tour_supersampling, tour_temporal, tour_raster,  tour_gradients, tour_audit};
    Progress progress(console, "tour", std::size(parts));
    for (std::size_t i = 0; i < std::size(parts); ++i) {
        parts[i](tour);
        progress.advance_to(static_cast<double>(i + 1));
    }
    const std::string page = tour.path("index.html");
    write_file(page, tour.page.html());
    console.print("{}\n", std::filesystem::absolute(page).lexically_normal().string());
    for (const Page::Headline& h : tour.page.headlines()) console.print("  {:<78} {}\n", h.what, h.value);
}

}  // namespace

void add_tour(Program& program) {
    auto options = std::make_shared<Options>();
    Verb verb = program.add_verb(
        "tour", "Write a page of figures and numbers that show resampling done right and wrong", "bandlimit tour out");
    verb.add_option("DIR", options->directory, "Directory to write index.html and its pictures to").required();
    add_threads(verb, options->parallel);
    program.add_quiet(verb);
    program.on(
        verb, [] {}, [options](Console& console) { run(*options, console); });
}

}  // namespace bandlimit::app
