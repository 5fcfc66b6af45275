// Random numbers without a state: what is drawn follows from a key and a counter alone, so that it does not matter who
// draws first. Philox4x32 with 10 rounds, [SMDS11].
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace gaussdrift::base {

/// Four words, one for each counter and key.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t factor_0 = 0xD2511F53u, factor_2 = 0xCD9E8D57u;
  constexpr std::uint32_t golden = 0x9E3779B9u, root_of_3 = 0xBB67AE85u;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t one = factor_0 * counter[0], two = factor_2 * counter[2];
    counter = {static_cast<std::uint32_t>(two >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(two),
               static_cast<std::uint32_t>(one >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(one)};
    key[0] += golden, key[1] += root_of_3;
  }
  return counter;
}

/// Two independent numbers of mean 0 and variance 1, normally distributed, of the pair (first, second) of counters.
inline std::array<double, 2> two_normals(std::uint64_t key, std::uint64_t first, std::uint64_t second) {
  const auto low = [](std::uint64_t word) { return static_cast<std::uint32_t>(word); };
  const auto high = [](std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32); };
  const std::array<std::uint32_t, 4> words =
      philox({low(first), high(first), low(second), high(second)}, {low(key), high(key)});
  // Multiples of 2^-53: the one in (0, 1], so that it has a logarithm, the other in [0, 1).
  const auto fraction = [&](std::size_t i) {
    return static_cast<double>((std::uint64_t{words[i + 1]} << 32 | words[i]) >> 11);
  };
  constexpr double unit = 0x1p-53;
  const double radius = std::sqrt(-2 * std::log((fraction(0) + 1) * unit));
  const double angle = 2 * std::numbers::pi * fraction(2) * unit;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace gaussdrift::base
