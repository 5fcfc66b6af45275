// The list of all methods, and what is asked of it by name.
#include "fgtd/catalogue.hpp"

#include <ostream>
#include <utility>

#include "fgtd/cells/sum.hpp"
#include "fgtd/chebyshev/sum.hpp"
#include "fgtd/direct/sum.hpp"
#include "fgtd/hermite/hermite.hpp"
#include "fgtd/spread/sum.hpp"

namespace fgtd {
namespace detail {
namespace {

struct Catalogue {
  std::vector<MethodEntry> entries{direct_method(),        hermite_method(),   cells_method(),
                                   outer_product_method(), chebyshev_method(), spread_method()};
  std::vector<Method> methods{Method::automatic};

  Catalogue() {
    for (const MethodEntry& entry : entries) methods.push_back(entry.method);
  }
};

Catalogue& all() {
  static Catalogue methods;
  return methods;
}

}  // namespace

const std::vector<MethodEntry>& catalogue() { return all().entries; }

const MethodEntry* find_entry(Method method) {
  for (const MethodEntry& entry : catalogue())
    if (entry.method == method) return &entry;
  return nullptr;
}

Method add_method(MethodEntry entry) {
  entry.method = static_cast<Method>(all().methods.size());
  all().methods.push_back(entry.method);
  all().entries.push_back(std::move(entry));
  return all().methods.back();
}

}  // namespace detail

const std::vector<Method>& methods() { return detail::all().methods; }

std::string to_string(Method method) {
  const detail::MethodEntry* const entry = detail::find_entry(method);
  return entry ? entry->name : "auto";
}

std::string meaning(Method method) {
  const detail::MethodEntry* const entry = detail::find_entry(method);
  return entry ? entry->meaning : "the method with the smallest predicted time whose bound meets the tolerance";
}

std::vector<Parameter> parameters(const Choice& choice) {
  const detail::MethodEntry* const entry = detail::find_entry(choice.method);
  return entry && entry->parameters ? entry->parameters(choice) : std::vector<Parameter>{};
}

std::ostream& operator<<(std::ostream& out, const Choice& choice) {
  out << to_string(choice.method) << ": " << choice.sources << " sources, " << choice.targets << " targets";
  if (choice.tolerance > 0) out << ", tolerance " << choice.tolerance;
  if (choice.bound) {
    out << ", bound " << *choice.bound;
  } else {
    out << ", no bound";
  }
  const detail::MethodEntry* const entry = detail::find_entry(choice.method);
  if (entry && entry->print) entry->print(out, choice);
  return out << ", about " << choice.seconds << " s";
}

}  // namespace fgtd
