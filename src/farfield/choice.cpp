// Names of kernels and methods, and what was chosen as one line.
#include <ostream>

#include "farfield/farfield.hpp"

namespace farfield {

const std::vector<Kernel>& kernels() {
  static const std::vector<Kernel> all{Kernel::coulomb, Kernel::log, Kernel::vortex_blob};
  return all;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> all{Method::automatic, Method::direct, Method::tree, Method::symmetric};
  return all;
}

std::string to_string(Kernel kernel) {
  switch (kernel) {
    case Kernel::coulomb:
      return "coulomb";
    case Kernel::log:
      return "log";
    default:
      return "vortex-blob";
  }
}

std::string to_string(Method method) {
  switch (method) {
    case Method::direct:
      return "direct";
    case Method::tree:
      return "tree";
    case Method::symmetric:
      return "symmetric";
    default:
      return "auto";
  }
}

std::ostream& operator<<(std::ostream& out, const Choice& choice) {
  out << to_string(choice.kernel) << " by " << to_string(choice.method) << ": " << choice.sources << " sources, "
      << choice.targets << " targets, tolerance " << choice.tolerance;
  if (choice.method != Method::direct)
    out << ", bound " << choice.bound << ", degree up to " << choice.degree << ", " << choice.clusters
        << " clusters on " << choice.levels << (choice.levels == 1 ? " level" : " levels") << ", at most "
        << choice.leaf_size << " points in a leaf";
  return out << ", about " << choice.seconds << " s";
}

}  // namespace farfield
