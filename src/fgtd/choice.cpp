// Names of methods, and what was chosen as one line.
#include <ostream>

#include "fgtd/fgtd.hpp"

namespace fgtd {

const std::vector<Method>& methods() {
  static const std::vector<Method> all{Method::automatic, Method::direct, Method::hermite};
  return all;
}

std::string to_string(Method method) {
  switch (method) {
    case Method::direct:
      return "direct";
    case Method::hermite:
      return "hermite";
    default:
      return "auto";
  }
}

std::ostream& operator<<(std::ostream& out, const Choice& choice) {
  out << to_string(choice.method) << ": " << choice.sources << " sources, " << choice.targets << " targets";
  if (choice.tolerance > 0) out << ", tolerance " << choice.tolerance;
  if (choice.bound) {
    out << ", bound " << *choice.bound;
  } else {
    out << ", no bound";
  }
  if (choice.method == Method::hermite) {
    out << ", box scale " << choice.box_scale << " (side " << choice.box_side << "), expansion order "
        << choice.expansion_order << ", ";
    if (choice.neighbours == HermiteParameters::all_boxes) {
      out << "all boxes";
    } else {
      out << choice.neighbours << " neighbours";
    }
    out << ", " << choice.boxes << " occupied boxes";
  }
  return out << ", cost " << choice.cost << " pairs, about " << choice.seconds << " s";
}

}  // namespace fgtd
