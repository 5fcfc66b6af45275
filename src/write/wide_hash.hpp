// XXH64 (Yann Collet, xxHash fast digest algorithm, version 0.1.1) with the seed 0: a hash of large files, eight bytes at
// a time in four lanes that do not wait for each other.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace gaussdrift::write {

/// Of bytes that are fed piece by piece.
class WideHash {
 public:
  WideHash();
  void add(std::string_view bytes);
  /// Of all bytes so far.
  std::uint64_t value() const;

 private:
  static constexpr std::size_t stripe = 32;
  void take_stripe(const char* bytes);

  std::array<std::uint64_t, 4> lanes_;
  std::array<char, stripe> rest_{};  // bytes that do not fill a stripe
  std::uint64_t length_ = 0;
};

}  // namespace gaussdrift::write
