// Memory for millions of numbers. It is not set to zero before it is written, and lies on huge pages where the system
// offers them. Otherwise fresh memory takes a large share of the fast methods' time.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace gaussdrift::core {

/// Call it before a block is first touched. It asks the system for huge pages: one page fault instead of 512. It does
/// nothing for blocks smaller than a huge page, and on systems that take no such advice.
void prefer_huge_pages(void* begin, std::size_t bytes);

/// Allocates with prefer_huge_pages(). Numbers are not initialised: they are written before they are read.
template <class T>
struct Uninitialised : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Uninitialised<U>;
  };
  T* allocate(std::size_t count) {
    T* const block = std::allocator<T>::allocate(count);
    prefer_huge_pages(block, count * sizeof(T));
    return block;
  }
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0) {
      ::new (static_cast<void*>(at)) U;
    } else {
      ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }
  }
};
template <class T>
using Buffer = std::vector<T, Uninitialised<T>>;

}  // namespace gaussdrift::core
