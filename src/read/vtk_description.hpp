// Reads and checks the XML of a .vti or .vtr: every attribute is read whole, all pieces have the same arrays, and
// together they cover the extent.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "read/vtk_grid.hpp"

class vtkXMLDataElement;

namespace gaussdrift::read {

/// First and last index of points on each axis, both included.
using Extent = std::array<int, 6>;

struct Description {
  Extent extent{};
  std::vector<Extent> pieces;
  std::vector<ArrayInfo> arrays;                     // of all pieces, masks too
  std::vector<std::vector<double>> fill_values;      // of each array, by its attributes
  std::array<double, 3> origin{}, spacing{1, 1, 1};  // of image data
  std::array<double, 3> origin_rounding{}, spacing_rounding{};

  /// Do the pieces cover the points (the cells) of the extent?
  bool covered(bool cells) const;
};

/// `image`: of image data, which has its coordinates in attributes. Throws GridFileError.
Description describe_grid(vtkXMLDataElement* grid, const std::filesystem::path& file, bool image);

/// Throws GridFileError unless the file is there and can be read.
void check_readable(const std::filesystem::path& file);

/// The lines of elements that are asked for in the order of the file.
class LineCounter {
 public:
  explicit LineCounter(const std::filesystem::path& file);
  std::size_t line(vtkXMLDataElement* element);

 private:
  std::ifstream stream_;
  std::vector<char> block_;
  long long at_ = 0;
  std::size_t lines_ = 1;
};

/// "wind.vti:3": the line of an element of the file.
std::string line_of(const std::filesystem::path& file, vtkXMLDataElement* element);

/// The numbers between the tags of a DataArray with format="ascii". Throws GridFileError where a word is none.
std::vector<double> numbers_in_text(const std::filesystem::path& file, vtkXMLDataElement* array);

}  // namespace gaussdrift::read
