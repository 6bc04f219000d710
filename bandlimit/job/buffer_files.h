// The files of one buffer of a sequence, by the pattern of their names.
//
//     const FilePattern depth = parse_file_pattern("depth", "passes/depth_####.exr:Z");
//     depth.number_of("depth_0012.exr");  // 12
// Stability: evolving.
#pragma once
#include <string>
#include <vector>

namespace bandlimit::job {

/// "passes/depth_####.exr:Z": one run of # stands for the number of the frame, with zeros before it up to that many
/// digits; what follows a colon is a channel.
struct FilePattern {
    std::string folder;         ///< "passes", "" or absolute
    std::string before, after;  ///< "depth_" and ".exr"
    int digits = 0;             ///< 4
    std::string channel;        ///< "Z"; empty: found by its name

    /// "depth_####.exr"
    std::string name() const { return before + std::string(static_cast<std::size_t>(digits), '#') + after; }
    /// "depth_0012.exr"
    std::string name_of(int number) const;
    /// 12; -1 for names that do not match.
    int number_of(const std::string& file_name) const;
};

/// Whether this names files rather than channels: it has a # or ends in .exr, a channel after it aside.
bool is_file_pattern(const std::string& text);
/// throws   OptionError, naming `option`, unless the name of the file has one run of # and ends in .exr
FilePattern parse_file_pattern(const std::string& option, const std::string& text);

/// A file of a frame. Its number is -1 where its name has none.
struct FrameFile {
    std::string path, name;
    int number = -1;
};

/// The files in a folder that match, in no order; the pattern's folder is relative to `folder`.
/// throws   std::runtime_error for a folder that there is none of
std::vector<FrameFile> files_of(const FilePattern& pattern, const std::string& folder);
/// All EXR files in a folder but hidden ones, numbered by what their names end in, in no order. throws likewise
std::vector<FrameFile> exr_files_in(const std::string& folder);

/// The number that a file's name ends in, before its extension; -1 if there is none.
int number_in(const std::string& name);

}  // namespace bandlimit::job
