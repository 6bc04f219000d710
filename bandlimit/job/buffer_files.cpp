#include "bandlimit/job/buffer_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "bandlimit/job/option_error.h"

namespace bandlimit::job {
namespace {

namespace fs = std::filesystem;

/// Digits as a number; -1 for anything else.
int number_from(std::string_view digits) {
    int number = -1;
    const char* const end = digits.data() + digits.size();
    const auto [last, status] = std::from_chars(digits.data(), end, number);
    return !digits.empty() && std::isdigit(static_cast<unsigned char>(digits[0])) && last == end &&
                   status == std::errc()
               ? number
               : -1;
}

/// Where the file of a pattern ends, and a colon and a channel may follow.
std::size_t end_of_file(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    return colon != std::string::npos && text.find('/', colon) == std::string::npos ? colon : text.size();
}

}  // namespace

std::string FilePattern::name_of(int number) const { return fmt::format("{}{:0{}}{}", before, number, digits, after); }

int FilePattern::number_of(const std::string& file_name) const {
    if (file_name.size() < before.size() + after.size() + static_cast<std::size_t>(digits) ||
        !file_name.starts_with(before) || !file_name.ends_with(after))
        return -1;
    return number_from(
        std::string_view(file_name).substr(before.size(), file_name.size() - before.size() - after.size()));
}

bool is_file_pattern(const std::string& text) {
    return text.find('#') != std::string::npos || std::string_view(text).substr(0, end_of_file(text)).ends_with(".exr");
}

FilePattern parse_file_pattern(const std::string& option, const std::string& text) {
    const auto fail = [&](const std::string& what) { throw OptionError(option, fmt::format("\"{}\" {}", text, what)); };
    const std::size_t end = end_of_file(text);
    const fs::path path = text.substr(0, end);
    const std::string name = path.filename().string();
    FilePattern pattern;
    pattern.folder = path.parent_path().string();
    if (end < text.size()) pattern.channel = text.substr(end + 1);
    if (pattern.folder.find('#') != std::string::npos) fail("has # in its folder; write it in the file's name only");
    const std::size_t first = name.find('#');
    if (first == std::string::npos) fail("names one file; write #### where its name has the number of the frame");
    const std::size_t last = std::min(name.find_first_not_of('#', first), name.size());
    if (name.find('#', last) != std::string::npos) fail("has two runs of #; write one, for the number of the frame");
    if (!name.ends_with(".exr")) fail("does not end in .exr; name EXR files");
    pattern.before = name.substr(0, first), pattern.after = name.substr(last);
    pattern.digits = static_cast<int>(last - first);
    return pattern;
}

std::vector<FrameFile> files_of(const FilePattern& pattern, const std::string& folder) {
    std::vector<FrameFile> files = exr_files_in((fs::path(folder) / pattern.folder).string());
    for (FrameFile& file : files) file.number = pattern.number_of(file.name);
    std::erase_if(files, [](const FrameFile& file) { return file.number < 0; });
    return files;
}

std::vector<FrameFile> exr_files_in(const std::string& folder) {
    if (!fs::is_directory(folder))
        throw std::runtime_error(folder + ": is not a folder; name one with EXR files, or a scene");
    std::vector<FrameFile> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() == ".exr" && name[0] != '.')
            files.push_back({entry.path().string(), name, number_in(name)});
    }
    return files;
}

int number_in(const std::string& name) {
    const std::string stem = fs::path(name).stem().string();
    const auto digits = std::find_if(stem.rbegin(), stem.rend(), [](unsigned char c) { return !std::isdigit(c); });
    return number_from(std::string_view(stem).substr(static_cast<std::size_t>(stem.rend() - digits)));
}

}  // namespace bandlimit::job
