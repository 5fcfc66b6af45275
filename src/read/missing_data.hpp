// Missing data: land in a wind over the sea, clouds before a satellite. A file marks them by numbers that cannot be
// winds (NaN, 1e20, -9999, ...). Taken as values they would carry particles out of the world.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "field/gridded/grid_data.hpp"

namespace gaussdrift::read {

/// What stands where data are missing.
enum class Missing {
  error,    // the file is refused
  zero,     // 0: a coast, towards which a velocity falls to nothing within one cell
  nearest,  // the mean of the nearest points that have values
  keep,     // nothing is taken for missing: the numbers are meant
  land      // NaN: there is no fluid (GridData::land)
};
constexpr std::array<std::string_view, 5> missing_names{"error", "zero", "nearest", "keep", "land"};

/// The points that the file itself hides; [time][point], or empty where a time hides none.
using HiddenPoints = std::vector<std::vector<std::uint8_t>>;

/// Which numbers mark missing data.
struct Marks {
  std::vector<double> named;      // by the file or the user; also as rounded to single precision
  std::vector<double> common;     // numbers that programs use, and that occur here far outside the rest
  std::optional<double> far_out;  // this size and more lies far outside the rest

  /// Why this number marks missing data; empty if it does not.
  std::string reason(double value) const;
};

/// Marks that occur in the data: `named` ones, and those of common use (below 1e19 only where they are at least four
/// times the largest of the rest). A value of at least a million that is thousands of times the largest of the rest is
/// a mark too, unless the data decay over many powers of ten by nature.
Marks recognise_marks(const GridData& data, std::vector<double> named, bool decays);

/// Does what `missing` says with points that are hidden, have a mark, or are not finite. Throws GridFileError for
/// Missing::error, and for values that are not finite with Missing::keep. files: of each time, for messages.
void settle_missing(GridData& data, const HiddenPoints& hidden, const Marks& marks, Missing missing,
                    const std::vector<std::string>& files);

}  // namespace gaussdrift::read
