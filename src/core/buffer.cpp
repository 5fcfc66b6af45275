// Advises the system; see buffer.hpp.
#include "core/buffer.hpp"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gaussdrift::core {

void prefer_huge_pages(void* begin, std::size_t bytes) {
#ifdef __linux__
  // Other sizes of pages exist. A whole page of this size is a whole number of pages of a smaller one.
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t from = (address + page - 1) / page * page, to = (address + bytes) / page * page;
  // The advice may be refused, which changes no result.
  if (from < to) madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#else
  (void)begin;
  (void)bytes;
#endif
}

}  // namespace gaussdrift::core
