#include "bandlimit/job/batch.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "bandlimit/core/file_error.h"
#include "bandlimit/job/batch_manifest.h"
#include "bandlimit/job/batch_rules.h"
#include "bandlimit/job/make_texture.h"
#include "bandlimit/job/stopwatch.h"

namespace bandlimit::job {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

/// What becomes of a picture.
struct Item {
    std::string input, output;  ///< relative to the directories
    bool is_left_out = false, is_current = false, is_made = false;
    std::string error;  ///< why it failed, or ""
    std::vector<std::string> notes;
    MipsJob job;
    RoleChoice role;
    std::map<std::string, std::string> sources, hashes;  ///< paths and content of all that is read, by short names
    std::string options;                                 ///< all that decides how it is made
    MipsCost cost;

    bool is_due() const { return !is_left_out && !is_current && error.empty(); }
};

bool is_picture(const fs::path& path) {
    constexpr std::array<std::string_view, 16> extensions{".png", ".jpg",  ".jpeg", ".jpe", ".tif", ".tiff",
                                                          ".exr", ".hdr",  ".rgbe", ".ppm", ".pgm", ".pnm",
                                                          ".pfm", ".webp", ".tga",  ".bmp"};
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

bool is_hidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

/// The pictures below `root`, relative to it, in order; hidden files and folders, and `out`, are passed over.
std::vector<std::string> pictures_below(const fs::path& root, const fs::path& out) {
    std::vector<std::string> pictures;
    try {
        for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator();
             ++entry) {
            std::error_code ignored;  // of links that lead nowhere, or in circles
            const bool is_folder = entry->is_directory(ignored);
            const bool is_passed = is_hidden(*entry) || (is_folder && fs::equivalent(*entry, out, ignored));
            if (is_passed && is_folder) entry.disable_recursion_pending();
            // Links that lead nowhere are listed with what fails.
            const bool is_file = entry->is_regular_file(ignored) || (entry->is_symlink(ignored) && !is_folder);
            if (!is_passed && is_picture(*entry) && is_file)
                pictures.push_back(entry->path().lexically_relative(root).generic_string());
        }
    } catch (const fs::filesystem_error& e) {
        fail_file(root.string(), "cannot be read: ", e.code().message(), " (", e.path1().string(),
                  "); name a directory that you may read");
    }
    std::sort(pictures.begin(), pictures.end());
    return pictures;
}

std::string file_of(const std::string& directory, const std::string& relative) {
    return (fs::path(directory) / relative).string();
}

/// All that decides how a texture is made, but for what is read.
std::string options_text(const MipsRecipe& r, Role role) {
    const auto edge = [](const std::optional<Edge>& e) { return e ? name_of(*e) : "default"; };
    return fmt::format(
        "bandlimit {}, role {}, threshold {}, filter {}, from {}, edge {},{}, levels {}, space {}, "
        "depth {}, channels {}{}{}",
        BANDLIMIT_VERSION, name_of(role), r.alpha_threshold.value_or(0), is_taps_file(r.filter) ? "taps" : r.filter,
        r.from == MipSource::base ? "base" : "previous", edge(r.edge_x), edge(r.edge_y), r.levels, name_of(r.space),
        r.depth ? name_of(*r.depth) : "default", r.channels, r.two_channel ? ", two-channel" : "",
        r.premultiplied ? ", premultiplied" : "");
}

/// Options of the whole batch that other roles have are no mistake here.
MipsRecipe fitting(MipsRecipe recipe, Role role) {
    if (role != Role::alpha_tested) recipe.alpha_threshold.reset();
    if (role != Role::normal) recipe.two_channel = false;
    if (role != Role::roughness) recipe.normal.clear();
    if (!traits_of(role).is_light) recipe.premultiplied = false;
    return recipe;
}

/// Where what a texture is made of lies, by names that do not depend on where the program runs.
std::map<std::string, std::string> sources_of(const BatchJob& batch, const Item& item) {
    const MipsRecipe& recipe = item.job.recipe;
    std::map<std::string, std::string> sources{{item.input, item.job.inputs.front()}};
    if (!recipe.normal.empty())
        sources[fs::path(recipe.normal).lexically_relative(batch.in).generic_string()] = recipe.normal;
    if (is_taps_file(recipe.filter)) sources["taps"] = recipe.filter;
    return sources;
}

/// The jobs of all pictures, and what is wrong with them by their names alone.
std::vector<Item> items_of(const BatchJob& batch) {
    const std::vector<Rule> rules = batch.rules.empty() ? std::vector<Rule>{} : read_rules(batch.rules);
    std::vector<Item> items;
    std::map<std::string, std::string> makers;  // by output
    for (const std::string& input : pictures_below(batch.in, batch.out)) {
        Item item;
        item.input = input;
        item.output =
            fs::path(input).replace_extension(batch.format == Container::dds ? ".dds" : ".ktx2").generic_string();
        const Rule* rule = rule_for(rules, input);
        item.is_left_out = rule != nullptr && rule->is_skipped;
        item.job.inputs = {file_of(batch.in, input)};
        item.job.output = file_of(batch.out, item.output);
        item.job.recipe = rule != nullptr ? apply(*rule, batch.recipe, batch.in, input) : batch.recipe;
        item.role = choose_role(item.job.recipe, input, false);
        item.job.recipe.role = item.role.role;
        item.job.recipe = fitting(item.job.recipe, item.role.role);
        item.options = options_text(item.job.recipe, item.role.role);
        item.sources = sources_of(batch, item);
        if (!item.is_left_out)
            if (const auto [maker, is_new] = makers.try_emplace(item.output, input); !is_new)
                item.error = fmt::format("{}: {} makes the same file; rename one of them, or leave one out by a rule",
                                         item.job.output, file_of(batch.in, maker->second));
        items.push_back(std::move(item));
    }
    return items;
}

/// Reads what decides whether the texture must be made, and what that will take.
void examine(Item& item, const Manifest& manifest) {
    try {
        for (const auto& [name, path] : item.sources) item.hashes[name] = hash_of_file(path);
        item.is_current = manifest.is_current(item.output, item.hashes, item.options);
        if (!item.is_current) item.cost = cost_of(item.job);
    } catch (const std::exception& e) {
        item.error = e.what();
    }
}

std::vector<Item> examined_items(const BatchJob& batch, const Manifest& manifest, const Context& context) {
    std::error_code error;
    if (!fs::is_directory(batch.in, error))
        fail_file(batch.in, "is not a directory; name the one that holds the pictures");
    std::vector<Item> items = items_of(batch);
    std::mutex mutex;
    int done = 0;
    parallel_for(static_cast<std::ptrdiff_t>(items.size()), 1, context.parallel,
                 [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                     for (std::ptrdiff_t i = begin; i < end; ++i) {
                         Item& item = items[static_cast<std::size_t>(i)];
                         if (item.is_due()) examine(item, manifest);
                         const std::lock_guard lock(mutex);
                         context.report({"looking", double(++done), double(items.size())});
                     }
                 });
    return items;
}

/// Makes the textures that are due, several at a time.
class Crew {
public:
    Crew(const BatchJob& batch, std::vector<Item>& items, Manifest& manifest, const Context& context)
        : manifest_(manifest), context_(context), threads_(context.parallel.count()) {
        memory_ = batch.memory > 0 ? batch.memory : available_memory() / 4;
        for (Item& item : items)
            if (item.is_due()) {
                waiting_.push_back(&item);
                pixels_ += item.cost.pixels;
            }
        // The largest first, so that none of them is left for the end, when it would keep one thread busy alone.
        std::stable_sort(waiting_.begin(), waiting_.end(),
                         [](const Item* a, const Item* b) { return a->cost.bytes > b->cost.bytes; });
    }

