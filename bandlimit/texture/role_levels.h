// What a role does to texels before they are filtered, and to levels once they are.
// Stability: inner.
#pragma once
#include <optional>
#include <span>

#include "bandlimit/texture/mips.h"
#include "bandlimit/texture/normals.h"

namespace bandlimit {

/// How the texels of one chain go from stored samples to what is filtered, and back.
///
/// Levels of color, data, height and mask are weighted means of what is stored: the filter reads and writes stored
/// samples itself. Levels of other roles are made as floats first, and then finished: normals become unit, roughness
/// takes what normals lost, alpha is scaled to the coverage of level 0.
class RoleLevels {
public:
    /// `base` must stay until release_source(); where the chain goes by rows, only its shape and depth matter.
    /// throws  Error where role, encoding, target and channels do not fit
    RoleLevels(const AnyConstView& base, const Encoding& stored, const TexelFormat& target, const MipOptions& options,
               Parallel parallel);

    /// What the filter reads as level 0: the base, or floats that were made of it, as SourceRows.
    SourceRows source() const;
    /// The same as floats like those between levels.
    Image<float> source_as_floats(Parallel parallel) const {
        return decoded_ ? decoded_->clone() : floats_of(base_, parallel);
    }
    void release_source();

    int channels() const { return channels_; }            ///< that are filtered
    const Encoding& between() const { return between_; }  ///< of floats between levels

    /// Level 0 in the target's format: the same bits where nothing changes. To be made before others.
    AnyImage level_zero(bool& lost, Parallel parallel);

    /// A level made by filter.run(), and its floats, if they are wanted or needed.
    AnyImage level(const RowFilter& filter, const SourceRows& from, Image<float>& floats, bool keep_floats, bool& lost,
                   Parallel parallel);

    /// Whether rows of a level of so many channels are finished without the others, and level 0 is read as it is stored.
    static bool goes_by_rows(Role role, int channels);
    /// Rows of level 0 in the target's format.
    bool store_base_rows(const AnyConstView& rows, const AnyView& target, Parallel parallel) const;
    /// Rows of another level, of floats as they are between levels: all of them, unless it goes by rows. Both return
    /// whether a value that is not finite was stored as the code 0.
    bool store_rows(View<const float> floats, const AnyView& target, Parallel parallel);

private:
    bool has_own_alpha() const;  ///< whether the last channel of the base is alpha, or data in its place
    bool are_codes_of_normals() const;
    AnyView filtered_part(const AnyView& image) const;
    Encoding target_encoding() const;
    Image<float> floats_of(const AnyConstView& rows, Parallel parallel) const;
    void complete(const AnyView& image, Parallel parallel) const;
    bool store_means(View<const float> floats, const AnyView& target, Parallel parallel) const;
    bool store_roughness(View<const float> floats, const AnyView& target, Parallel parallel);
    bool store_with_coverage(View<const float> floats, const AnyView& target, Parallel parallel) const;
    void check(const Encoding& stored, const MipOptions& options) const;

    AnyConstView base_;
    Encoding stored_, between_;
    TexelFormat target_;
    const RoleTraits* role_;
    int base_channels_ = 0, channels_ = 0;
    bool base_is_grey_alpha_ = false;
    double alpha_threshold_, share_ = 0;  ///< of texels that pass in level 0
    std::optional<Image<float>> decoded_;
    std::optional<NormalMoments> moments_;
};

}  // namespace bandlimit
