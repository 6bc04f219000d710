#include "bandlimit/job/batch_manifest.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>
#include "bandlimit/core/file_error.h"
#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/regular_file.h"

namespace bandlimit::job {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int version = 1;
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;
constexpr const char* manifest_name = ".bandlimit-mips.json";

std::int64_t modified_at(const fs::path& path, std::error_code& error) {
    return fs::last_write_time(path, error).time_since_epoch().count();
}

MadeFile made_of(const json& entry) {
    std::map<std::string, std::string> inputs;
    for (const auto& [input, hash] : entry.at("inputs").items()) inputs[name_of_text(input)] = hash.get<std::string>();
    return {std::move(inputs), entry.at("options").get<std::string>(), entry.at("size").get<std::uint64_t>(),
            entry.at("modified").get<std::int64_t>()};
}

}  // namespace

std::string text_of_name(std::string_view name) {
    std::string text;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f && c != '%') text += c;
        else text += fmt::format("%{:02X}", byte);
    }
    return text;
}

std::string name_of_text(std::string_view text) {
    std::string name;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned byte = 0;
        const char* const digits = text.data() + i + 1;
        const bool is_byte =
            text[i] == '%' && text.size() - i > 2 && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
        name += is_byte ? static_cast<char>(byte) : text[i];
        if (is_byte) i += 2;
    }
    return name;
}

std::string hash_of_file(const std::string& path) {
    const File file = open_regular(path);
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
    if (!state || XXH3_128bits_reset(state.get()) != XXH_OK) throw std::bad_alloc();
    std::vector<char> block(1 << 18);
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get()))
        XXH3_128bits_update(state.get(), block.data(), count);
    if (std::ferror(file.get()) != 0) fail_file(path, "cannot be read to its end; check the disk");
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

Manifest::Manifest(const std::string& directory) : directory_(directory) {
    const fs::path path = fs::path(directory) / manifest_name;
    std::error_code error;
    if (!fs::exists(path, error)) return;
    try {
        const json root = json::parse(read_text(path.string(), most_bytes, "another OUTDIR, or remove it"));
        if (root.at("version") != version) return;
        for (const auto& [output, entry] : root.at("outputs").items()) made_[name_of_text(output)] = made_of(entry);
    } catch (const json::exception&) {
        made_.clear();
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
    for (const auto& [output, made] : made_) {
        json inputs = json::object();
        for (const auto& [input, hash] : made.inputs) inputs[text_of_name(input)] = hash;
        outputs[text_of_name(output)] = {
            {"inputs", std::move(inputs)}, {"options", made.options}, {"size", made.size}, {"modified", made.modified}};
    }
    const json root{{"version", version}, {"outputs", std::move(outputs)}};
    const std::string text = root.dump(1) + "\n";
    AtomicFile file((fs::path(directory_) / manifest_name).string());
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace bandlimit::job
