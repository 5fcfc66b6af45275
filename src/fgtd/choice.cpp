// Names of methods, and what was chosen as one line.
#include <ostream>

#include "fgtd/fgtd.hpp"

namespace fgtd {

const std::vector<Method>& methods() {
  static const std::vector<Method> all{Method::automatic, Method::direct,    Method::hermite, Method::cells,
                                       Method::outer,     Method::chebyshev, Method::spread};
  return all;
}

std::string to_string(Method method) {
  switch (method) {
    case Method::direct:
      return "direct";
    case Method::hermite:
      return "hermite";
    case Method::cells:
      return "cells";
    case Method::outer:
      return "outer";
    case Method::chebyshev:
      return "chebyshev";
    case Method::spread:
      return "spread";
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
  if (choice.method == Method::cells || choice.method == Method::outer)
    out << ", cells of side " << choice.box_side << ", " << choice.neighbours << " within reach, " << choice.boxes
        << " occupied";
  if (choice.method == Method::chebyshev)
    out << ", box side " << choice.box_side << ", " << choice.expansion_order << " nodes an axis, " << choice.neighbours
        << " neighbours, " << choice.boxes << " occupied boxes";
  if (choice.method == Method::spread)
    out << ", lattice spacing " << choice.box_side << ", window of " << choice.expansion_order << " nodes, "
        << choice.boxes << (choice.boxes == 1 ? " brick" : " bricks");
  if (choice.method == Method::hermite) out << ", cost by (3.5) " << choice.cost;
  return out << ", about " << choice.seconds << " s";
}

}  // namespace fgtd
