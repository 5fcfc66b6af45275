#include "reference/reference.hpp"

namespace gaussdrift {

std::string to_string(ReferenceSpec::Kind kind) {
  switch (kind) {
    case ReferenceSpec::Kind::characteristics:
      return "characteristics";
    case ReferenceSpec::Kind::exact:
      return "exact";
    case ReferenceSpec::Kind::none:
      return "none";
  }
  return "";
}

}  // namespace gaussdrift
