#include "bandlimit/job/temporal_checkpoint.h"

#include <xxhash.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/limited_json.h"
#include "bandlimit/io/regular_file.h"
#include "bandlimit/job/batch_manifest.h"

namespace bandlimit::job {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::string_view magic = "bandlimit temporal 1\n";
constexpr const char* checkpoint_name = ".bandlimit-temporal";

/// The 128-bit XXH3 hash of what passes.
class Hash {
public:
    Hash() : state_(XXH3_createState(), &XXH3_freeState) {
        if (!state_ || XXH3_128bits_reset(state_.get()) != XXH_OK) throw std::bad_alloc();
    }
    void add(const void* data, std::size_t size) { XXH3_128bits_update(state_.get(), data, size); }
    XXH128_canonical_t digest() const {
        XXH128_canonical_t bytes;
        XXH128_canonicalFromHash(&bytes, XXH3_128bits_digest(state_.get()));
        return bytes;
    }

private:
    std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

json to_json(const FileStamp& stamp) { return {text_of_name(stamp.path), stamp.size, stamp.modified}; }
FileStamp stamp_in(const json& entry) {
    return {name_of_text(entry.at(0).get<std::string>()), entry.at(1).get<std::uint64_t>(),
            entry.at(2).get<std::int64_t>()};
}

json to_json(const std::optional<double>& value) { return value ? json(*value) : json(); }
std::optional<double> value_in(const json& value) {
    return value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
}

json to_json(const MadeFrame& frame) {
    json inputs = json::array();
    for (const FileStamp& stamp : frame.inputs) inputs.push_back(to_json(stamp));
    const TemporalFrameReport& r = frame.report;
    return {{"number", r.number},
            {"file", text_of_name(r.file)},
            {"psnr", to_json(r.psnr)},
            {"ssim", to_json(r.ssim)},
            {"ms", r.ms},
            {"inputs", std::move(inputs)},
            {"output", to_json(frame.output)}};
}

MadeFrame frame_in(const json& entry) {
    MadeFrame frame;
    frame.report = {entry.at("number").get<int>(), name_of_text(entry.at("file").get<std::string>()),
                    value_in(entry.at("psnr")), value_in(entry.at("ssim")), entry.at("ms").get<double>()};
    for (const json& stamp : entry.at("inputs")) frame.inputs.push_back(stamp_in(stamp));
    frame.output = stamp_in(entry.at("output"));
    return frame;
}

bool is_current(const FileStamp& stamp) { return stamp_of(stamp.path) == stamp; }

/// Throws for anything that save() did not write, or that is out of date.
std::vector<MadeFrame> restored(const std::string& path, const std::string& settings, TemporalHistory& history,
                                std::optional<TemporalMeter>& meter) {
    const File file = open_regular(path, "a checkpoint");
    std::uint64_t left = length_of(file);
    Hash hash;
    const ReadBytes read = [&](void* data, std::size_t size) {
        if (size > left || std::fread(data, 1, size, file.get()) != size) throw std::runtime_error("cut short");
        left -= size;
        hash.add(data, size);
    };
    std::string start(magic.size(), '\0');
    read(start.data(), start.size());
    std::uint64_t length = 0;
    read(&length, sizeof length);
    if (start != magic || length > std::min(left, most_json_bytes)) throw std::runtime_error("not a checkpoint");
    std::string text(length, '\0');
    read(text.data(), length);
    const json head = parse_limited_json(text, path, "a checkpoint");
    if (head.at("settings").get<std::string>() != text_of_name(settings)) throw std::runtime_error("of other settings");
    std::vector<MadeFrame> frames;
    for (const json& entry : head.at("frames")) frames.push_back(frame_in(entry));
    for (const MadeFrame& frame : frames) {
        bool is_as_it_was = is_current(frame.output);
        for (const FileStamp& input : frame.inputs) is_as_it_was &= is_current(input);
        if (!is_as_it_was) throw std::runtime_error("out of date");
    }
    bandlimit::restore(history, read);
    if (meter) bandlimit::restore(*meter, read);
    const XXH128_canonical_t wanted = hash.digest();
    XXH128_canonical_t found;
    read(&found, sizeof found);
    if (left != 0 || XXH128_isEqual(XXH128_hashFromCanonical(&found), XXH128_hashFromCanonical(&wanted)) == 0)
        throw std::runtime_error("damaged");
    return frames;
}

}  // namespace

FileStamp stamp_of(const std::string& path) {
    FileStamp stamp{path, 0, 0};
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    if (error) return stamp;
    const fs::file_time_type time = fs::last_write_time(path, error);
    if (!error) stamp.size = size, stamp.modified = time.time_since_epoch().count();
    return stamp;
}

TemporalCheckpoint::TemporalCheckpoint(const std::string& folder, std::string settings)
    : path_((fs::path(folder) / checkpoint_name).string()), settings_(std::move(settings)) {}

std::vector<MadeFrame> TemporalCheckpoint::restore(TemporalHistory& history,
                                                   std::optional<TemporalMeter>& meter) const {
    std::error_code error;
    if (!fs::exists(path_, error)) return {};
    TemporalHistory old(history.width(), history.height());
    std::optional<TemporalMeter> old_meter;
    if (meter) old_meter.emplace(history.width(), history.height());
    try {
        std::vector<MadeFrame> frames = restored(path_, settings_, old, old_meter);
        history = std::move(old);
        meter = std::move(old_meter);
        return frames;
    } catch (const std::runtime_error&) {  // of files, of other settings, out of date
    } catch (const json::exception&) {
    } catch (const Error&) {  // of restore()
    }
    return {};
}

void TemporalCheckpoint::save(const std::vector<MadeFrame>& frames, const TemporalHistory& history,
                              const std::optional<TemporalMeter>& meter) const {
    json head{{"settings", text_of_name(settings_)}, {"frames", json::array()}};
    for (const MadeFrame& frame : frames) head["frames"].push_back(to_json(frame));
    const std::string text = head.dump();
    const std::uint64_t length = text.size();
    AtomicFile file(path_);
    Hash hash;
    const WriteBytes write = [&](const void* data, std::size_t size) {
        file.write(data, size);
        hash.add(data, size);
    };
    write(magic.data(), magic.size());
    write(&length, sizeof length);
    write(text.data(), text.size());
    store(history, write);
    if (meter) store(*meter, write);
    const XXH128_canonical_t end = hash.digest();
    file.write(&end, sizeof end);
    file.commit();
}

void TemporalCheckpoint::remove() const {
    std::error_code error;
    fs::remove(path_, error);
}

}  // namespace bandlimit::job