    void run() {
        const std::size_t count = std::min(waiting_.size(), static_cast<std::size_t>(threads_));
        if (const TaskRunner* runner = context_.parallel.runner) {
            (*runner)(static_cast<int>(count), [this](int) { work(); });
        } else {
            std::vector<std::jthread> workers;
            for (std::size_t i = 1; i < count; ++i) workers.emplace_back([this] { work(); });
            work();
        }
        if (failure_) std::rethrow_exception(failure_);
        manifest_.save();
        context_.parallel.check_stop();
    }

private:
    struct Turn {
        Item* item;
        int threads;
    };

    bool fits(const Item& item, std::uint64_t memory, int running) const {
        return running == 0 || item.cost.bytes <= memory_ - std::min(memory_, memory);
    }

    /// The next texture that memory has room for, and its threads: its share of those that are free, among all that
    /// could start now.
    std::optional<Turn> next() {
        const int free = threads_ - busy_;
        if (free <= 0) return {};
        std::uint64_t memory = used_;
        int count = 0;
        std::deque<Item*>::iterator first = waiting_.end();
        for (auto item = waiting_.begin(); item != waiting_.end() && count < free; ++item) {
            if (!fits(**item, memory, running_ + count)) continue;
            if (count++ == 0) first = item;
            memory += (*item)->cost.bytes;
        }
        if (count == 0) return {};
        const Turn turn{*first, free / count};
        waiting_.erase(first);
        busy_ += turn.threads;
        ++running_;
        used_ += turn.item->cost.bytes;
        return turn;
    }

