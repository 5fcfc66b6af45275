// Which numbers of a variable, as they stand in the file, are none.
#pragma once

#include <limits>
#include <vector>

#include "read/netcdf/netcdf_file.hpp"

namespace gaussdrift::read {

class RawMarks {
 public:
  RawMarks(const NetcdfFile& file, const NetcdfVariable& variable);
  bool marks(double number) const;

 private:
  std::vector<double> fills_;
  double least_ = -std::numeric_limits<double>::infinity(), most_ = std::numeric_limits<double>::infinity();
};

}  // namespace gaussdrift::read
