// Sums of doubles without rounding: their value does not depend on the order of the addends, nor on which rank has which.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace gaussdrift::base {

class Communicator;

/// The exact sum of doubles as one long whole number in units of 2^-1074, the smallest double. It is kept in words of
/// which each weighs 2^32 times the one before. A word has 64 bits, so it takes 2^29 addends before carries have to be
/// passed on. Two more words count the addends that are infinite; a NaN counts as both infinities, whose sum it is.
/// 552 bytes; it has room for 2^44 addends.
class ExactSum {
 public:
  static constexpr std::size_t words = 68;

  void add(double number) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    const auto exponent = static_cast<unsigned>(bits >> 52 & 0x7ff);
    if (exponent == 0x7ff) return add_not_finite(number);
    // number = mantissa 2^(shift - 1074): below 2^-1022 there is no leading one.
    const std::uint64_t mantissa = (bits & fraction) | (exponent ? fraction + 1 : 0);
    const unsigned shift = exponent ? exponent - 1 : 0, bit = shift % 32;
    const auto sign = static_cast<std::int64_t>(bits >> 63);  // -x = ~(x - 1) = (x ^ -1) + 1
    const auto put = [&](std::int64_t& word, std::uint64_t part) {
      word += (static_cast<std::int64_t>(part) ^ -sign) + sign;
    };
    const std::uint64_t low = (mantissa & half) << bit, high = (mantissa >> 32) << bit;  // high weighs 2^32
    std::int64_t* const word = word_.data() + shift / 32;
    put(word[0], low & half);
    put(word[1], (low >> 32) + (high & half));
    put(word[2], high >> 32);
    if (++since_carry_ == most_between_carries) carry();
  }
  void add(std::span<const double> numbers) {
    for (const double number : numbers) add(number);
  }
  void add(const ExactSum& other);

  /// The double next to the exact sum (ties to even), 0 for an empty sum. As in any sum of doubles it is infinite or NaN
  /// if addends are, and infinite if it is too large for a double. What is too large only on the way does no harm.
  double value() const;
  /// Whether all addends were finite.
  bool finite() const { return word_[plus_infinite] == 0 && word_[minus_infinite] == 0; }

 private:
  friend void sum_over_ranks(Communicator& ranks, std::span<ExactSum> sums);
  static constexpr std::size_t digits = 66;  // the last one, with the sign, weighs 2^(65 * 32 - 1074) = 2^1006
  static constexpr std::size_t plus_infinite = 66, minus_infinite = 67;
  static constexpr std::uint64_t fraction = (std::uint64_t{1} << 52) - 1, half = 0xffffffff;
  static constexpr std::uint64_t most_between_carries = std::uint64_t{1} << 29;

  void add_not_finite(double number);
  /// Afterwards all words but the last are in [0, 2^32), whatever they were before.
  void carry();

  std::array<std::int64_t, words> word_{};
  std::uint64_t since_carry_ = 0;  // each addend adds less than 2^33 to a word
};

/// Each sum becomes that of all ranks together. All ranks bring equally many, and call it together.
void sum_over_ranks(Communicator& ranks, std::span<ExactSum> sums);

}  // namespace gaussdrift::base
