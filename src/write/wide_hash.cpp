#include "write/wide_hash.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace gaussdrift::write {

namespace {

constexpr std::uint64_t p1 = 0x9e3779b185ebca87u, p2 = 0xc2b2ae3d27d4eb4fu, p3 = 0x165667b19e3779f9u,
                        p4 = 0x85ebca77c2b2ae63u, p5 = 0x27d4eb2f165667c5u;

/// Bytes as a number, the lowest first.
template <class Number>
Number number_at(const char* bytes) {
  Number number = 0;
  if constexpr (std::endian::native == std::endian::little)
    std::memcpy(&number, bytes, sizeof number);
  else
    for (std::size_t i = 0; i < sizeof number; ++i)
      number |= static_cast<Number>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return number;
}

std::uint64_t mixed(std::uint64_t lane, std::uint64_t word) { return std::rotl(lane + word * p2, 31) * p1; }

}  // namespace

WideHash::WideHash() : lanes_{p1 + p2, p2, 0, 0 - p1} {}

void WideHash::take_stripe(const char* bytes) {
  for (std::size_t i = 0; i < 4; ++i) lanes_[i] = mixed(lanes_[i], number_at<std::uint64_t>(bytes + 8 * i));
}

void WideHash::add(std::string_view bytes) {
  if (const std::size_t waiting = length_ % stripe; waiting > 0) {
    const std::size_t some = std::min(stripe - waiting, bytes.size());
    std::copy_n(bytes.begin(), some, rest_.begin() + static_cast<std::ptrdiff_t>(waiting));
    length_ += some;
    bytes.remove_prefix(some);
    if (waiting + some < stripe) return;
    take_stripe(rest_.data());
  }
  length_ += bytes.size();
  for (; bytes.size() >= stripe; bytes.remove_prefix(stripe)) take_stripe(bytes.data());
  std::copy(bytes.begin(), bytes.end(), rest_.begin());
}

std::uint64_t WideHash::value() const {
  std::uint64_t hash = p5;
  if (length_ >= stripe) {
    hash = std::rotl(lanes_[0], 1) + std::rotl(lanes_[1], 7) + std::rotl(lanes_[2], 12) + std::rotl(lanes_[3], 18);
    for (const std::uint64_t lane : lanes_) hash = (hash ^ mixed(0, lane)) * p1 + p4;
  }
  hash += length_;
  std::size_t at = 0;
  const std::size_t left = length_ % stripe;
  for (; at + 8 <= left; at += 8)
    hash = std::rotl(hash ^ mixed(0, number_at<std::uint64_t>(rest_.data() + at)), 27) * p1 + p4;
  if (at + 4 <= left) {
    hash = std::rotl(hash ^ number_at<std::uint32_t>(rest_.data() + at) * p1, 23) * p2 + p3;
    at += 4;
  }
  for (; at < left; ++at) hash = std::rotl(hash ^ static_cast<unsigned char>(rest_[at]) * p5, 11) * p1;
  hash = (hash ^ hash >> 33) * p2;
  hash = (hash ^ hash >> 29) * p3;
  return hash ^ hash >> 32;
}

}  // namespace gaussdrift::write
