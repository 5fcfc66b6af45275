// Parts of the program that are loaded when they are first needed, because loading them takes longer than a small run.
#pragma once

#include <initializer_list>
#include <string>

namespace gaussdrift::base {

/// A shared library. It stays loaded until the process ends.
class SharedModule {
 public:
  /// Who finds the names that the library defines: find() alone, or all libraries that are loaded later, too.
  enum class Names { found, for_all };

  /// Loads the first of these files that can be loaded. A name without a folder is looked for where the program has its own
  /// shared libraries (RUNPATH), then where the system has them. Throws std::bad_alloc where memory lacks.
  explicit SharedModule(std::initializer_list<const char*> files, Names names = Names::found);

  bool is_there() const { return handle_ != nullptr; }
  /// Why it is not there: the words of the system.
  const std::string& reason() const { return reason_; }

  /// The function of that name, which is known to have this type. Throws std::runtime_error if the library has none.
  template <class Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(address_of(name));
  }

 private:
  void* address_of(const char* name) const;

  void* handle_ = nullptr;
  std::string reason_;
};

}  // namespace gaussdrift::base
