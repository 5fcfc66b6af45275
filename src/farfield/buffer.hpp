// Memory for millions of numbers: not set to zero before it is written, and on huge pages where the system offers them.
// Fresh memory is otherwise a large share of the fast methods' time.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace farfield::detail {

/// Tells the system, before a block is first touched, to back it with huge pages: one page fault in place of 512. Does
/// nothing for blocks without a whole huge page, and on systems that take no such advice.
void prefer_huge_pages(void* begin, std::size_t bytes);

/// Allocates with prefer_huge_pages() and leaves numbers uninitialised that are written before they are read.
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

}  // namespace farfield::detail
