// From what a header says to what it means.
#include <algorithm>
#include <string>

#include "bandlimit/io/oiio/oiio.h"
#include "bandlimit/io/orientation.h"

namespace bandlimit::oiio {
namespace {

Depth depth_for(const OIIO::ImageSpec& spec) {
    const bool is_mixed = !spec.channelformats.empty() &&
                          !std::all_of(spec.channelformats.begin(), spec.channelformats.end(),
                                       [&](OIIO::TypeDesc type) { return type == spec.channelformats.front(); });
    if (is_mixed) return Depth::f32;
    switch (spec.format.basetype) {
        case OIIO::TypeDesc::UINT8: return Depth::u8;
        case OIIO::TypeDesc::UINT16: return Depth::u16;
        case OIIO::TypeDesc::HALF: return Depth::f16;
        default: return Depth::f32;
    }
}

/// "sRGB", "linear", "gamma 2.2", "Rec709", or "".
std::string color_hint_of(const OIIO::ImageSpec& spec, const std::string& format, Depth depth) {
    // OpenImageIO says Rec709 of every PNM, though PFM is linear; and misreads the exponent of HDR.
    if (format == "pnm" && !is_integer(depth)) return "";
    if (format == "hdr") return "linear";
    const std::string name = spec.get_string_attribute("oiio:ColorSpace");
    if (OIIO::Strutil::iequals(name, "linear")) return "linear";
    constexpr std::string_view gamma = "GammaCorrected";
    if (OIIO::Strutil::istarts_with(name, gamma)) return "gamma " + name.substr(gamma.size());
    return name;
}

/// Whether a profile calls itself sRGB, in ASCII (version 2) or in big-endian UTF-16 (version 4).
bool is_srgb_profile(std::string_view profile) {
    return profile.find("sRGB") != profile.npos || profile.find(std::string_view("s\0R\0G\0B", 7)) != profile.npos;
}

/// OpenImageIO marks what it could have multiplied by alpha; the rest of TIFF and TGA is multiplied in the file.
bool is_associated(const OIIO::ImageSpec& spec, const std::string& format) {
    if (spec.alpha_channel < 0) return false;
    if (format == "openexr") return true;
    return (format == "tiff" || format == "targa") && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
}

}  // namespace

ImageInfo info_of(const OIIO::ImageSpec& spec, const std::string& format) {
    ImageInfo info;
    info.format = format;
    const int orientation = spec.get_int_attribute("Orientation", 1);
    info.orientation = orientation >= 1 && orientation <= 8 ? orientation : 1;
    info.width = is_sideways(info.orientation) ? spec.height : spec.width;
    info.height = is_sideways(info.orientation) ? spec.width : spec.height;
    info.channel_names = spec.channelnames;
    info.channel_names.resize(static_cast<std::size_t>(spec.nchannels));
    info.depth = depth_for(spec);
    info.alpha = spec.alpha_channel;
    info.associated = is_associated(spec, format);
    info.color_hint = color_hint_of(spec, format, info.depth);
    const bool is_linear = info.color_hint == "linear" || (info.color_hint.empty() && !is_integer(info.depth));
    info.transfer = is_linear ? Transfer::linear : Transfer::srgb;
    const std::string_view profile = profile_in(spec.extra_attribs);
    info.has_foreign_profile = !profile.empty() && !is_srgb_profile(profile);
    return info;
}

}  // namespace bandlimit::oiio
