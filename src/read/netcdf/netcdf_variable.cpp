// What a variable says of itself, with the library or without.
#include <algorithm>

#include "read/netcdf/netcdf_file.hpp"

namespace gaussdrift::read {

const NetcdfAttribute* NetcdfVariable::find(const std::string& attribute) const {
  const auto at = std::find_if(attributes.begin(), attributes.end(),
                               [&](const NetcdfAttribute& one) { return one.name == attribute; });
  return at == attributes.end() ? nullptr : &*at;
}

std::string NetcdfVariable::text(const std::string& attribute) const {
  const NetcdfAttribute* found = find(attribute);
  return found ? found->text : "";
}

const NetcdfVariable* NetcdfFile::find(const std::string& variable) const {
  const auto at = std::find_if(variables_.begin(), variables_.end(),
                               [&](const NetcdfVariable& one) { return one.name == variable; });
  return at == variables_.end() ? nullptr : &*at;
}

}  // namespace gaussdrift::read
