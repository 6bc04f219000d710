// Textures in DDS files. Not for callers: container.h has the functions.
// Stability: inner.
#pragma once
#include "bandlimit/texture/container_layout.h"

namespace bandlimit {

/// The first bytes of every file.
inline constexpr std::string_view dds_identifier = "DDS ";

/// Reads the header of a DDS file.
///
/// range    uncompressed formats of 8 and 16 bits, halves and floats: what a DX10 header names, masks of whole bytes
///          (luminance too, L and A as red and green), and the numbers that Direct3D 9 gave to wide formats. Three
///          channels are read as four. What masks say gets the name of the DXGI format that lies alike, or where there
///          is none the order of its channels, "B8G8R8"
/// throws   as container_info
/// source   DDS_HEADER, DDS_PIXELFORMAT and DDS_HEADER_DXT10 (Microsoft, "Programming guide for DDS")
ContainerLayout dds_layout(const FileBytes& file);

/// The format in which texels are written; null if there is none.
const NumberedFormat* dds_format(const TexelFormat& format);

/// Plans a file for what check_container() accepts: layer by layer, face by face.
///
/// The header is DX10's, but for the two formats that the older header can tell exactly and that older readers know by
/// it alone: R8 and RGBA8, linear, straight, and no array. OpenImageIO 2.4, ffmpeg and Pillow read these; ImageMagick 6
/// swaps red and blue of RGBA8, as of every file whose masks do not have blue first.
ContainerPlan plan_dds(const TextureShape& shape);

}  // namespace bandlimit
