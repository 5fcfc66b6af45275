#include "base/shared_module.hpp"

#include <dlfcn.h>

#include <cerrno>
#include <new>
#include <stdexcept>

namespace gaussdrift::base {

SharedModule::SharedModule(std::initializer_list<const char*> files, Names names) {
  for (const char* file : files) {
    errno = 0;
    handle_ = dlopen(file, RTLD_LAZY | (names == Names::for_all ? RTLD_GLOBAL : RTLD_LOCAL));
    if (handle_) return;
    if (errno == ENOMEM) throw std::bad_alloc();
    if (const char* words = dlerror(); words && reason_.empty()) reason_ = words;
  }
}

void* SharedModule::address_of(const char* name) const {
  void* address = handle_ ? dlsym(handle_, name) : nullptr;
  if (!address) throw std::runtime_error(std::string("a shared library has no function ") + name);
  return address;
}

}  // namespace gaussdrift::base
