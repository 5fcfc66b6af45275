// Catalogues: lists of things of one kind, each with its name, in the order of docs/cases.md. To add a thing is to add
// it to the list of its kind; all others ask the list.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gaussdrift::base {

/// The list of a kind. Each kind defines it beside its things.
template <class Thing>
std::vector<Thing>& catalogue();

/// Changes with every catalogue, see FromCatalogues.
inline std::size_t catalogue_edition = 0;

/// A thing that is in its catalogue as long as this lives. For tests, which add things of their own: nothing else may
/// use a catalogue meanwhile, and what was found in it before may have moved.
template <class Thing>
class Added {
 public:
  explicit Added(Thing thing) {
    catalogue<Thing>().push_back(std::move(thing));
    ++catalogue_edition;
  }
  ~Added() {
    catalogue<Thing>().pop_back();
    ++catalogue_edition;
  }
  Added(const Added&) = delete;
  Added& operator=(const Added&) = delete;
};

/// A value that is made from catalogues, once for every edition of them.
template <class Value>
class FromCatalogues {
 public:
  template <class Make>
  const Value& get(const Make& make) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!value_ || edition_ != catalogue_edition) {
      value_ = make();
      edition_ = catalogue_edition;
    }
    return *value_;
  }

 private:
  std::mutex mutex_;
  std::optional<Value> value_;
  std::size_t edition_ = 0;
};

template <class Thing>
std::string_view name_of(const Thing& thing) {
  if constexpr (requires { thing.about; })
    return thing.about.name;
  else
    return thing.name;
}

template <class Thing>
std::vector<std::string_view> names_of(const std::vector<Thing>& things) {
  std::vector<std::string_view> names;
  names.reserve(things.size());
  for (const Thing& thing : things) names.push_back(name_of(thing));
  return names;
}

/// The thing of that name; null if there is none.
template <class Thing>
const Thing* find_or_null(const std::vector<Thing>& things, std::string_view name) {
  for (const Thing& thing : things)
    if (name_of(thing) == name) return &thing;
  return nullptr;
}

/// The thing of that name. `kind` is what it is: "cutoff". Throws std::out_of_range if there is none.
template <class Thing>
const Thing& find_named(const std::vector<Thing>& things, std::string_view kind, std::string_view name) {
  if (const Thing* thing = find_or_null(things, name)) return *thing;
  throw std::out_of_range("no " + std::string(kind) + " is called " + std::string(name));
}

}  // namespace gaussdrift::base