    void work() {
        std::unique_lock lock(mutex_);
        while (true) {
            std::optional<Turn> turn;
            changed_.wait(lock,
                          [&] { return failure_ || is_stopped() || waiting_.empty() || (turn = next()).has_value(); });
            if (!turn) return;
            lock.unlock();
            make(*turn);
            lock.lock();
            busy_ -= turn->threads;
            --running_;
            used_ -= turn->item->cost.bytes;
            note_done(*turn->item);
            changed_.notify_all();
        }
    }

    bool is_stopped() const { return context_.parallel.stop.stop_requested(); }

    void make(const Turn& turn) const {
        Item& item = *turn.item;
        try {
            std::error_code error;
            const fs::path folder = fs::path(item.job.output).parent_path();
            fs::create_directories(folder, error);
            if (error)
                fail_file(item.job.output, "the directory ", folder.string(), " cannot be created: ", error.message(),
                          "; choose another place");
            item.notes = notes_of(make_texture(item.job, {.parallel = context_.parallel.with_threads(turn.threads)}),
                                  item.input);
            item.is_made = true;
        } catch (const std::bad_alloc&) {
            item.error = item.job.inputs.front() + ": memory is exhausted; close other programs, or use one thread";
        } catch (const std::exception& e) {
            item.error = e.what();
        }
    }

    /// Notes a texture in the manifest, which is written once in a while. An error of that ends the work: what cannot
    /// be noted would be made again and again.
    void note_done(const Item& item) {
        done_ += item.cost.pixels;
        context_.report({"making", double(done_) / 1e6, double(pixels_) / 1e6, "MPix"});
        if (!item.is_made) return;
        manifest_.add(item.output, item.hashes, item.options);
        const auto now = steady_clock::now();
        if (now - saved_ < std::chrono::seconds(1)) return;
        saved_ = now;
        try {
            manifest_.save();
        } catch (...) {
            failure_ = std::current_exception();
        }
    }

    Manifest& manifest_;
    const Context& context_;
    int threads_;
    std::uint64_t memory_ = 0, pixels_ = 0;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Item*> waiting_;
    int busy_ = 0, running_ = 0;         ///< threads, textures
    std::uint64_t used_ = 0, done_ = 0;  ///< bytes of memory, pixels
    steady_clock::time_point saved_{};   ///< when the manifest was last written
    std::exception_ptr failure_;
};

/// Why a picture failed, without its name where the reason begins with it.
std::string reason_of(const Item& item) {
    const std::string name = item.job.inputs.front() + ": ";
    return item.error.starts_with(name) ? item.error.substr(name.size()) : item.error;
}

BatchReport report_of(const std::vector<Item>& items) {
    BatchReport report;
    for (const Item& item : items) {
        if (item.is_left_out) {
            ++report.left_out;
        } else if (item.is_current) {
            ++report.skipped;
        } else if (!item.error.empty()) {
            report.failed.push_back({item.input, reason_of(item)});
        } else {
            ++report.made;
            ++report.roles[std::string(name_of(item.role.role))];
            report.notes.insert(report.notes.end(), item.notes.begin(), item.notes.end());
            report.pixels += item.cost.pixels;
        }
    }
    return report;
}

}  // namespace

std::vector<PlannedFile> plan_batch(const BatchJob& batch, const Context& context) {
    std::vector<PlannedFile> plan;
    for (const Item& item : examined_items(batch, Manifest(batch.out), context)) {
        const bool fails = !item.error.empty();
        plan.push_back({item.input, item.output,
                        item.is_left_out  ? "left out"
                        : item.is_current ? "up to date"
                        : fails           ? "fail"
                                          : "make",
                        std::string(name_of(item.role.role)), fails ? reason_of(item) : item.role.because});
    }
    return plan;
}

BatchReport make_batch(const BatchJob& batch, const Context& context) {
    const Stopwatch watch;
    Manifest manifest(batch.out);
    std::vector<Item> items = examined_items(batch, manifest, context);
    std::error_code error;
    fs::create_directories(batch.out, error);
    if (error) fail_file(batch.out, "the directory cannot be created: ", error.message(), "; choose another place");
    Crew(batch, items, manifest, context).run();
    BatchReport report = report_of(items);
    report.seconds = watch.total();
    return report;
}

}  // namespace bandlimit::job
