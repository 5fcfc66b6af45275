// Names of kernels, and what was chosen as one line.
#include <ostream>

#include "farfield/catalogue.hpp"

namespace farfield {

namespace {

template <class Value>
struct Named {
  Value value;
  const char* name;  // as in files
};

constexpr Named<Kernel> kernel_names[] = {
    {Kernel::coulomb, "coulomb"}, {Kernel::log, "log"}, {Kernel::vortex_blob, "vortex-blob"}};

template <class Value, std::size_t count>
std::vector<Value> values_of(const Named<Value> (&list)[count]) {
  std::vector<Value> values;
  for (const Named<Value>& entry : list) values.push_back(entry.value);
  return values;
}

template <class Value, std::size_t count>
std::string name_in(const Named<Value> (&list)[count], Value value) {
  for (const Named<Value>& entry : list)
    if (entry.value == value) return entry.name;
  return list[0].name;
}

}  // namespace

const std::vector<Kernel>& kernels() {
  static const std::vector<Kernel> all = values_of(kernel_names);
  return all;
}

std::string to_string(Kernel kernel) { return name_in(kernel_names, kernel); }

std::ostream& operator<<(std::ostream& out, const Choice& choice) {
  out << to_string(choice.kernel) << " by " << to_string(choice.method) << ": " << choice.sources << " sources, "
      << choice.targets << " targets, tolerance " << choice.tolerance;
  const detail::MethodEntry* const method = detail::find_entry(choice.method);
  if (method && method->replaces_clusters)
    out << ", bound " << choice.bound << ", degree up to " << choice.degree << ", " << choice.clusters
        << " clusters on " << choice.levels << (choice.levels == 1 ? " level" : " levels") << ", at most "
        << choice.leaf_size << " points in a leaf";
  return out << ", about " << choice.seconds << " s";
}

}  // namespace farfield
