#include "apps/batch_manifest.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"

namespace bandlimit::app {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int version = 1;
constexpr const char* manifest_name = ".bandlimit-mips.json";

std::int64_t modified_at(const fs::path& path, std::error_code& error) {
    return fs::last_write_time(path, error).time_since_epoch().count();
}

MadeFile made_of(const json& entry) {
    return {entry.at("inputs").get<std::map<std::string, std::string>>(), entry.at("options").get<std::string>(),
            entry.at("size").get<std::uint64_t>(), entry.at("modified").get<std::int64_t>()};
}

}  // namespace

std::string hash_of_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) fail_file(path, "cannot be read; does it exist, and may you read it?");
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
    if (!state || XXH3_128bits_reset(state.get()) != XXH_OK) throw std::bad_alloc();
    std::vector<char> block(1 << 18);
    while (file) {
        file.read(block.data(), static_cast<std::streamsize>(block.size()));
        XXH3_128bits_update(state.get(), block.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (file.bad()) fail_file(path, "cannot be read to its end; check the disk");
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

Manifest::Manifest(const std::string& directory) : directory_(directory) {
    const fs::path path = fs::path(directory) / manifest_name;
    std::ifstream file(path);
    if (!file) return;
    try {
        const json root = json::parse(file);
        if (root.at("version") != version) return;
        for (const auto& [output, entry] : root.at("outputs").items()) made_[output] = made_of(entry);
    } catch (const json::exception&) {
        made_.clear();
    } catch (const std::ios_base::failure&) {  // of a directory, or a disk
        fail_file(path.string(), "cannot be read; remove it, and all textures are made anew");
    }
}

bool Manifest::is_current(const std::string& output, const std::map<std::string, std::string>& inputs,
                          const std::string& options) const {
    const auto made = made_.find(output);
    if (made == made_.end() || made->second.inputs != inputs || made->second.options != options) return false;
    const fs::path path = fs::path(directory_) / output;
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    if (error || size != made->second.size) return false;
    return modified_at(path, error) == made->second.modified && !error;
}

void Manifest::add(const std::string& output, std::map<std::string, std::string> inputs, std::string options) {
    const fs::path path = fs::path(directory_) / output;
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    const std::int64_t modified = modified_at(path, error);
    if (!error) made_[output] = {std::move(inputs), std::move(options), size, modified};
}

void Manifest::save() const {
    json outputs = json::object();
    for (const auto& [output, made] : made_)
        outputs[output] = {
            {"inputs", made.inputs}, {"options", made.options}, {"size", made.size}, {"modified", made.modified}};
    const json root{{"version", version}, {"outputs", std::move(outputs)}};
    const std::string text = root.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
    AtomicFile file((fs::path(directory_) / manifest_name).string());
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace bandlimit::app
