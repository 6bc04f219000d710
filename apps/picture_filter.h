// From picture to picture of the same size: what such verbs share.
#pragma once
#include <functional>
#include <string>

#include <nlohmann/json.hpp>
#include "apps/common.h"
#include "apps/row_stream.h"

namespace bandlimit::app {

/// The transfer function of a file to be written, where the source has `space`.
Transfer output_transfer(Space space, const ImageInfo& in, const FormatAbilities& format, Depth depth);

/// The codes of `reader` and of what is to be written, where --space data treats alpha as a channel like the others
/// unless it was asked for.
void treat_alpha_as_asked(Space space, bool premultiply, int source_alpha, bool associated, int target_alpha,
                          Encoding& from, Encoding& to);

/// Says how the colours of `file` are taken that has an ICC profile other than sRGB; nothing of others, or where the
/// user has said what its codes mean.
void note_foreign_profile(const Console& console, const std::string& file, const ImageInfo& in, Space space);

/// Adds --alpha.
Option add_alpha(Verb verb, std::optional<bool>& premultiply);

struct PictureOptions {
    std::string in, out;
    std::optional<Edge> edge;
    Space space = Space::automatic;
    std::optional<bool> premultiply;
    std::optional<Depth> depth;
    int tile = 0;
    Parallel parallel;
    bool json = false;

    bool premultiplies() const { return premultiply.value_or(space != Space::data); }
};

/// Adds IN, OUT and the options above but IN and OUT, which come first.
void add_pictures(Verb verb, PictureOptions& o);
void add_picture_options(Program& program, Verb verb, PictureOptions& o);
/// Throws UsageError for what the command line alone shows to be wrong.
void check_pictures(const PictureOptions& o);

/// A filter ready to run, and what to say of it.
struct PictureFilter {
    RowFilter rows;
    std::uint64_t memory = 0;       ///< that it takes
    nlohmann::ordered_json report;  ///< what it did, for --json
    std::string line;               ///< the same for people
};

/// Reads, filters and writes. `make` sees what is to be filtered.
void filter_picture(const PictureOptions& o, Console& console,
                    const std::function<PictureFilter(const ImageInfo& in)>& make);

}  // namespace bandlimit::app
