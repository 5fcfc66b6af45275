// What a call of the system left in errno, as an exception.
#pragma once

#include <cerrno>
#include <system_error>

namespace gaussdrift::write {

[[noreturn]] inline void fail() { throw std::system_error(errno ? errno : EIO, std::generic_category()); }

}  // namespace gaussdrift::write
