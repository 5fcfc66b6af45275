// The list of all methods, and what is asked of it by name.
#include "farfield/catalogue.hpp"

#include "farfield/near/direct.hpp"

namespace farfield {
namespace detail {

const std::vector<MethodEntry>& catalogue() {
  static const std::vector<MethodEntry> all{direct_method(), tree_method(), symmetric_method()};
  return all;
}

const MethodEntry* find_entry(Method method) {
  for (const MethodEntry& entry : catalogue())
    if (entry.method == method) return &entry;
  return nullptr;
}

}  // namespace detail

const std::vector<Method>& methods() {
  static const std::vector<Method> all = [] {
    std::vector<Method> found{Method::automatic};
    for (const detail::MethodEntry& entry : detail::catalogue()) found.push_back(entry.method);
    return found;
  }();
  return all;
}

std::string to_string(Method method) {
  const detail::MethodEntry* const entry = detail::find_entry(method);
  return entry ? entry->name : "auto";
}

std::string meaning(Method method) {
  const detail::MethodEntry* const entry = detail::find_entry(method);
  return entry ? entry->meaning : "the method and leaf size with the smallest predicted time";
}

}  // namespace farfield
