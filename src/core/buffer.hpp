// Memory for numbers that kernels read. It is not set to zero before it is written. Millions of numbers lie on huge pages
// where the system offers them: otherwise fresh memory takes a large share of the fast methods' time. Small tables begin
// at a cache line: otherwise the seconds of a kernel depend on where the table happens to lie.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace gaussdrift::core {

/// Call it before a block is first touched. It asks the system for huge pages: one page fault instead of 512. It does
/// nothing for blocks smaller than a huge page, and on systems that take no such advice.
void prefer_huge_pages(void* begin, std::size_t bytes);

constexpr std::size_t cache_line = 64;          // bytes, as many as the longest vector has
constexpr std::size_t aligned_below = 1 << 18;  // bytes; in larger blocks few vectors are read again and again

/// Allocates at a cache line, or with prefer_huge_pages(). Numbers are not initialised: they are written before they are
/// read.
template <class T>
struct Uninitialised : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Uninitialised<U>;
  };
  T* allocate(std::size_t count) {
    if (count < aligned_below / sizeof(T))
      return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{cache_line}));
    T* const block = std::allocator<T>::allocate(count);
    prefer_huge_pages(block, count * sizeof(T));
    return block;
  }
  void deallocate(T* block, std::size_t count) {
    if (count < aligned_below / sizeof(T)) {
      ::operator delete (block, std::align_val_t{cache_line});  // clang has no form with a size
    } else {
      std::allocator<T>::deallocate(block, count);
    }
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
