// One .vti, .vtr, .pvti or legacy .vtk as it stands: its points, its arrays. A file is not believed: attributes, extents, pieces, lengths and
// sizes are checked before memory is taken for what they claim.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace gaussdrift::read {

constexpr double most_numbers = 268435456;  // 2 GiB are read at most

/// An array of numbers of a file; those by which VTK hides points and cells are not among them.
struct ArrayInfo {
  std::string name;
  std::size_t components = 1;
  bool on_cells = false;
};

struct ArrayValues {
  std::vector<double> numbers;      // [point or cell][component], the first axis fastest
  std::vector<double> fill_values;  // that the file names as marks of missing data in this array
};

class StoredGrid {
 public:
  /// Reads what the file says of itself. Throws GridFileError.
  explicit StoredGrid(const std::filesystem::path& file);
  ~StoredGrid();

  const std::array<std::size_t, 3>& points() const;  // an axis
  const std::vector<ArrayInfo>& arrays() const;

  /// Reads these arrays, and with them coordinates and masks. Once. Throws GridFileError.
  void load(const std::vector<ArrayInfo>& wanted);

  // After load():
  const std::vector<ArrayValues>& values() const;
  /// Coordinates as they stand in the file, ascending or descending.
  const std::vector<double>& axis(std::size_t k) const;
  /// Of a curvilinear grid the places of its points, [point][3]; then axis() counts indices. Else empty.
  const std::vector<double>& places() const;
  double rounding_of_places() const;
  /// By how much the coordinates may be wrong: the rounding of the type, or of the text, that they were written in.
  double rounding(std::size_t k) const;
  /// Points (or cells) that the file hides: 1 for those. Empty where there is no mask.
  const std::vector<std::uint8_t>& hidden(bool cells) const;
  /// The field array TimeValue; NaN where there is none.
  double time() const;
  /// The field array sphere_radius, where coordinates are longitudes and latitudes; 0 where there is none.
  double sphere() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace gaussdrift::read
